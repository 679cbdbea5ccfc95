"""The paper's four walls, each by every model, side by side: figures, peaks over several motions, and cost.

    python examples/paper_walls/compare.py [FOLDER]

C. Mordant, V. Denoel, H. Degee (COMPDYN 2015) shook four walls and compared them with these models; the recordings
are not public. Here the walls stand on artificial motions (Eurocode 8, type 2, ground B: our choice) at the
paper's PGAs. What the paper does not print is illustrative, in the specimen files and in `walls.py`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np
from cost import cost
from drawing import draw_motions, draw_peaks, draw_wall
from matplotlib.axes import Axes
from PIL import Image
from walls import WALLS, Outcome, derived, histories, outcomes, shaking, specimens

from study.figures import save_figure

SHOWN_SEED, SEEDS = 3, tuple(range(1, 11))
"""Of the motion in the figures over time, and of all."""


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Markdown."""
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (head, ["---"] * len(head), *rows)) + "\n"


def before_shaking() -> str:
    """PGA against the onset of the rigid models, and the first frequency on rubber."""
    rigid = ("Housner", "modified Housner", "stacked", "modified stacked")
    rows = []
    for wall in WALLS.values():
        found = {label: derived(specimen) for label, specimen in specimens(wall).items()}
        onsets = [f"{found[label]['onset_acceleration']:.3f}" for label in rigid]
        rows.append([wall.title, f"{wall.pga:.3f}", *onsets, f"{found['on rubber']['frequency_1']:.2f}"])
    return table(["wall", "PGA, g", *(f"onset, {label}, g" for label in rigid), "first mode on rubber, Hz"], rows)


def over_motions(
    found: Mapping[str, Mapping[str, Sequence[Outcome]]], words: Callable[[Sequence[Outcome]], str]
) -> str:
    """A row for each wall, a column for each model."""
    rows = ([f"{WALLS[n].title}, {WALLS[n].pga:g} g", *map(words, runs.values())] for n, runs in found.items())
    return table(["wall", *next(iter(found.values()))], rows)


def peak(runs: Sequence[Outcome]) -> str:
    """Median, smallest and largest, in mrad."""
    values = [one.peak for one in runs]
    return f"{np.median(values):.1f} ({min(values):.1f} to {max(values):.1f})"


def rocks(runs: Sequence[Outcome]) -> str:
    """In how many motions the base opens, the median time of it, and how many overturn."""
    times = [one.lifts for one in runs if np.isfinite(one.lifts)]
    overturned = sum(one.overturns for one in runs)
    first = f", {np.median(times):.1f} s" if times else ""
    return f"{len(times)} of {len(runs)}{first}" + (f"; {overturned} overturn" if overturned else "")


def costs(found: Mapping[str, tuple[float, float]]) -> str:
    """Each model's time and its ratio to Housner's block."""
    fastest, alone = next(iter(found.values()))
    rows = (
        [label, f"{fast * 1e3:.3g}", f"{fast / fastest:.1f}", f"{slow:.2g}", f"{slow / alone:.1f}"]
        for label, (fast, slow) in found.items()
    )
    return table(["model", "lanes, ms a wall", "ratio", "reference, s a wall", "ratio"], rows)


def save(draw: Callable[[], tuple[Axes, ...]], path: Path) -> None:
    """A PNG of few colours, a third of the bytes."""
    save_figure(draw, path)
    Image.open(path).convert("RGB").quantize(96, dither=Image.Dither.NONE).save(path, optimize=True)


def main(folder: Path, seeds: Sequence[int] = SEEDS, shown: int = SHOWN_SEED, lanes: int = 256) -> None:
    """Write figures and tables."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, wall in WALLS.items():
        motion = shaking(wall, shown)
        save(partial(draw_wall, wall, motion, histories(wall, motion)), folder / f"{name}.png")
    save(partial(draw_motions, [shaking(WALLS["short"], seed) for seed in seeds]), folder / "motions.png")
    found = outcomes(seeds)
    save(partial(draw_peaks, found), folder / "peaks.png")
    tables: dict[str, Callable[[], str]] = {
        "walls": before_shaking,
        "peaks": partial(over_motions, found, peak),
        "rocks": partial(over_motions, found, rocks),
        "cost": lambda: costs(cost(shown, lanes)),
    }
    for name, text in tables.items():
        (folder / f"{name}.md").write_text(text(), "utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("results/paper_walls"))
