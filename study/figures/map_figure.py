"""A map over two axes: yes or no, or the smallest intensity at which something happens."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch

from study.figures.style import (
    COLOURS,
    MAP_COLOURS,
    NOTHING,
    UNKNOWN,
    edges,
    label,
    new_axes,
    positions,
    set_scale,
    set_title,
)
from study.wording import title, unit_shown

FEW_LEVELS = 12
"""Up to so many values of a map have a colour each."""
BAND = (0.05, 0.5, 0.95)
"""Shares of samples whose lines are drawn."""
LINE = 0.062
"""Height of a line of the title, as a share of the Axes."""


def plot_map(values: xr.DataArray, *, words: tuple[str, str], ax: Axes | None = None) -> Axes:
    """Draw a map (dimensions y, x) of `study.maps`.

    ``words`` say what 1 and 0 mean (or: what the missing values of a smallest intensity mean).
    """
    ax, ordered, borders = frame(values, ax)
    if str(values.name).startswith(("pga_", "motion_scale_")):
        _draw_smallest(ax, values, ordered, borders, words[1])
    elif str(values.name).endswith("_share"):
        _draw_share(ax, values, ordered, borders, words[0])
    else:
        colours = ListedColormap([NOTHING, COLOURS[1]]).with_extremes(bad=UNKNOWN)
        ax.pcolormesh(*borders, np.ma.masked_invalid(ordered), cmap=colours, vmin=0, vmax=1)
        kinds = [(words[0], COLOURS[1]), (words[1], NOTHING)]
        if np.isnan(ordered).any():
            kinds.append(("unknown", UNKNOWN))
        draw_legend(ax, [Patch(facecolor=colour, edgecolor="0.4", label=text) for text, colour in kinds])
    return ax


def frame(values: xr.DataArray, ax: Axes | None) -> tuple[Axes, np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """Axes with title, labels and scales for a map; its values and borders in ascending order."""
    ax = new_axes(ax)
    set_title(ax, str(values.attrs.get("selection", "")))
    y, x = (values[str(dim)] for dim in values.dims)
    across, x_words = positions(x)
    up, y_words = positions(y)
    ordered = ascending(values)
    borders = edges(np.sort(across)), edges(np.sort(up))
    for which, axis, points, wording in (("x", x, across, x_words), ("y", y, up, y_words)):
        set_scale(ax, which, points, wording)
        (ax.set_xlabel if which == "x" else ax.set_ylabel)(label(axis))
    return ax, ordered, borders


def ascending(values: xr.DataArray) -> np.ndarray:
    """The values of a map with both axes ascending, as drawing needs them; those of a cube may come in any order."""
    up, across = (np.argsort(positions(values[str(dim)])[0]) for dim in values.dims)
    return np.asarray(values.values[up][:, across])


def _draw_smallest(
    ax: Axes, values: xr.DataArray, ordered: np.ndarray, borders: tuple[np.ndarray, np.ndarray], nothing: str
) -> None:
    factor, unit = unit_shown(str(values.attrs["units"]))
    colours = colormaps[MAP_COLOURS].with_extremes(bad=NOTHING)
    levels, level = np.unique(ordered[np.isfinite(ordered)], return_inverse=True)
    few = 0 < levels.size <= FEW_LEVELS
    painted = factor * ordered
    if few:  # a colour a level, evenly spaced in the bar
        painted[np.isfinite(ordered)] = level
    norm = BoundaryNorm(np.arange(levels.size + 1) - 0.5, colours.N) if few else None
    drawn = ax.pcolormesh(*borders, np.ma.masked_invalid(painted), cmap=colours, norm=norm)
    name = str(values.name).partition("_overturned")[0].partition("_uplift")[0]
    suffix = "" if unit == "1" else f" [{unit}]"
    if levels.size:
        bar = ax.figure.colorbar(drawn, ax=ax)
        bar.set_label(f"smallest {title(name)} that {_verb(values)}{suffix}")
        if few:
            # at the grid's smallest value the true one may lie below
            at_most = ["≤ " if value == values.attrs["smallest"] else "" for value in levels]
            texts = [f"{mark}{factor * value:.3g}" for mark, value in zip(at_most, levels, strict=True)]
            bar.set_ticks(np.arange(levels.size).tolist(), labels=texts)
            bar.ax.tick_params(which="both", length=0)
    unknown = ascending(values["unknown"])
    ax.pcolormesh(*borders, np.ma.masked_not_equal(unknown, True), cmap=ListedColormap([UNKNOWN]))
    patches = []
    if (np.isnan(ordered) & ~unknown).any():
        text = f"{nothing} up to {factor * values.attrs['largest']:.3g}" + ("" if unit == "1" else f" {unit}")
        patches.append(Patch(facecolor=NOTHING, edgecolor="0.4", label=text))
    if unknown.any():
        patches.append(Patch(facecolor=UNKNOWN, edgecolor="0.4", label="unknown"))
    if patches:
        draw_legend(ax, patches)


def _draw_share(
    ax: Axes, values: xr.DataArray, ordered: np.ndarray, borders: tuple[np.ndarray, np.ndarray], word: str
) -> None:
    """Shares of samples, with the lines between which the boundary lies as far as the wall is known."""
    colours = colormaps[MAP_COLOURS].with_extremes(bad=UNKNOWN)
    drawn = ax.pcolormesh(*borders, np.ma.masked_invalid(ordered), cmap=colours, vmin=0.0, vmax=1.0)
    bar = ax.figure.colorbar(drawn, ax=ax)
    bar.set_label(f"share of the samples that {word}")
    (across, x_words), (up, y_words) = (positions(values[str(dim)]) for dim in reversed(values.dims))
    known = ordered[np.isfinite(ordered)]
    inside = [level for level in BAND if known.size and known.min() < level < known.max()]
    if inside and min(ordered.shape) > 1 and not (x_words or y_words):
        lines = ax.contour(np.sort(across), np.sort(up), ordered, levels=inside, colors=COLOURS[1], linewidths=1.2)
        ax.clabel(lines, fmt=lambda level: f"{level:.0%}", fontsize="small")


def _verb(values: xr.DataArray) -> str:
    return str(values.attrs["long_name"]).partition(" that ")[2]


def draw_legend(ax: Axes, handles: Sequence[Artist]) -> None:
    """The legend above the title, where it hides nothing."""
    above = 1.01 + LINE * (1.0 + ax.get_title().count("\n") if ax.get_title() else 0.0)
    ax.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, above), ncols=3, frameon=False)
