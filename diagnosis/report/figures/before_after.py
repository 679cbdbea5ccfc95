"""Measured and predicted on one recording, and what the predictions leave over."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from diagnosis.answer.result import Trace, Windows
from diagnosis.report.figures.curve import FloatArray, thin
from diagnosis.report.figures.palette import PAPER, Palette
from diagnosis.report.figures.panels import WIDE, in_milli, is_narrow, legend, name_panel, new_panels


def plot_before_after(trace: Trace, *, width: float = WIDE, palette: Palette = PAPER) -> tuple[Axes, ...]:
    """Draw measurement and both predictions over time, below them the residuals.

    Predictions start anew at each window and stand nowhere else. Where the trace holds runs from
    rest, a third panel shows them.
    """
    from_rest = trace.from_rest_before is not None and trace.from_rest_after is not None
    narrow = is_narrow(width)
    panels = new_panels([2.4, 1.9, *([1.9] if from_rest else [])], width, palette, sharex=True, below=0.5)
    ax = panels[0]
    measured, unit = in_milli(trace.measured, trace.unit)
    _curve(ax, trace, measured, narrow, color=palette.ink, linewidth=2.4, alpha=0.35, label="measured")
    _curve(ax, trace, in_milli(trace.before, trace.unit)[0], narrow, color=palette.before, linewidth=1.2,
           linestyle=(0, (4, 2)), label="before")  # fmt: skip
    _curve(ax, trace, in_milli(trace.after, trace.unit)[0], narrow, color=palette.accent, linewidth=1.3, label="after")
    words = trace.channel.replace("_", " ")
    name_panel(ax, "" if narrow else f"{trace.recording}, window by window", palette)
    ax.set_ylabel(f"{words} [{unit}]")
    legend(ax, palette)
    ax = panels[1]
    for values, colour, style in ((trace.before, palette.before, (0, (4, 2))), (trace.after, palette.accent, "-")):
        left = in_milli(trace.measured - values, trace.unit)[0]
        _curve(ax, trace, left, narrow, color=colour, linewidth=1.1, linestyle=style)
    ax.set_ylabel(f"residual [{unit}]")
    if trace.from_rest_before is not None and trace.from_rest_after is not None:
        ax = panels[2]
        _curve(ax, trace, measured, narrow, color=palette.ink, linewidth=2.4, alpha=0.35)
        for values, colour, style in (
            (trace.from_rest_before, palette.before, (0, (4, 2))),
            (trace.from_rest_after, palette.accent, "-"),
        ):
            _curve(ax, trace, in_milli(values, trace.unit)[0], narrow, color=colour, linewidth=1.2, linestyle=style)
        top = 1.4 * float(np.nanmax(np.abs(measured)))
        ax.set_ylim(-top, top)
        ax.set_ylabel(f"from rest [{unit}]")
    for ax in panels:
        ax.axhline(0.0, color=palette.faint, linewidth=0.8, zorder=0)
    panels[-1].set_xlim(trace.time[0], trace.time[-1])
    panels[-1].set_xlabel("time [s]")
    return tuple(panels)


def worst_window(windows: Sequence[Windows]) -> tuple[Windows, int]:
    """The strip and the index of the window that the extended model misses most; held-out recordings first."""
    held = [strip for strip in windows if strip.held_out and strip.after.size]
    strips = held or [strip for strip in windows if strip.after.size]
    strip = max(strips, key=lambda one: float(one.after.max()))
    return strip, int(np.argmax(strip.after))


def plot_worst_window(
    traces: Sequence[Trace], windows: Sequence[Windows], *, width: float = WIDE, palette: Palette = PAPER
) -> tuple[Axes, ...]:
    """Draw measurement, both predictions and their residuals in the window that the extended model misses most."""
    strip, k = worst_window(windows)
    trace = next(t for t in traces if (t.recording, t.channel) == (strip.recording, strip.channel))
    inside = (trace.time >= strip.start[k]) & (trace.time < strip.end[k])
    cut = {name: getattr(trace, name)[inside] for name in ("time", "measured", "before", "after")}
    return plot_before_after(
        replace(trace, **cut, from_rest_before=None, from_rest_after=None), width=width, palette=palette
    )


def _curve(ax: Axes, trace: Trace, values: FloatArray, narrow: bool, **style: Any) -> None:
    ax.plot(*thin(trace.time, values, narrow), **style)
