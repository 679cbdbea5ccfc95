"""What `study.sensitivity.analysis` finds: indices with intervals, tornadoes, interactions."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from scipy.stats import norm

from study.figures.style import COLOURS, MAP_COLOURS, literal, new_axes, set_title
from study.sensitivity.analysis import LEADING
from study.wording import title


def plot_indices(found: xr.Dataset, output: str, motions: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw total and first-order indices with their intervals; of a screening mu* with its interval, and sigma."""
    one, names = _ordered(found, output, motions)
    ax = _frame(ax, names)
    rows = np.arange(len(names))[::-1]
    pairs = (("total", 0.14), ("first", -0.14)) if found.attrs["kind"] == "saltelli" else (("mu_star", 0.0),)
    words = {"total": "total, with interactions", "first": "alone", "mu_star": "μ*"}
    for (name, shift), colour in zip(pairs, COLOURS, strict=False):
        value = one[name].values
        ends = np.array([value - one[f"{name}_low"].values, one[f"{name}_high"].values - value])
        ax.errorbar(value, rows + shift, xerr=ends, fmt="o", color=colour, markersize=4, label=words[name])
    if "sigma" in one:
        ax.plot(one["sigma"].values, rows, "x", color=COLOURS[1], label="σ")
        ax.set_xlabel(f"elementary effect on {_words(output)} over the whole range", loc="right")
    else:
        ax.set_xlabel(f"share of the variance of {_words(output)}", loc="right")
    ax.set_xlim(left=min(0.0, ax.get_xlim()[0]))
    ax.axvline(0.0, color="0.6", linewidth=0.8)
    ax.legend(fontsize="small", loc="lower right")
    set_title(ax, _title(found, one))
    return ax


def plot_tornado(found: xr.Dataset, output: str, motions: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw, parameter by parameter, the mean of the output in its lowest and in its highest fifth."""
    one, names = _ordered(found, output, motions)
    ax = _frame(ax, names)
    rows = np.arange(len(names))[::-1]
    mean = float(one["mean"])
    ends = (("at_low", 0.17, COLOURS[5], "lowest fifth"), ("at_high", -0.17, COLOURS[1], "highest fifth"))
    for name, shift, colour, text in ends:  # side by side: both may lie on one side of the mean
        ax.barh(rows + shift, one[name].values - mean, left=mean, color=colour, height=0.34, label=text)
    ax.axvline(mean, color="black", linewidth=0.8)
    ax.set_xlabel(f"mean of {_words(output)}")
    ax.legend(fontsize="small", loc="lower right", title="of the parameter")
    set_title(ax, _title(found, one))
    return ax


def plot_interactions(found: xr.Dataset, output: str, motions: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw second-order Sobol indices: the share of the variance that two parameters explain together only.

    Pairs are left grey whose interval does not lie above zero: intervals so wide that all of them hold at once with the
    stated confidence (Bonferroni).
    """
    one, names = _ordered(found, output, motions)
    order = [found["parameter"].values.tolist().index(name) for name in one["parameter"].values]
    half, beyond = one["second"] - one["second_low"], 1.0 - found.attrs["confidence"]
    pairs = len(names) * (len(names) - 1) / 2
    wider = norm.isf(beyond / (2.0 * pairs)) / norm.isf(beyond / 2.0)
    values = one["second"].where(one["second"] > wider * half).values[:, order]
    ax = new_axes(ax, 1.6 + 0.5 * len(names), 1.2 + 0.45 * len(names))
    largest = max(float(np.max(values, initial=0.0, where=np.isfinite(values))), 0.01)
    drawn = ax.imshow(values, cmap=colormaps[MAP_COLOURS].with_extremes(bad="0.9"), vmin=0.0, vmax=largest)
    ax.figure.colorbar(drawn, ax=ax).set_label(f"share of the variance of {_words(output)} (grey: none beyond chance)")
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_ticks(np.arange(len(names)), names)
    plt.setp(ax.get_xticklabels(), rotation=40, ha="right")
    set_title(ax, _title(found, one))
    return ax


def _ordered(found: xr.Dataset, output: str, motions: str | None) -> tuple[xr.Dataset, list[str]]:
    """One output, its parameters with the strongest first, and their names."""
    one = found.sel(output=output).sel(motions=motions) if motions else found.sel(output=output).isel(motions=0)
    one = one.isel(parameter=np.argsort(-one[LEADING[found.attrs["kind"]]].values))
    return one, [literal(title(str(name))) for name in one["parameter"].values]


def _frame(ax: Axes | None, names: list[str]) -> Axes:
    ax = new_axes(ax, 6.4, 1.5 + 0.32 * len(names))
    ax.set_yticks(np.arange(len(names))[::-1], names)
    ax.grid(alpha=0.3, axis="x")
    return ax


def _words(output: str) -> str:
    return output.replace("_", " ")


def _title(found: xr.Dataset, one: xr.Dataset) -> str:
    return ", ".join(part for part in (str(one["motions"].values), f"{found.attrs['points']} points") if part)
