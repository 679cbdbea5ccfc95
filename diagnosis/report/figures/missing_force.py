"""The laws that were found: the one in a table with its band, and what a named effect does along the motion."""

from __future__ import annotations

from collections.abc import Mapping
from textwrap import wrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from diagnosis.answer.result import Visited
from diagnosis.report.figures.palette import PAPER, Palette
from diagnosis.report.figures.panels import WIDE, in_milli, is_narrow, legend, name_panel, new_panels

PANEL, LETTERS = 2.8, 10.0
"""Height in inches; letters to an inch of a panel's name."""


def plot_missing_force(force: Mapping[str, Any], *, width: float = WIDE, palette: Palette = PAPER) -> tuple[Axes, ...]:
    """Draw each table of a law: its values with the 95 % band, and the nearest law of the library."""
    terms = force["terms"]
    panels = new_panels([PANEL] * len(terms), width, palette, below=0.5)
    of_all = next((k for k, term in enumerate(terms) if term["nearest"] is not None), 0)
    for k, (ax, term) in enumerate(zip(panels, terms, strict=True)):
        at, unit = in_milli(np.asarray(term["at"], float), term["variable_unit"])
        half = at.size // 2
        for side in (slice(0, half), slice(half, None)):  # it may jump at zero
            first = side.start == 0
            ax.fill_between(at[side], term["low95"][side], term["high95"][side], color=palette.band, zorder=0,
                            label="95 %" if first else None)  # fmt: skip
            ax.plot(at[side], term["value"][side], color=palette.accent, linewidth=1.8, zorder=3,
                    label="found" if first else None)  # fmt: skip
            if term["nearest"] is not None:
                near = np.array([np.nan if v is None else v for v in term["nearest"][side]], float)
                ax.plot(at[side], near, color=palette.before, linewidth=1.4, linestyle=(0, (4, 2)), zorder=2,
                        label=force["nearest"].replace("_", " ") if first else None)  # fmt: skip
        _cross(ax, palette)
        lines = wrap(term["meaning"], int(LETTERS * width))
        name_panel(ax, "\n".join([*lines, " "] if k == of_all else lines), palette)  # the legend stands below its name
        ax.set_xlabel(f"{term['variable'].replace('_', ' ')} [{unit}]")
        ax.locator_params(axis="x", nbins=5 if is_narrow(width) else 9)
        ax.set_ylabel(f"[{in_milli(at, term['unit'])[1]}]" if term["unit"] != "1" else "")
    legend(panels[of_all], palette)
    return tuple(panels)


def plot_visited(law: Visited, *, width: float = WIDE, palette: Palette = PAPER) -> Axes:
    """Draw what a named effect does at every sample of the fitted motion, over what it depends on."""
    (ax,) = new_panels([PANEL], width, palette, below=0.5)
    x, unit = in_milli(law.at, law.at_unit)
    y, of_y = in_milli(law.value, law.unit)
    ax.plot(x, y, ".", color=palette.accent, markersize=3.0, linestyle="none")
    _cross(ax, palette)
    ax.set_xlabel(f"{law.over} [{unit}]")
    ax.set_ylabel(f"{law.what} [{of_y}]" if law.unit != "1" else law.what)
    return ax


def _cross(ax: Axes, palette: Palette) -> None:
    ax.axhline(0.0, color=palette.faint, linewidth=1.0, zorder=0)
    ax.axvline(0.0, color=palette.faint, linewidth=1.0, zorder=0)
