"""Figures of outcomes: chances against a measure, reliability, accuracy of every predictor."""

from __future__ import annotations

from functools import partial

from matplotlib.axes import Axes

from diagnosis.outcomes.answer import Compared, OutcomeDiagnosis
from diagnosis.outcomes.measures import UNITS
from diagnosis.report.figures.palette import PAPER, Palette
from diagnosis.report.figures.panels import WIDE, legend, new_panels
from diagnosis.report.svg import Draw

SHOWN = "PGV"
"""The measure that the runs are drawn over."""


def drawings(answer: OutcomeDiagnosis) -> dict[str, Draw]:
    """Every figure by name; functions of ``width`` (inches) and ``palette``."""
    return {
        "chances": partial(plot_chances, answer),
        "accuracy": partial(plot_accuracy, answer),
        "reliability": partial(plot_reliability, answer),
    }


def plot_chances(answer: OutcomeDiagnosis, *, width: float = WIDE, palette: Palette = PAPER) -> tuple[Axes, ...]:
    """Chance of every run, predicted from the other groups, over a measure of its motion: base and extended model."""
    shown = [one for one in answer.compared if one.cross_validated and "model" in one.by]
    axes = new_panels([2.0] * len(shown), width, palette)
    x, fell = answer.measures[SHOWN], answer.overturned > 0.5
    for ax, one in zip(axes, shown, strict=True):
        ax.axhline(0.5, color=palette.faint, linewidth=1.0)
        ax.plot(x[~fell], one.chance[~fell], "o", markerfacecolor="none", markeredgecolor=palette.before,
                markersize=5, label="stood")  # fmt: skip
        ax.plot(x[fell], one.chance[fell], "o", color=palette.accent, markersize=5, label="overturned")
        ax.set_xscale("log")
        ax.xaxis.set_major_formatter("{x:g}")
        ax.xaxis.set_minor_formatter("{x:g}")
        ax.set_ylim(-0.04, 1.04)
        ax.set_ylabel("chance predicted")
        ax.set_title(one.by, loc="left", fontsize="medium", color=palette.ink)
    legend(axes[0], palette)
    axes[-1].set_xlabel(f"{SHOWN} [{UNITS[SHOWN]}]")
    return tuple(axes)


def plot_accuracy(answer: OutcomeDiagnosis, *, width: float = WIDE, palette: Palette = PAPER) -> Axes:
    """Share of runs predicted right, every group from the others, with 95 % intervals."""
    rows = [one for one in reversed(answer.compared) if one.cross_validated]
    (ax,) = new_panels([0.4 * len(rows) + 1.0], width, palette)
    for y, one in enumerate(rows):
        a = one.scores.accuracy
        colour = palette.accent if one.by.startswith("extended") else palette.before
        ax.plot([a.low95, a.high95], [y, y], color=colour, linewidth=2.0)
        ax.plot(a.value, y, "o", color=colour, markersize=8)
        ax.annotate(f"{100 * a.value:.1f} %", (a.value, y), xytext=(0, 7), textcoords="offset points",
                    ha="center", color=palette.ink, fontsize="small")  # fmt: skip
    ax.set_yticks(range(len(rows)), [_name(one) for one in rows])
    ax.set_ylim(-0.6, len(rows) - 0.2)
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel("share of runs predicted right, each group from the others")
    return ax


def plot_reliability(answer: OutcomeDiagnosis, *, width: float = WIDE, palette: Palette = PAPER) -> Axes:
    """Share that overturned against the chance predicted, in five ranges of the chance."""
    (ax,) = new_panels([3.0], width, palette)
    ax.plot([0, 1], [0, 1], color=palette.faint, linewidth=1.0)
    for one, shift in ((answer.predictor("base model"), -0.006), (answer.predictor("extended model"), 0.006)):
        colour = palette.accent if one.by.startswith("extended") else palette.before
        for k, part in enumerate(one.reliability):
            x = part.chance + shift
            ax.plot([x, x], [part.low95, part.high95], color=colour, linewidth=1.5)
            ax.plot(x, part.share, "o", color=colour, label=one.by if k == 0 else None)
    ax.set_xlim(-0.03, 1.03)
    ax.set_ylim(-0.03, 1.03)
    ax.set_xlabel("chance predicted, each group from the others")
    ax.set_ylabel("share that overturned")
    legend(ax, palette)
    return ax


def _name(one: Compared) -> str:
    return one.by if "model" in one.by else f"{one.by} threshold"
