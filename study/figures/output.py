"""The values of one output of a cube over two axes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

from study.figures.map_figure import ascending, draw_legend, frame
from study.figures.outcomes import marked
from study.figures.style import MAP_COLOURS, label, shown
from study.maps import output_map, status_map

BLANK = "#e4e4e4"


def plot_output_map(
    cube: xr.Dataset,
    output: str,
    x: str | None = None,
    y: str | None = None,
    at: Mapping[str, Any] | None = None,
    *,
    ax: Axes | None = None,
) -> Axes:
    """Draw an output over two axes in colours; overturned cells, whose values (a peak rotation of pi/2) would hide
    the others, and cells without an answer or a value have a colour of their own each, which the legend explains.

    Arguments as in `study.maps.output_map`.
    """
    values = output_map(cube, output, x, y, at)
    status = ascending(status_map(cube, x, y, at))
    ax, ordered, borders = frame(values.copy(data=shown(values)[0]), ax)
    outcomes = marked(output, status)
    ordered = np.where(np.isin(status, [outcome.flag for outcome in outcomes]), np.nan, ordered)
    if np.isfinite(ordered).any():
        drawn = ax.pcolormesh(*borders, np.ma.masked_invalid(ordered), cmap=colormaps[MAP_COLOURS])
        ax.figure.colorbar(drawn, ax=ax).set_label(label(values))
    for outcome in outcomes:
        ax.pcolormesh(*borders, np.ma.masked_not_equal(status, outcome.flag), cmap=ListedColormap([outcome.colour]))
    handles = [outcome.patch() for outcome in outcomes]
    blank = np.isnan(ordered) & ~np.isin(status, [outcome.flag for outcome in outcomes])
    if blank.any():  # of a refined study, whose outcome there follows from the cells around
        ax.pcolormesh(*borders, np.ma.masked_where(~blank, blank), cmap=ListedColormap([BLANK]))
        handles.append(Patch(facecolor=BLANK, edgecolor="0.4", label="no value: not computed"))
    if handles:
        draw_legend(ax, handles)
    return ax
