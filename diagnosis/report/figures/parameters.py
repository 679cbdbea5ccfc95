"""Parameters with their 95 % intervals, against what the laboratory stated."""

from __future__ import annotations

from collections.abc import Mapping

from matplotlib.axes import Axes

from diagnosis.fit.intervals import Estimate
from diagnosis.report.figures.palette import PAPER, Palette
from diagnosis.report.figures.panels import WIDE, legend, new_panels

SIGMAS = 1.959964
"""Half the width of a 95 % interval of a normal distribution, in standard deviations."""


def plot_parameters(
    base: Mapping[str, Estimate],
    nominal: Mapping[str, float],
    tolerance: Mapping[str, float],
    *,
    width: float = WIDE,
    palette: Palette = PAPER,
) -> Axes:
    """Draw each fitted parameter in % from its nominal value; the bar is the stated tolerance.

    Only parameters with a nominal value other than 0; ``tolerance`` is relative, one sigma.
    """
    names = [name for name in base if nominal.get(name)]
    (ax,) = new_panels([0.42 * max(len(names), 1) + 1.0], width, palette)
    for y, name in enumerate(reversed(names)):
        fitted, stated = base[name], nominal[name]
        low, mid, high = (100 * (v / stated - 1.0) for v in (fitted.low95, fitted.estimate, fitted.high95))
        if name in tolerance:
            half = 100 * SIGMAS * tolerance[name]
            ax.barh(y, 2 * half, left=-half, height=0.62, color=palette.band, zorder=0)
        ax.plot([low, high], [y, y], color=palette.accent, linewidth=2.0, zorder=2)
        ax.plot(mid, y, "o", color=palette.accent, markersize=8, zorder=3)
    ax.axvline(0.0, color=palette.before, linewidth=1.0, zorder=1)
    ax.plot([], [], "o-", color=palette.accent, linewidth=2.0, label="fitted, 95 %")
    ax.barh(0.0, 0.0, color=palette.band, label="stated, 95 %")
    legend(ax, palette)
    ax.set_yticks(range(len(names)), [name.replace("_", " ") for name in reversed(names)])
    ax.set_ylim(-0.7, len(names) - 0.3)
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel("difference from the nominal value [%]")
    return ax
