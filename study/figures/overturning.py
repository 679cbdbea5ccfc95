"""The overturning map of a cube."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import xarray as xr
from matplotlib.axes import Axes

from study.figures.map_figure import plot_map
from study.maps import overturning_map


def plot_overturning_map(
    cube: xr.Dataset,
    x: str | None = None,
    y: str | None = None,
    at: Mapping[str, Any] | None = None,
    *,
    ax: Axes | None = None,
) -> Axes:
    """Draw what overturns over two axes, or the smallest intensity that overturns.

    Arguments as in `study.maps.overturning_map`.
    """
    return plot_map(overturning_map(cube, x, y, at), words=("overturns", "does not overturn"), ax=ax)
