"""What was read: the motion of the base and every response channel of a recording."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from diagnosis.report.figures.curve import thin
from diagnosis.report.figures.palette import PAPER, Palette
from diagnosis.report.figures.panels import WIDE, in_milli, is_narrow, name_panel, new_panels
from grids.recordings import Recording

GRAVITY = 9.80665


def plot_recording(recording: Recording, *, width: float = WIDE, palette: Palette = PAPER) -> tuple[Axes, ...]:
    """Draw each channel of a recording over time, accelerations of the base in g; levels together."""
    names = list(recording.channels)
    panels = new_panels([1.4] * len(names), width, palette, sharex=True, below=0.5)
    for ax, name in zip(panels, names, strict=True):
        channel = recording.channel(name)
        values, unit = in_milli(recording.channels[name], channel.unit)
        if channel.unit == "m s-2":
            values, unit = recording.channels[name] / GRAVITY, "g"
        colour = palette.ink if channel.response else palette.before
        for row in np.atleast_2d(values):
            ax.plot(*thin(recording.time, row, is_narrow(width)), color=colour, linewidth=1.0)
        name_panel(ax, f"{name.replace('_', ' ')} [{unit}]", palette)
        ax.axhline(0.0, color=palette.faint, linewidth=0.8, zorder=0)
    panels[-1].set_xlim(0.0, float(recording.time[-1]))
    panels[-1].set_xlabel("time [s]")
    return tuple(panels)
