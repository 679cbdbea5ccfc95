"""Curves of one output along one axis."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize

from study.figures.style import (
    COLOURS,
    MAP_COLOURS,
    geometric,
    label,
    new_axes,
    positions,
    set_log_ticks,
    set_scale,
    set_title,
    shown,
)
from study.maps import slices
from study.status import OVERTURNED

MARKERS = "osD^vPX*"
FEW = 8


ALWAYS = ("overturned", "overturning_time", "status")
"""Outputs that say something of an overturned wall, too."""


def plot_slices(
    cube: xr.Dataset, output: str, x: str, at: Mapping[str, Any] | None = None, *, ax: Axes | None = None
) -> Axes:
    """Draw an output over ``x``, one curve for each value of the axis left open (at most one).

    Arguments as in `study.maps.slices`. Overturned cells are gaps in the curve, marked by a cross on
    the upper border: their values (a peak rotation of pi/2) would hide the others.
    """
    ax = new_axes(ax)
    curves = slices(cube, output, x, at)
    fallen = slices(cube, "status", x, at).values == OVERTURNED
    across, words = positions(curves[x])
    order = across.argsort()
    values = np.array(shown(curves)[0], dtype=float)
    if output not in ALWAYS:
        values[fallen] = np.nan
    rows, flags = np.atleast_2d(values)[:, order], np.atleast_2d(fallen)[:, order]
    names, few = _names(curves), len(rows) <= FEW
    others = positions(curves[str(curves.dims[0])])[0]
    scale = (LogNorm if geometric(np.sort(others)) else Normalize)(others.min(), others.max())
    for k, (row, gone) in enumerate(zip(rows, flags, strict=True)):
        colour = COLOURS[k] if few else colormaps[MAP_COLOURS](scale(others[k]))
        ax.plot(across[order], row, f"{MARKERS[k] if few else ''}-", color=colour, markersize=3, label=names[k])
        if output not in ALWAYS and gone.any():
            border = np.ones(int(gone.sum()))
            place = ax.get_xaxis_transform()
            ax.plot(across[order][gone], border, "x", color=colour, clip_on=False, transform=place)
    if output not in ALWAYS and fallen.any():
        ax.plot([], [], "x", color="0.3", label="overturned")
    handles, texts = ax.get_legend_handles_labels()
    if not few:
        bar = ax.figure.colorbar(ScalarMappable(scale, colormaps[MAP_COLOURS]), ax=ax)
        bar.set_label(label(curves[str(curves.dims[0])]))
        if isinstance(scale, LogNorm):
            set_log_ticks(bar.ax.yaxis)
        handles, texts = handles[len(rows) :], texts[len(rows) :]
    if texts and (curves.ndim > 1 or len(texts) > 1):
        title = label(curves[str(curves.dims[0])]) if few and curves.ndim > 1 else None
        corner = (1.01, 1.0) if few else (0.0, 1.0)
        ax.legend(handles, texts, title=title, fontsize="small", loc="upper left", bbox_to_anchor=corner)
    set_scale(ax, "x", across, words)
    ax.set_xlabel(label(curves[x]))
    ax.set_ylabel(label(curves))
    ax.grid(alpha=0.3)
    if curves.attrs.get("selection"):
        set_title(ax, curves.attrs["selection"])
    return ax


def _names(curves: xr.DataArray) -> list[str]:
    """What the legend calls each curve."""
    if curves.ndim == 1:
        return [str(curves.name).replace("_", " ")]
    other = curves[str(curves.dims[0])]
    values, words = positions(other)
    return words or [f"{value:.4g}" for value in values]
