"""How far the misfit fell, and how far it could fall: before, after, noise."""

from __future__ import annotations

from matplotlib.axes import Axes

from diagnosis.answer.result import Fit
from diagnosis.report.figures.palette import PAPER, Palette
from diagnosis.report.figures.panels import FONT, WIDE, legend, new_panels


def plot_fits(train: Fit, holdout: Fit | None, *, width: float = WIDE, palette: Palette = PAPER) -> Axes:
    """Draw the relative rms misfit in %, one row for the recordings fitted, one for those held out."""
    rows = [("fitted", train)] if holdout is None else [("held out", holdout), ("fitted", train)]
    (ax,) = new_panels([0.5 * len(rows) + 1.0], width, palette)
    for y, (_, fit) in enumerate(rows):
        ax.plot([100 * fit.before, 100 * fit.after], [y, y], color=palette.faint, linewidth=3.0, zorder=1)
        ax.plot(100 * fit.noise_floor, y, "|", color=palette.ink, markersize=18, markeredgewidth=1.5, zorder=2)
        ax.plot(100 * fit.before, y, "o", markerfacecolor="none", markeredgecolor=palette.before,
                markeredgewidth=1.8, markersize=9, zorder=3)  # fmt: skip
        ax.plot(100 * fit.after, y, "o", color=palette.accent, markersize=9, zorder=4)
        ax.annotate(f"{100 * fit.before:.3g} %", (100 * fit.before, y), xytext=(9, 0), fontsize=FONT - 1,
                    textcoords="offset points", va="center", color=palette.ink)  # fmt: skip
    ax.plot([], [], "o", markerfacecolor="none", markeredgecolor=palette.before, markeredgewidth=1.8, label="before")
    ax.plot([], [], "o", color=palette.accent, label="after")
    ax.plot([], [], "|", color=palette.ink, markersize=12, markeredgewidth=1.5, linestyle="none", label="noise")
    legend(ax, palette)
    ax.set_yticks(range(len(rows)), [name for name, _ in rows])
    ax.tick_params(axis="y", length=0)
    ax.set_ylim(-0.6, len(rows) - 0.4)
    ax.set_xlim(0.0, 118 * max(max(fit.before, fit.after, fit.noise_floor) for _, fit in rows))
    ax.set_xlabel("misfit [% of the channel's rms]")
    return ax
