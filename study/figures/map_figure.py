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
    set_words,
    shown,
)


def plot_map(values: xr.DataArray, *, words: tuple[str, str], ax: Axes | None = None) -> Axes:
    """Draw a map (dimensions y, x) of `study.maps`.

    ``words`` say what 1 and 0 mean (or: what the missing values of a smallest intensity mean).
    """
    ax = new_axes(ax)
    y, x = (values[str(dim)] for dim in values.dims)
    across, x_words = positions(x)
    up, y_words = positions(y)
    # a map needs ascending borders; the axes of a cube may come in any order
    ordered = values.values[np.argsort(up)][:, np.argsort(across)]
    borders = edges(np.sort(across)), edges(np.sort(up))
    if str(values.name).startswith(("pga_", "motion_scale_")):
        _draw_smallest(ax, values, ordered, borders, words[1])
    else:
        colours = ListedColormap([NOTHING, COLOURS[1]]).with_extremes(bad=UNKNOWN)
        ax.pcolormesh(*borders, np.ma.masked_invalid(ordered), cmap=colours, vmin=0, vmax=1)
        kinds = [(words[0], COLOURS[1]), (words[1], NOTHING)]
        if np.isnan(ordered).any():
            kinds.append(("unknown", UNKNOWN))
        draw_legend(ax, [Patch(facecolor=colour, edgecolor="0.4", label=text) for text, colour in kinds])
    for which, axis, wording in (("x", x, x_words), ("y", y, y_words)):
        set_words(ax, which, wording)
        (ax.set_xlabel if which == "x" else ax.set_ylabel)(label(axis))
    if values.attrs.get("selection"):
        ax.set_title(values.attrs["selection"], fontsize="medium")
    return ax


def _draw_smallest(
    ax: Axes, values: xr.DataArray, ordered: np.ndarray, borders: tuple[np.ndarray, np.ndarray], nothing: str
) -> None:
    factor_values, unit = shown(values.copy(data=ordered))
    known = factor_values[np.isfinite(factor_values)]
    colours = colormaps[MAP_COLOURS].with_extremes(bad=NOTHING)
    levels = np.unique(known)
    norm = None
    if 1 < levels.size <= 12:
        norm = BoundaryNorm(edges(levels), colours.N)
    drawn = ax.pcolormesh(*borders, np.ma.masked_invalid(factor_values), cmap=colours, norm=norm)
    name = str(values.name).partition("_overturned")[0].partition("_uplift")[0]
    text = "PGA" if name == "pga" else name.replace("_", " ")
    suffix = "" if unit == "1" else f" [{unit}]"
    if known.size:
        bar = ax.figure.colorbar(drawn, ax=ax)
        bar.set_label(f"smallest {text} that {_verb(values)}{suffix}")
        if norm is not None:
            bar.set_ticks(levels.tolist(), labels=[f"{level:.3g}" for level in levels])
    if np.isnan(factor_values).any():
        largest = shown(values.copy(data=np.full(values.shape, values.attrs["largest"])))[0].flat[0]
        at_most = f"{nothing} up to {largest:.3g}" + ("" if unit == "1" else f" {unit}")
        draw_legend(ax, [Patch(facecolor=NOTHING, edgecolor="0.4", label=at_most)])


def _verb(values: xr.DataArray) -> str:
    return str(values.attrs["long_name"]).partition(" that ")[2]


def draw_legend(ax: Axes, handles: Sequence[Artist]) -> None:
    """The legend above the title, where it hides nothing."""
    ax.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, 1.06), ncols=3, frameon=False)
