"""In which phase of the motion the models miss: the residual over rotation and angular velocity."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from diagnosis.answer.result import Trace, Windows
from diagnosis.report.figures.levels import draw_cells, explain_levels
from diagnosis.report.figures.palette import PAPER, Palette
from diagnosis.report.figures.panels import WIDE, figure_of, is_narrow, name_panel, new_panels

CELLS = (25, 19)
"""Across rotation and angular velocity."""
FEWEST = 3
"""Fewest samples of a cell that is drawn."""


def noise_of_trace(trace: Trace, windows: Sequence[Windows]) -> float:
    """The noise of a channel (in its unit), from the window residuals, which are given over it; nan
    where no window tells.
    """
    found = []
    for strip in windows:
        if (strip.recording, strip.channel) != (trace.recording, trace.channel):
            continue
        for start, end, over_noise in zip(strip.start, strip.end, strip.before, strict=True):
            inside = (trace.time >= start) & (trace.time < end)
            residual = (trace.measured - trace.before)[inside]
            residual = residual[np.isfinite(residual)]
            if residual.size and over_noise > 0.0:
                found.append(float(np.sqrt(np.mean(residual**2))) / float(over_noise))
    return float(np.median(found)) if found else float("nan")


def plot_phase_plane(
    traces: Sequence[Trace],
    windows: Sequence[Windows],
    *,
    channel: str,
    width: float = WIDE,
    palette: Palette = PAPER,
) -> tuple[Axes, Axes]:
    """Draw the rms residual over the noise in the plane of ``channel`` and its rate, before and after.

    All recordings together. The angular velocity is the difference quotient of the extended model's
    prediction, which is smooth where the measurement is not.
    """
    state, rate, before, after = _samples(
        [(trace, noise_of_trace(trace, windows)) for trace in traces if trace.channel == channel]
    )
    if is_narrow(width):
        panels = new_panels([3.4, 3.4], width, palette, sharex=True, below=1.2)
    else:
        panels = new_panels([3.8], width, palette, columns=2, below=0.8)
    reach = 1.05 * float(np.max(np.abs(state), initial=1e-6)), 1.05 * float(np.max(np.abs(rate), initial=1e-6))
    for ax, residual, name in zip(panels, (before, after), ("before", "after"), strict=True):
        _draw_cells(ax, state, rate, residual, reach, palette)
        name_panel(ax, name, palette)
        ax.set_ylabel("angular velocity [rad s⁻¹]")
    for ax in panels if not is_narrow(width) else panels[1:]:
        ax.set_xlabel(f"{channel.replace('_', ' ')} [mrad]")
    explain_levels(figure_of(panels[-1]), palette, columns=3 if is_narrow(width) else 6)
    return panels[0], panels[1]


def _samples(pairs: Sequence[tuple[Trace, float]]) -> tuple[NDArray[np.float64], ...]:
    """State (mrad), rate (rad s-1), residuals over the noise before and after, of all samples."""
    columns: list[NDArray[np.float64]] = []
    for trace, noise in pairs:
        step = float(trace.time[1] - trace.time[0])
        rate = np.gradient(trace.after, step)
        rows = np.stack(
            [
                1e3 * trace.after,
                rate,
                (trace.measured - trace.before) / noise,
                (trace.measured - trace.after) / noise,
            ]
        )
        columns.append(rows[:, np.isfinite(rows).all(axis=0)])
    return tuple(np.concatenate(columns, axis=1)) if columns else tuple(np.zeros((4, 0)))


def _draw_cells(
    ax: Axes,
    state: NDArray[np.float64],
    rate: NDArray[np.float64],
    residual: NDArray[np.float64],
    reach: tuple[float, float],
    palette: Palette,
) -> None:
    limits = [(-reach[0], reach[0]), (-reach[1], reach[1])]
    count, across, up = np.histogram2d(state, rate, bins=CELLS, range=limits)
    squares = np.histogram2d(state, rate, bins=CELLS, range=limits, weights=residual**2)[0]
    filled = count >= FEWEST
    ax.axhline(0.0, color=palette.faint, linewidth=1.0, zorder=0)
    ax.axvline(0.0, color=palette.faint, linewidth=1.0, zorder=0)
    j, k = np.nonzero(filled)
    draw_cells(
        ax, across[j], up[k], across[1] - across[0], up[1] - up[0], np.sqrt(squares[j, k] / count[j, k]), palette
    )
    ax.set_xlim(*limits[0])
    ax.set_ylim(*limits[1])
