"""The force that no mechanism of the library gives, over the rotation."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from diagnosis.report.figures.palette import PAPER, Palette
from diagnosis.report.figures.panels import WIDE, in_milli, new_panels


def plot_missing_force(force: Mapping[str, Any], *, width: float = WIDE, palette: Palette = PAPER) -> Axes:
    """Draw the ``curve`` of a missing force: at zero velocity, as an equivalent base acceleration."""
    (ax,) = new_panels([2.8], width, palette, below=0.5)
    rotation, unit = in_milli(np.asarray(force["curve"]["rotation"], float), "rad")
    ax.axhline(0.0, color=palette.faint, linewidth=1.0, zorder=0)
    ax.axvline(0.0, color=palette.faint, linewidth=1.0, zorder=0)
    ax.plot(rotation, force["curve"]["force"], color=palette.accent, linewidth=1.8)
    ax.set_xlabel(f"rotation [{unit}]")
    ax.set_ylabel(f"force [{in_milli(rotation, force['unit'])[1]}]")
    return ax
