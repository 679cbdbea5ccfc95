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

from study.figures.outcomes import marked
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

MARKERS = "osD^vPX*"
FEW = 8
"""Up to so many curves have a colour and a line of the legend each; more have a colour bar."""


def plot_slices(
    cube: xr.Dataset, output: str, x: str, at: Mapping[str, Any] | None = None, *, ax: Axes | None = None
) -> Axes:
    """Draw an output over ``x``, one curve for each value of the axis left open (at most one).

    Arguments as in `study.maps.slices`. Overturned cells, whose values (a peak rotation of pi/2) would hide the
    others, and cells without an answer are gaps in the curve and a mark each on the upper border.
    """
    ax = new_axes(ax)
    curves = slices(cube, output, x, at)
    across, words = positions(curves[x])
    order = across.argsort()
    rows = np.atleast_2d(np.array(shown(curves)[0], dtype=float))[:, order]
    status = np.atleast_2d(slices(cube, "status", x, at).values)[:, order]
    outcomes = marked(output, status)
    rows = np.where(np.isin(status, [outcome.flag for outcome in outcomes]), np.nan, rows)
    few = len(rows) <= FEW
    names = _names(curves)
    others, other_words = positions(curves[str(curves.dims[0])])
    scale = (LogNorm if geometric(np.sort(others)) else Normalize)(others.min(), others.max())
    for k, (row, flags) in enumerate(zip(rows, status, strict=True)):
        colour = COLOURS[k] if few else colormaps[MAP_COLOURS](scale(others[k]))
        ax.plot(across[order], row, f"{MARKERS[k] if few else ''}-", color=colour, markersize=3, label=names[k])
        for outcome in outcomes:
            there = across[order][flags == outcome.flag]
            ax.plot(
                there,
                np.ones(there.size),
                outcome.marker,
                color=colour,
                clip_on=False,
                transform=ax.get_xaxis_transform(),
            )
    for outcome in outcomes:
        ax.plot([], [], outcome.marker, color="0.3", label=outcome.words)
    handles, texts = ax.get_legend_handles_labels()
    if not few:
        bar = ax.figure.colorbar(ScalarMappable(scale, colormaps[MAP_COLOURS]), ax=ax)
        bar.set_label(label(curves[str(curves.dims[0])]))
        if other_words is not None:
            bar.set_ticks(others.tolist(), labels=other_words)
        elif isinstance(scale, LogNorm):
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
