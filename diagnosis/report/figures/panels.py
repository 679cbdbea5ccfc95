"""Figures of one or several panels, drawn alike: thin frames, sizes in points of the page."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from diagnosis.report.figures.palette import Palette
from study.figures.style import literal

WIDE, NARROW = 12.0, 5.2
"""Inches; at 72 units an inch this is the column of a page on a desk and on a telephone."""
FONT = 13.0
"""Points."""


def is_narrow(width: float) -> bool:
    """Whether panels go below each other instead of side by side."""
    return width < 8.0


def new_panels(
    heights: Sequence[float],
    width: float,
    palette: Palette,
    *,
    columns: int = 1,
    sharex: bool = False,
    below: float = 0.0,
) -> list[Axes]:
    """Axes row by row in a new figure. Inches: ``width``, ``heights`` of the rows with their titles,
    ``below`` for what stands under the last one.
    """
    figure = Figure(figsize=(width, sum(heights) + below), layout="constrained")
    figure.patch.set_alpha(0.0)
    figure.get_layout_engine().set(w_pad=0.03, h_pad=0.06)  # type: ignore[union-attr, call-arg]
    grid = figure.subplots(
        len(heights),
        columns,
        squeeze=False,
        sharex="col" if sharex else "none",
        gridspec_kw={"height_ratios": list(heights)},
    )
    panels = list(np.ravel(grid))
    for ax in panels:
        dress(ax, palette)
    return panels


def figure_of(ax: Axes) -> Figure:
    """The figure that holds a panel."""
    figure = ax.get_figure(root=True)
    if figure is None:
        raise ValueError("the Axes belong to no figure")
    return figure


def dress(ax: Axes, palette: Palette) -> None:
    """Quiet frame and ticks."""
    ax.patch.set_alpha(0.0)
    for side, spine in ax.spines.items():
        spine.set_visible(side in ("left", "bottom"))
        spine.set_color(palette.faint)
    ax.tick_params(color=palette.faint, labelcolor=palette.ink, length=3, width=1.0, labelsize=FONT - 1)
    ax.xaxis.label.set(color=palette.ink, fontsize=FONT)
    ax.yaxis.label.set(color=palette.ink, fontsize=FONT)


def name_panel(ax: Axes, text: str, palette: Palette) -> None:
    """What a panel shows, above its left end."""
    ax.set_title(literal(text), loc="left", fontsize=FONT, color=palette.ink, pad=6)


def legend(ax: Axes, palette: Palette) -> None:
    """The meaning of the curves, above the right end of a panel."""
    ax.legend(
        loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=4, frameon=False, fontsize=FONT - 1,
        labelcolor=palette.ink, borderaxespad=0.2, handlelength=1.6, columnspacing=1.2, handletextpad=0.5,
    )  # fmt: skip


def in_milli(values: np.ndarray, unit: str) -> tuple[np.ndarray, str]:
    """Values and unit as engineers read them on an axis: mrad and mm instead of rad and m."""
    if unit in ("rad", "m"):
        return 1e3 * values, f"m{unit}"
    return values, unit.replace("s-2", "s⁻²").replace("s-1", "s⁻¹")
