"""Figures of scored answers: confusion matrix, evidence against size, said against true intervals."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from diagnosis.prove.places import said_spans, true_spans
from diagnosis.prove.scores import Scored, confusion

LEAST_EVIDENCE = 1.0
"""Drawn where nothing is said to be missing, on a logarithmic axis."""


def draw_all(cases: Sequence[Scored], folder: Path) -> list[Path]:
    """Every figure that the keys allow, as PNG; the paths."""
    found = [draw_confusion(cases, folder / "confusion.png")]
    if sized := [case for case in cases if strength(case) is not None]:
        found.append(draw_evidence(sized, folder / "evidence.png"))
    if placed := [case for case in cases if case.key["effects"] and true_spans(case)]:
        found.append(draw_located(placed, folder / "located.png"))
    return found


def strength(case: Scored) -> float | None:
    """Largest size of what is hidden over the noise among the recordings; None where the key has none."""
    given = [note.get("strength") for note in case.key.get("recordings", {}).values()]
    sizes = [max(one.values()) if isinstance(one, dict) else float(one) for one in given if one is not None]
    return max(sizes) if sizes and case.key["effects"] else None


def draw_confusion(cases: Sequence[Scored], path: Path) -> Path:
    """Nulls, singles and open cases: the class hidden against the class named first."""
    rows, columns, counts = confusion(cases)
    figure, axes = _axes(0.35 * len(columns) + 3.5, 0.3 * len(rows) + 2.5)
    axes.imshow(counts, cmap="Blues", aspect="auto")
    for i, row in enumerate(counts):
        for j, count in enumerate(row):
            if count:
                axes.text(j, i, str(count), ha="center", va="center", fontsize=7,
                          color="white" if count > counts.max() / 2 else "black")  # fmt: skip
    axes.set_xticks(range(len(columns)), columns, rotation=90, fontsize=7)
    axes.set_yticks(range(len(rows)), rows, fontsize=7)
    axes.set_xlabel("class named first")
    axes.set_ylabel("class hidden")
    return _saved(figure, path)


def draw_evidence(cases: Sequence[Scored], path: Path) -> Path:
    """Evidence of all that is said to be missing against the size of what is; filled: the class is right."""
    figure, axes = _axes(6.0, 4.5)
    for case in cases:
        evidence = max(LEAST_EVIDENCE, sum(float(effect["evidence"]) for effect in case.answer["effects"]))
        right = case.first_class in case.truth
        axes.plot(strength(case), evidence, "o", color="C0" if right else "C3", mfc="C0" if right else "none")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("size of the effect over the noise (rms)")
    axes.set_ylabel("evidence (2 log likelihood)")
    axes.set_title("filled: the class is named first", fontsize=9)
    return _saved(figure, path)


def draw_located(cases: Sequence[Scored], path: Path) -> Path:
    """True (grey) and said (blue) intervals, a line for each recording of each case."""
    lines = [(case, name) for case in cases for name in (true_spans(case) or {})]
    figure, axes = _axes(7.0, 0.28 * len(lines) + 1.5)
    for row, (case, name) in enumerate(lines):
        true, said = (true_spans(case) or {})[name], said_spans(case).get(name, [])
        axes.broken_barh([(a, b - a) for a, b in true], (row - 0.4, 0.8), color="0.75")
        axes.broken_barh([(a, b - a) for a, b in said], (row - 0.15, 0.3), color="C0")
    axes.set_yticks(range(len(lines)), [f"{case.case} {name}" for case, name in lines], fontsize=6)
    axes.set_ylim(len(lines) - 0.5, -0.5)
    axes.set_xlabel("time in the recording, s; grey: true, blue: said")
    return _saved(figure, path)


def _axes(width: float, height: float) -> tuple[Any, Any]:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    return pyplot.subplots(figsize=(width, height))


def _saved(figure: Any, path: Path) -> Path:
    from matplotlib import pyplot

    figure.tight_layout()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=150)
    pyplot.close(figure)
    return path
