"""The values of one output of a cube over two axes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes

from study.figures.map_figure import frame
from study.figures.style import MAP_COLOURS, UNKNOWN, label, shown
from study.maps import output_map


def plot_output_map(
    cube: xr.Dataset, output: str, x: str, y: str, at: Mapping[str, Any] | None = None, *, ax: Axes | None = None
) -> Axes:
    """Draw an output over two axes in colours; white where it is not known.

    Arguments as in `study.maps.output_map`.
    """
    values = output_map(cube, output, x, y, at)
    ax, ordered, borders = frame(values.copy(data=shown(values)[0]), ax)
    drawn = ax.pcolormesh(
        *borders, np.ma.masked_invalid(ordered), cmap=colormaps[MAP_COLOURS].with_extremes(bad=UNKNOWN)
    )
    ax.figure.colorbar(drawn, ax=ax).set_label(label(values))
    return ax
