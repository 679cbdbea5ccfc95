"""How large a residual is, in steps that can be distinguished: deeper accent, larger misfit."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path
from numpy.typing import ArrayLike, NDArray

from diagnosis.report.figures.palette import Palette
from diagnosis.report.figures.panels import FONT

BORDERS = (1.25, 2.0, 4.0, 8.0, 16.0)
"""Times the noise: a window of white noise alone, of a hundred samples, stays under the first."""
WORDS = ("at the noise", "up to 2", "up to 4", "up to 8", "up to 16", "over 16 times the noise")
DEPTHS = (0.10, 0.25, 0.42, 0.60, 0.80, 1.0)
"""Opacity of the accent."""


def level_of(over_noise: ArrayLike) -> NDArray[np.int64]:
    """The step (0..5) of residuals given in multiples of the noise."""
    return np.searchsorted(np.asarray(BORDERS), np.asarray(over_noise), side="right").astype(np.int64)


def draw_cells(
    ax: Axes,
    left: ArrayLike,
    bottom: ArrayLike,
    width: ArrayLike,
    height: ArrayLike,
    over_noise: NDArray[np.float64],
    palette: Palette,
) -> None:
    """Rectangles ``(n,)``, each as deep as its residual ``over_noise`` (n,)."""
    x, y, w, h = (np.broadcast_to(np.asarray(v, float), over_noise.shape) for v in (left, bottom, width, height))
    levels = level_of(over_noise)
    corners = np.stack(
        [np.stack([x, y], -1), np.stack([x + w, y], -1), np.stack([x + w, y + h], -1), np.stack([x, y + h], -1),
         np.stack([x, y], -1)], axis=1,
    )  # fmt: skip
    codes = np.array([Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY], dtype=Path.code_type)
    for level, depth in enumerate(DEPTHS):
        chosen = corners[levels == level]
        if chosen.size:
            outline = Path(chosen.reshape(-1, 2), np.tile(codes, len(chosen)))
            ax.add_patch(PathPatch(outline, facecolor=palette.accent, alpha=depth, linewidth=0.0))


def explain_levels(figure: Figure, palette: Palette, *, columns: int) -> None:
    """The key to the steps, below the panels."""
    handles = [
        Patch(facecolor=palette.accent, alpha=depth, linewidth=0.0, label=word)
        for depth, word in zip(DEPTHS, WORDS, strict=True)
    ]
    figure.legend(
        handles=handles, loc="outside lower left", ncols=columns, frameon=False, fontsize=FONT - 1,
        labelcolor=palette.ink, handlelength=1.1, columnspacing=1.2, handletextpad=0.5,
    )  # fmt: skip
