"""Rocking spectra and overturning acceleration spectra."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from study.figures.style import COLOURS, NOTHING, UNKNOWN, edges, new_axes, set_log_ticks, set_title
from study.sets.spectra import P, three_curves

ROCKS = "#F5C9A3"


def plot_rocking_spectrum(found: xr.Dataset, *, ax: Axes | None = None) -> Axes:
    """Draw largest rotation over slenderness angle against 2 pi/p, each motion and their median.

    Overturned walls are gaps in the curves of the motions; the median leaves the figure where half of them overturn.
    """
    ax = new_axes(ax)
    period = found["period_parameter"].values
    order = period.argsort()
    rows = found["peak_rotation_ratio"].values[:, order]
    single = len(rows) == 1
    for row in rows:
        gaps = np.where(np.isfinite(row), row, np.nan)
        ax.plot(period[order], gaps, color=COLOURS[0] if single else "0.75", linewidth=1.2 if single else 0.6)
    if not single:
        median = np.quantile(rows, 0.5, axis=0, method="inverted_cdf")
        ax.plot(period[order], np.where(np.isfinite(median), median, np.nan), color=COLOURS[0], label="median")
        ax.plot([], [], color="0.75", label="one motion")
        ax.legend(fontsize="small")
    ax.set_xlabel(r"$2\pi/p$ [s]")
    ax.set_ylabel(r"$\max|\theta|/\alpha$")
    ax.set_ylim(bottom=0.0)
    ax.grid(alpha=0.3)
    set_title(ax, _title(found))
    return ax


def plot_overturning_spectrum(found: xr.Dataset, motion: int | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw PGA over onset acceleration against p with the three curves 1, 1/(p t_I), 1/(p t_M)^2 beside.

    For one motion (its number, or the only one): what stands, rocks and overturns. For a set: the smallest ratio that
    overturns, of each motion, and its quantiles; the curves are those of the median t_I and t_M.
    """
    ax = new_axes(ax)
    single = motion is not None or found.sizes["motion"] == 1
    one = found.isel(motion=motion or 0) if single else found
    p = found[P].values
    ratio = found["onset_ratio"]
    handles = _draw_region(ax, one, p, ratio.values) if single else _draw_set(ax, found, p)
    fine = xr.DataArray(np.geomspace(p.min(), p.max(), 200), dims="p")
    times = [one[name].median("motion") if not single else one[name] for name in ("t_impulse", "t_moment")]
    for (name, curve), style in zip(three_curves(fine, *times).items(), (":", "--", "-."), strict=True):
        handles += ax.plot(fine, curve, style, color="black", linewidth=1.4, label=name)
    ax.set_xscale("log")
    ax.set_yscale("log")
    for axis, values in ((ax.xaxis, p), (ax.yaxis, ratio.values)):
        if values.max() < 200.0 * values.min():
            set_log_ticks(axis)
    ax.set_xlim(p.min(), p.max())
    ax.set_ylim(float(ratio.min()), float(ratio.max()))
    ax.set_xlabel("p [s⁻¹]")
    ax.set_ylabel(r"PGA / (g tan $\alpha$)")
    ax.legend(handles=handles, fontsize="small", loc="upper left", bbox_to_anchor=(1.02, 1.0))
    set_title(ax, _title(found, str(one["motion"].values) if motion is not None else ""))
    return ax


def _draw_region(ax: Axes, one: xr.Dataset, p: np.ndarray, ratio: np.ndarray) -> list[Artist]:
    kind = np.where(one["overturns"] == 1.0, 2.0, np.where(one["rocks"] == 1.0, 1.0, 0.0))
    kind = np.where(np.isfinite(one["overturns"]), kind, 3.0)
    order = p.argsort()
    # one slenderness: the ratios are the same at every p, but for rounding
    borders = edges(p[order]), edges(ratio.mean(axis=0))
    colours = (NOTHING, ROCKS, COLOURS[1], UNKNOWN)
    ax.pcolormesh(*borders, kind[order].T, cmap=ListedColormap(colours), vmin=0, vmax=3)
    words = ("stands", "rocks", "overturns", "unknown")
    present = np.unique(kind).astype(int).tolist()
    return [Patch(facecolor=colours[k], edgecolor="0.4", label=words[k]) for k in present]


def _draw_set(ax: Axes, found: xr.Dataset, p: np.ndarray) -> list[Artist]:
    order = p.argsort()
    for row in found["smallest"].values[:, order]:
        ax.plot(p[order], np.where(np.isfinite(row), row, np.nan), color="0.75", linewidth=0.6)
    handles: list[Artist] = [Line2D([], [], color="0.75", label="smallest of one motion")]
    for k, quantile in enumerate(found["quantile"].values):
        row = found["quantile_curves"].values[k, order]
        row = np.where(np.isfinite(row), row, np.nan)
        handles += ax.plot(p[order], row, color=COLOURS[k], linewidth=1.6, label=f"{quantile:.0%} of the motions")
    return handles


def _title(found: xr.Dataset, motion: str = "") -> str:
    count = found.sizes["motion"]
    what = motion or (f"{count} motions" if count > 1 else "")
    return ", ".join(part for part in (what, found.attrs["selection"]) if part)
