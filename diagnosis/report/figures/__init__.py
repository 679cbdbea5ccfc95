"""Figures of a diagnosis: functions that take its parts, draw, and return Axes; none calls show()."""

from __future__ import annotations

from diagnosis.report.figures.before_after import plot_before_after, plot_worst_window
from diagnosis.report.figures.errors import plot_errors
from diagnosis.report.figures.fits import plot_fits
from diagnosis.report.figures.missing_force import plot_missing_force, plot_visited
from diagnosis.report.figures.parameters import plot_parameters
from diagnosis.report.figures.phase_plane import plot_phase_plane
from diagnosis.report.figures.raster import plot_raster
from diagnosis.report.figures.recording import plot_recording
from diagnosis.report.figures.suspects import plot_suspects

__all__ = [
    "plot_before_after",
    "plot_errors",
    "plot_fits",
    "plot_missing_force",
    "plot_parameters",
    "plot_phase_plane",
    "plot_raster",
    "plot_recording",
    "plot_suspects",
    "plot_visited",
    "plot_worst_window",
]
