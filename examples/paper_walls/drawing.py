"""The figures: a wall by every model over time, peaks over all motions, the motions' spectra."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from walls import TAIL, WALLS, Outcome, Wall, derived, outcome, specimens

from grids.motions import Motion
from grids.motions.artificial import TOLERANCE, target_of
from grids.motions.matching import MATCHED
from grids.motions.spectrum import response_spectrum
from grids.units import STANDARD_GRAVITY as GRAVITY
from study.figures.style import COLOURS, set_log_ticks

ROWS = (
    ("one body", ("Housner", "modified Housner")),
    ("two stacked blocks", ("stacked", "modified stacked")),
    ("two blocks on rubber", ("on rubber", "on rubber, linear")),
)
"""Panels of a figure and their curves."""
TOP = (("stacked", COLOURS[6]), ("on rubber", COLOURS[0]), ("on rubber, linear", COLOURS[1]))


def draw_wall(wall: Wall, motion: Motion, found: Mapping[str, xr.Dataset]) -> tuple[Axes, ...]:
    """The shaking, the wall's rotation by each family of models, and the rotation in the top joint.

    Every panel has its own scale, of 1 mrad to each side at least.
    """
    figure = plt.figure(figsize=(7.0, 7.8), layout="constrained")
    axes = figure.subplots(len(ROWS) + 2, 1, sharex=True)
    onset = derived(specimens(wall)["Housner"])["onset_acceleration"]
    axes[0].plot(motion.time, motion.horizontal / GRAVITY, color="0.35", linewidth=0.6)
    for side in (-1, 1):
        axes[0].axhline(side * onset, color=COLOURS[0], linestyle=":", linewidth=1.2)
    axes[0].set_title(f"shaking; dotted: onset of Housner's block, {onset:.3f} g", loc="left", fontsize="small")
    axes[0].set_ylabel("acceleration [g]", fontsize="small")
    axes[0].set_ylim(*(np.array([-1.2, 1.2]) * max(wall.pga, onset)))
    for ax, (title, labels) in zip(axes[1:-1], ROWS, strict=True):
        curves = [(x, colour, found[x]["rotation_1"]) for x, colour in zip(labels, COLOURS, strict=False)]
        texts = {x: f"{x}: peak {outcome(found[x]).peak:.1f} mrad" for x in labels}
        draw_rotations(ax, f"wall, {title}", curves, texts)
    relative = [(x, colour, found[x]["rotation_2"] - found[x]["rotation_1"]) for x, colour in TOP]
    draw_rotations(axes[-1], "mass against wall", relative, {x: x for x, _ in TOP})
    axes[-1].set_xlabel("time [s]", fontsize="small")
    axes[-1].set_xlim(0.0, motion.duration + TAIL)
    for ax in axes:
        ax.grid(alpha=0.3)
        ax.tick_params(labelsize="small")
    figure.suptitle(f"{wall.title}, PGA {wall.pga:g} g; artificial motion, sizes illustrative", fontsize="medium")
    return tuple(axes)


def draw_rotations(
    ax: Axes, title: str, curves: Sequence[tuple[str, str, xr.DataArray]], texts: Mapping[str, str]
) -> None:
    """Rotations (rad) over time, with the legend above the panel."""
    largest = 1.0
    for label, colour, values in curves:
        reach = float(np.abs(values).max()) * 1e3
        ax.plot(
            values["time"], values * 1e3, color=colour, linewidth=0.9, label=texts[label], zorder=2 + 1 / (1 + reach)
        )
        largest = max(largest, reach)
    ax.set_ylim(-1.1 * largest, 1.1 * largest)
    ax.set_title(title, loc="left", fontsize="small")
    ax.set_ylabel("rotation [mrad]", fontsize="small")
    ax.legend(
        loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=len(curves), frameon=False, fontsize="x-small",
        borderaxespad=0.0, handlelength=1.4, columnspacing=1.2,
    )  # fmt: skip


def draw_peaks(found: Mapping[str, Mapping[str, Sequence[Outcome]]]) -> tuple[Axes, ...]:
    """Every motion a dot, the median a bar."""
    figure = plt.figure(figsize=(7.0, 5.8), layout="constrained")
    axes = figure.subplots(2, 2, sharex=True)
    for ax, (name, by_model) in zip(axes.flat, found.items(), strict=True):
        for place, runs in enumerate(by_model.values()):
            values = [one.peak for one in runs]
            spread = place + np.linspace(-0.22, 0.22, len(values))
            ax.plot(spread, values, "o", color=COLOURS[place // 2], markersize=4, alpha=0.75, zorder=3)
            ax.hlines(float(np.median(values)), place - 0.32, place + 0.32, color="black", linewidth=1.6, zorder=4)
        ax.set_title(f"{WALLS[name].title}, {WALLS[name].pga:g} g", loc="left", fontsize="medium")
        ax.set_ylabel("peak rotation [mrad]")
        ax.set_ylim(bottom=-0.03 * ax.get_ylim()[1])
        ax.grid(alpha=0.3, axis="y")
        ax.set_xticks(range(len(by_model)), list(by_model), rotation=35, ha="right")
    return tuple(axes.flat)


def draw_motions(motions: Sequence[Motion]) -> tuple[Axes, ...]:
    """The motions one above the other, and their spectra against the code's."""
    figure = plt.figure(figsize=(8.0, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    target = target_of(motions[0])
    if target is None:
        raise ValueError(f"{motions[0].name} is not artificial")
    for place, motion in enumerate(motions):
        left.plot(motion.time, motion.horizontal / motion.pga - 2.0 * place, color="0.3", linewidth=0.4)
        periods = np.geomspace(0.02, 6.0, 160)
        spectrum = response_spectrum(motion.horizontal, motion.time_step, periods, target.damping)
        right.loglog(periods, spectrum.pseudo_acceleration / GRAVITY, color=COLOURS[0], linewidth=0.5, alpha=0.8)
    matched = np.geomspace(*MATCHED, 200)
    wanted = target(matched) / GRAVITY
    right.fill_between(matched, (1 - TOLERANCE) * wanted, (1 + TOLERANCE) * wanted, color="0.8",
                       label=f"Eurocode 8, ± {TOLERANCE:.0%}, {MATCHED[0]:g} to {MATCHED[1]:g} s")  # fmt: skip
    right.loglog(matched, wanted, "--", color=COLOURS[6], linewidth=1.0)
    left.set_yticks([-2.0 * place for place in range(len(motions))], [str(k + 1) for k in range(len(motions))])
    left.set_title("acceleration over PGA", loc="left", fontsize="medium")
    left.set_ylabel("motion")
    left.set_xlabel("time [s]")
    left.set_xlim(0.0, motions[0].duration)
    right.set_title(f"spectra at {motions[0].pga / GRAVITY:.3g} g, {target.damping:.0%} damping", loc="left",
                    fontsize="medium")  # fmt: skip
    right.set_xlabel("period [s]")
    right.set_ylabel("pseudo-acceleration [g]")
    for axis in (right.xaxis, right.yaxis):
        set_log_ticks(axis)
    right.grid(alpha=0.3)
    right.legend(loc="lower left", frameon=False, fontsize="small")
    return left, right
