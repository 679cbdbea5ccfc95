"""Figures: functions that take labelled data, draw, and return Axes; none of them calls show()."""

from __future__ import annotations

from study.figures.history import plot_history
from study.figures.map_figure import plot_map
from study.figures.motion import plot_motion
from study.figures.onset import plot_onset_map
from study.figures.output import plot_output_map
from study.figures.overturning import plot_overturning_map
from study.figures.save import save_figure
from study.figures.slices import plot_slices

__all__ = [
    "plot_history",
    "plot_map",
    "plot_motion",
    "plot_onset_map",
    "plot_output_map",
    "plot_overturning_map",
    "plot_slices",
    "save_figure",
]
