"""One observable over time, with the instants at which something happens."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from study.figures.style import COLOURS, label, literal, new_axes

EVENTS = (
    ("impact", "|", COLOURS[1]),
    ("onset", "^", COLOURS[2]),
    ("uplift", "^", COLOURS[2]),
    ("closing", "v", COLOURS[5]),
    ("rest", "s", COLOURS[6]),
    ("overturned", "X", COLOURS[1]),
)


def plot_history(history: xr.Dataset, channel: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw ``channel`` of a history over time; impacts, onsets, rest and overturning are marked.

    Without a ``channel``: the rotation of the first body, or the displacements of the levels.

    ``history`` is what `rocking simulate` writes: channels over ``time``, ``event_time`` and
    ``event_kind`` (CF flags) over ``event``. A channel over ``level`` gives one curve a level.
    """
    ax = new_axes(ax, 8.0, 3.6)
    values = history[channel or ("rotation_1" if "rotation_1" in history else "level_displacement_x")]
    time = history["time"].values
    if values.ndim == 1:
        ax.plot(time, values.values, color=COLOURS[0], linewidth=1.0)
    else:
        other = str(next(dim for dim in values.dims if dim != "time"))
        for k, curve in enumerate(values.transpose(other, "time").values):
            ax.plot(time, curve, color=COLOURS[k % len(COLOURS)], linewidth=1.0, label=f"{other} {k + 1}")
    if "event_kind" in history:
        _mark_events(ax, history, values)
    ax.axhline(0.0, color="0.6", linewidth=0.6, zorder=0)
    ax.set_xlim(time[0], time[-1])
    ax.set_xlabel("time [s]")
    ax.set_ylabel(label(values))
    ax.set_title(literal(str(history.attrs.get("title", ""))), fontsize="medium", loc="left")
    if ax.get_legend_handles_labels()[0]:
        ax.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), fontsize="small", ncols=4, frameon=False)
    return ax


def _mark_events(ax: Axes, history: xr.Dataset, values: xr.DataArray) -> None:
    kinds = dict(zip(history["event_kind"].attrs["flag_meanings"].split(), _flags(history), strict=True))
    one_curve = values.ndim == 1
    for kind, marker, colour in EVENTS:
        at = history["event_time"].values[history["event_kind"].values == kinds.get(kind, -1)]
        if at.size:
            height = np.interp(at, history["time"].values, values.values) if one_curve else np.zeros(at.size)
            text = f"{kind} ({at.size})"
            ax.plot(at, height, marker, color=colour, markersize=6, linestyle="none", label=text)


def _flags(history: xr.Dataset) -> np.ndarray:
    return np.atleast_1d(history["event_kind"].attrs["flag_values"])
