"""Figures: functions that take labelled data, draw, and return Axes; none of them calls show()."""

from __future__ import annotations

from study.figures.cloud import plot_cloud, plot_sorting
from study.figures.fragility import plot_fragility
from study.figures.history import plot_history
from study.figures.incremental import plot_incremental
from study.figures.map_figure import plot_map
from study.figures.motion import plot_motion
from study.figures.onset import plot_onset_map
from study.figures.output import plot_output_map
from study.figures.overturning import plot_overturning_map
from study.figures.save import save_figure
from study.figures.sensitivity import plot_indices, plot_interactions, plot_tornado
from study.figures.slices import plot_slices
from study.figures.spectra import plot_overturning_spectrum, plot_rocking_spectrum

__all__ = [
    "plot_cloud",
    "plot_fragility",
    "plot_history",
    "plot_incremental",
    "plot_indices",
    "plot_interactions",
    "plot_map",
    "plot_motion",
    "plot_onset_map",
    "plot_output_map",
    "plot_overturning_map",
    "plot_overturning_spectrum",
    "plot_rocking_spectrum",
    "plot_slices",
    "plot_sorting",
    "plot_tornado",
    "save_figure",
]
