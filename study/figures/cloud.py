"""Clouds of cells over a measure of the motion, and the measures in the order in which they sort outcomes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from models.errors import InputError
from models.errors import nearest as closest
from study.figures.style import COLOURS, label, new_axes, set_log_ticks, set_title, shown, symbol_label
from study.sets.cells import MOTION, NAMES, chosen_cells, find_measure, intensity
from study.status import OVERTURNED, UNKNOWN

DECADES = 1e4
"""Values below the largest over this are not drawn."""


def plot_cloud(
    cube: xr.Dataset, output: str, measure: str = "pgv", at: Mapping[str, Any] | None = None, *, ax: Axes | None = None
) -> Axes:
    """Draw an output of every cell over a measure of its motion; overturned cells stand on the upper border."""
    if output not in cube.data_vars or output == "status":
        known = [str(name) for name in cube.data_vars if name != "status"]
        raise InputError(f"'{output}' is no output of this cube: {closest(output, known)}")
    ax = new_axes(ax)
    cells, selection = chosen_cells(cube, at)
    strength = intensity(cells, measure)
    across, values = shown(strength)[0].ravel(), np.asarray(shown(cells[output])[0], dtype=float).ravel()
    status = cells["status"].values.ravel()
    standing = ~np.isin(status, (*UNKNOWN, OVERTURNED))
    stands = standing & (values > 0.0)
    at_zero = int(standing.sum() - stands.sum())
    count = f"{standing.sum()}, {at_zero} of them at zero: not drawn" if at_zero else f"{standing.sum()}"
    ax.plot(across[stands], values[stands], ".", color=COLOURS[0], markersize=4, label=f"stands ({count})")
    fallen = status == OVERTURNED
    ax.plot(
        across[fallen],
        np.ones(fallen.sum()),
        "x",
        color=COLOURS[1],
        markersize=4,
        clip_on=False,
        transform=ax.get_xaxis_transform(),
        label=f"overturned ({fallen.sum()})",
    )
    ax.set_xscale("log")
    if stands.any():
        ax.set_yscale("log")
        ax.set_ylim(bottom=max(values[stands].max() / DECADES, 0.5 * values[stands].min()))
    if across.max() < 50.0 * across.min():
        set_log_ticks(ax.xaxis)
    ax.set_xlabel(symbol_label(strength))
    ax.set_ylabel(label(cells[output]))
    ax.grid(alpha=0.3)
    ax.legend(fontsize="small", loc="upper left", bbox_to_anchor=(1.02, 1.0))
    set_title(ax, ", ".join(part for part in (selection, f"{cells.sizes[MOTION]} motions") if part))
    return ax


def plot_sorting(found: xr.Dataset, *, ax: Axes | None = None) -> Axes:
    """Draw what `study.sets.sorting.sorting` gives: how well each measure sorts, best on top."""
    ax = new_axes(ax, 6.4, 0.32 * found.sizes["measure"] + 1.4)
    rows = np.arange(found.sizes["measure"])[::-1]
    area = found["area"].values
    ends = np.array([area - found["area_low"].values, found["area_high"].values - area])
    ax.errorbar(area, rows, xerr=np.nan_to_num(ends), fmt="o", color=COLOURS[0], markersize=4)
    names = [find_measure(name).symbol for name in found["measure"].values.tolist() if name in NAMES]
    ax.set_yticks(rows, names)
    ax.axvline(0.5, color="0.6", linewidth=0.8)
    ax.set_xlabel(f"chance that the larger measure is the one that {found.attrs['event'].replace('_', ' ')}")
    ax.set_xlim(min(0.45, float(area.min()) - 0.05), 1.0)
    ax.grid(alpha=0.3, axis="x")
    set_title(ax, ", ".join(part for part in (found.attrs["selection"], f"{found.attrs['motions']} motions") if part))
    return ax
