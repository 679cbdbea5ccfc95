"""Which mechanisms explain the misfit, and what chance alone would give."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from diagnosis.answer.result import Screened
from diagnosis.report.figures.palette import PAPER, Palette
from diagnosis.report.figures.panels import WIDE, is_narrow, legend, new_panels

MOST = 14
"""Suspects drawn; the weaker ones lie inside the band."""
LEAST = 0.5
"""Left end of the axis; less counts as no evidence."""


def order_of(screen: Sequence[Screened]) -> list[Screened]:
    """The strongest first: by gain where refitted, else by score."""
    return sorted(screen, key=lambda s: s.score if s.gain is None else s.gain, reverse=True)


def plot_suspects(
    screen: Sequence[Screened],
    null_band: float,
    *,
    evidence: Mapping[str, float] | None = None,
    rivals: Collection[str] = (),
    width: float = WIDE,
    palette: Palette = PAPER,
) -> Axes:
    """Draw the evidence (gain in 2 log likelihood, logarithmic) of the strongest suspects.

    Hollow: the score, a forecast without a refit; full: the gain of the refit. The band is what
    chance alone stays within 95 times in 100. ``evidence``: of the effects of the answer, in bold; of several it is
    that of each beside the others, a diamond, where the gain is that of each alone. They and their ``rivals`` are drawn
    however weak each is alone.
    """
    named = evidence or {}
    ordered = order_of(screen)
    asked = [s for s in ordered[MOST:] if s.name in named or s.name in rivals]
    shown = order_of([*ordered[: MOST - len(asked)], *asked])
    (ax,) = new_panels([0.36 * max(len(shown), 2) + 1.1], width, palette)
    ax.set_xscale("log")
    ax.axvspan(LEAST, max(null_band, LEAST), color=palette.band, linewidth=0.0, zorder=0, label="chance")
    rows = np.arange(len(shown))[::-1]
    for row, suspect in zip(rows, shown, strict=True):
        score, gain = max(suspect.score, LEAST), suspect.gain
        colour = palette.accent if suspect.name in named else palette.before
        if gain is not None:
            ax.plot([LEAST, max(gain, LEAST)], [row, row], color=colour, linewidth=2.0, zorder=2)
            ax.plot(max(gain, LEAST), row, "o", color=colour, markersize=8, zorder=3)
        ax.plot(score, row, "o", markerfacecolor="none", markeredgecolor=palette.before, markersize=8, zorder=4)
        if len(named) > 1 and suspect.name in named:
            ax.plot(max(named[suspect.name], LEAST), row, "D", color=palette.ink, markersize=7, zorder=5)
    if named:
        ax.plot([], [], "o", color=palette.accent, markersize=8, label="found")
    if len(named) > 1:
        ax.plot([], [], "D", color=palette.ink, markersize=7, label="beside the others", linestyle="none")
    ax.plot([], [], "o", color=palette.before, markersize=8, label="refitted")
    ax.plot([], [], "o", markerfacecolor="none", markeredgecolor=palette.before, markersize=8, label="forecast")
    ax.set_yticks(rows, [suspect.name.replace("_", " ") for suspect in shown])
    for text, suspect in zip(ax.get_yticklabels(), shown, strict=True):
        text.set_fontweight("bold" if suspect.name in named else "normal")
    ax.tick_params(axis="y", length=0)
    ax.set_ylim(-0.7, len(shown) - 0.3)
    top = max([null_band, *named.values(), *(max(s.score, s.gain or 0.0) for s in shown)], default=1.0)
    ax.set_xlim(LEAST, 2.0 * top)
    ticks = [t for t in (1, 10, 100, 1000, 10_000, 100_000, 1_000_000) if t < 2.0 * top]
    ax.set_xticks(ticks, [f"{t:,}".replace(",", " ") for t in ticks])
    ax.minorticks_off()
    ax.set_xlabel("evidence" if is_narrow(width) else "evidence (gain in 2 log likelihood)")
    legend(ax, palette)
    return ax
