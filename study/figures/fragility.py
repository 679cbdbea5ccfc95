"""Fragility curves: shares with their intervals, the lognormal fit with its band."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from study.figures.style import COLOURS, new_axes, positions, set_title, symbol_label
from study.selection import value_shown
from study.wording import unit_shown

FEW = 6


def plot_fragility(found: xr.Dataset, *, ax: Axes | None = None) -> Axes:
    """Draw what `study.sets.fragility.fragility` gives, one colour for each value of its further axis."""
    ax = new_axes(ax)
    factor, _ = unit_shown(str(found["level"].attrs.get("units", "1")))
    over = [str(dim) for dim in found["median"].dims]
    count = found.sizes[over[0]] if over else 1
    shown = np.unique(np.linspace(0, count - 1, min(count, FEW)).round().astype(int))
    for k, colour in zip(shown.tolist(), COLOURS, strict=False):
        one = found.isel({over[0]: k}) if over else found
        text = value_shown(found[over[0]], positions_of(found, over[0])[k]) if over else "lognormal fit"
        share = one["share"].values
        ends = np.array([share - one["share_low"].values, one["share_high"].values - share]).clip(0.0)
        ax.errorbar(factor * one["strength"], share, ends, fmt="o", color=colour, markersize=3, linewidth=0.7)
        ax.plot(factor * one["level"], one["probability"], color=colour, label=text)
        ax.fill_between(
            factor * one["level"],
            one["probability_low"],
            one["probability_high"],
            color=colour,
            alpha=0.15,
            linewidth=0,
        )
    ax.set_xlabel(symbol_label(found["level"]))
    ax.set_ylabel(f"probability ({found.attrs['event'].replace('_', ' ')})")
    ax.set_ylim(-0.02, 1.02)
    ax.set_xlim(left=0.0)
    ax.grid(alpha=0.3)
    title = over[0].replace("_", " ") if over else None
    ax.legend(title=title, fontsize="small", loc="lower right")
    of = f"of {found.attrs['samples']} samples" if found.attrs["samples"] else "intervals"
    what = f"{found.attrs['motions']} motions, {found.attrs['confidence']:.0%} {of}"
    set_title(ax, ", ".join(part for part in (found.attrs["selection"], what) if part))
    return ax


def positions_of(found: xr.Dataset, dim: str) -> list[object]:
    """Values of an axis as they stand in the Dataset, words included."""
    return list(found[dim].values) if positions(found[dim])[1] is None else [str(v) for v in found[dim].values]
