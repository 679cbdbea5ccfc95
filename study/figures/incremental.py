"""Curves of incremental dynamic analysis with their quantiles."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from study.figures.style import COLOURS, label, new_axes, set_title, shown, symbol_label
from study.wording import unit_shown


def plot_incremental(found: xr.Dataset, *, ax: Axes | None = None) -> Axes:
    """Draw what `study.sets.incremental.incremental` gives: the output across, the intensity up, as is the custom.

    A curve ends where its wall overturns, with a cross on the right border; quantiles go flat there.
    """
    ax = new_axes(ax)
    values = found[found.attrs["output"]]
    across = shown(values)[0]
    factor, _ = unit_shown(str(found["level"].attrs["units"]))
    finite = across[np.isfinite(across)]
    edge = 1.05 * float(finite.max()) if finite.size else 1.0
    for x, y in zip(across, factor * found["strength"].values, strict=True):
        stands = np.isfinite(x)
        ax.plot(np.where(stands, x, np.nan), y, color="0.75", linewidth=0.6, zorder=1)
        falls = np.flatnonzero(np.isinf(x))
        if falls.size:
            ax.plot(edge, y[falls[0]], "x", color="0.6", markersize=4, clip_on=False, zorder=2)
    for k, quantile in enumerate(found["quantile"].values):
        row = found["quantile_curves"].values[k] * unit_shown(str(values.attrs.get("units", "1")))[0]
        height = factor * found["level"].values
        ax.plot(np.minimum(row, edge), height, color=COLOURS[k], linewidth=1.8, label=f"{quantile:.0%} of the motions")
    ax.plot([], [], "x", color="0.6", label="overturns for the first time")
    ax.set_xlim(0.0, edge)
    ax.set_ylim(bottom=0.0)
    ax.set_xlabel(label(values))
    ax.set_ylabel(symbol_label(found["level"]))
    ax.grid(alpha=0.3)
    ax.legend(fontsize="small", loc="center left", bbox_to_anchor=(1.02, 0.5))
    set_title(ax, ", ".join(part for part in (found.attrs["selection"], f"{found.attrs['motions']} motions") if part))
    return ax
