"""Where the models miss: one strip a recording and channel, a cell a window, before above after."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes

from diagnosis.answer.result import Located, Windows
from diagnosis.report.figures.levels import draw_cells, explain_levels
from diagnosis.report.figures.palette import PAPER, Palette
from diagnosis.report.figures.panels import WIDE, figure_of, is_narrow, name_panel, new_panels

STRIP = 1.05
"""Inches of height a strip, its title included."""
GAP = 0.02
"""Inches between windows that follow each other."""


def plot_raster(
    windows: Sequence[Windows],
    shows: Sequence[Located] = (),
    *,
    width: float = WIDE,
    palette: Palette = PAPER,
) -> tuple[Axes, ...]:
    """Draw the rms residual of every window over the noise, with the intervals in which it ``shows`` as brackets.

    Each of ``windows`` is one recording and channel; the upper half of its strip is the base model,
    the lower half the extended one. Times in s, one scale for all strips.
    """
    below = 1.3 if is_narrow(width) else 1.0
    panels = new_panels([STRIP] * len(windows), width, palette, sharex=True, below=below)
    end = max(float(strip.end.max(initial=1.0)) for strip in windows)
    gap = GAP / width * end
    for ax, strip in zip(panels, windows, strict=True):
        _draw_strip(ax, strip, gap, palette)
        for place in shows:
            if (place.recording, place.channel) == (strip.recording, strip.channel):
                _bracket(ax, place, palette)
    panels[-1].set_xlim(0.0, end)
    panels[-1].set_xlabel("time [s]")
    explain_levels(figure_of(panels[-1]), palette, columns=3 if is_narrow(width) else 6)
    return tuple(panels)


def _draw_strip(ax: Axes, strip: Windows, gap: float, palette: Palette) -> None:
    length = strip.end - strip.start - gap
    for bottom, values in ((0.52, strip.before), (0.0, strip.after)):
        draw_cells(ax, strip.start, bottom, length, 0.44, values, palette)
    ax.set_ylim(-0.06, 1.2)
    ax.set_yticks([0.74, 0.22], ["before", "after"])
    ax.tick_params(axis="y", length=0)
    ax.spines["left"].set_visible(False)
    held = ", held out" if strip.held_out else ""
    name_panel(ax, f"{strip.recording}{held}: {strip.channel}", palette)


def _bracket(ax: Axes, place: Located, palette: Palette) -> None:
    ax.plot(
        [place.start, place.start, place.end, place.end], [1.04, 1.16, 1.16, 1.04],
        color=palette.ink, linewidth=1.2, solid_joinstyle="miter",
    )  # fmt: skip
