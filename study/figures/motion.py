"""A ground motion over time with its response spectrum."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from grids.motions import Motion
from grids.motions.artificial import TOLERANCE, target_of
from grids.motions.matching import MATCHED
from grids.motions.spectrum import default_periods, response_spectrum
from study.figures.style import COLOURS, literal
from study.wording import GRAVITY

DAMPING = 0.05


def plot_motion(motion: Motion) -> tuple[Axes, ...]:
    """Draw the components of a motion over time (g) and below them their pseudo-acceleration spectra.

    The spectrum an artificial motion was made for is drawn with the band it is promised to lie in. Returns the
    Axes, the last one being the spectrum's (5 % damping, or the artificial motion's own).
    """
    components = [(motion.components.get("horizontal", "horizontal"), motion.horizontal, COLOURS[0])]
    if motion.vertical is not None:
        components.append((motion.components.get("vertical", "vertical"), motion.vertical, COLOURS[1]))
    n = len(components)
    figure = plt.figure(figsize=(8.0, 1.7 * n + 3.0), layout="constrained")
    axes = figure.subplots(n + 1, 1, height_ratios=[*[1.0] * n, 1.6])
    largest = max(float(np.max(np.abs(values))) for _, values, _ in components) / GRAVITY
    periods = default_periods()
    target = target_of(motion)
    damping = DAMPING if target is None else target.damping
    if target is not None:
        matched = np.geomspace(*MATCHED, 200)
        wanted = target(matched) / GRAVITY
        axes[n].fill_between(
            matched, (1 - TOLERANCE) * wanted, (1 + TOLERANCE) * wanted, color="0.85", label=f"± {TOLERANCE:.0%}"
        )
        axes[n].loglog(matched, wanted, "--", color=COLOURS[6], linewidth=1.0, label="Eurocode 8")
    for ax, (name, values, colour) in zip(axes, components, strict=False):
        ax.plot(motion.time, values / GRAVITY, color=colour, linewidth=0.7)
        peak = int(np.argmax(np.abs(values)))
        ax.plot(motion.time[peak], values[peak] / GRAVITY, "o", color=COLOURS[6], markersize=4)
        ax.set_title(f"{literal(name)}: peak {abs(values[peak]) / GRAVITY:.3f} g", fontsize="medium", loc="left")
        ax.set_ylim(-1.1 * largest, 1.1 * largest)
        ax.set_xlim(0.0, motion.duration)
        ax.set_ylabel("acceleration [g]")
        ax.grid(alpha=0.3)
        spectrum = response_spectrum(values, motion.time_step, periods, damping)
        axes[n].loglog(periods, spectrum.pseudo_acceleration / GRAVITY, color=colour, label=literal(name))
    axes[n - 1].set_xlabel("time [s]")
    axes[n].set_xlabel("period [s]")
    axes[n].set_ylabel("pseudo-acceleration [g]")
    axes[n].grid(alpha=0.3, which="both")
    axes[n].legend(title=f"{damping:.0%} damping")
    figure.suptitle(motion.name)
    return tuple(axes)
