"""Curves of one output along one axis."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes

from study.figures.style import COLOURS, MAP_COLOURS, label, new_axes, positions, set_words, shown
from study.maps import slices

MARKERS = "osD^vPX*"
FEW = 8


def plot_slices(
    cube: xr.Dataset, output: str, x: str, at: Mapping[str, Any] | None = None, *, ax: Axes | None = None
) -> Axes:
    """Draw an output over ``x``, one curve for each value of the axis left open (at most one).

    Arguments as in `study.maps.slices`.
    """
    ax = new_axes(ax)
    curves = slices(cube, output, x, at)
    across, words = positions(curves[x])
    order = across.argsort()
    if curves.ndim == 1:
        ax.plot(across[order], shown(curves)[0][order], "o-", color=COLOURS[0], markersize=3)
    else:
        other = curves[str(curves.dims[0])]
        values, names = positions(other)
        few = len(values) <= FEW
        shades = colormaps[MAP_COLOURS]
        for k, curve in enumerate(curves):
            colour = COLOURS[k % len(COLOURS)] if few else shades(k / (len(values) - 1))
            ax.plot(
                across[order],
                shown(curve)[0][order],
                f"{MARKERS[k % len(MARKERS)]}-" if few else "-",
                color=colour,
                markersize=3,
                label=names[k] if names else f"{values[k]:.4g}",
            )
        ax.legend(title=label(other), fontsize="small", ncols=1 if few else 2)
    set_words(ax, "x", words)
    ax.set_xlabel(label(curves[x]))
    ax.set_ylabel(label(curves))
    ax.grid(alpha=0.3)
    if curves.attrs.get("selection"):
        ax.set_title(curves.attrs["selection"], fontsize="medium")
    return ax
