"""The figures of a report, by name: for the page and as files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

import models
from diagnosis.answer.result import Diagnosis
from diagnosis.data.measured import identification_of
from diagnosis.report.figures import (
    plot_before_after,
    plot_errors,
    plot_fits,
    plot_missing_force,
    plot_parameters,
    plot_phase_plane,
    plot_raster,
    plot_recording,
    plot_suspects,
    plot_visited,
    plot_worst_window,
)
from diagnosis.report.svg import Draw, Picture, picture
from grids.recordings import Recording
from grids.specimen import Specimen
from study.store import write_text

OURS = "<!-- drawn by rocking diagnose -->\n"
"""Ends every figure written, so that a figure drawn earlier is known from a user's own."""


def drawings(diagnosis: Diagnosis, specimen: Specimen, recordings: Sequence[Recording]) -> dict[str, Draw]:
    """What can be drawn of this diagnosis: functions that take ``width`` (inches) and ``palette``, by name."""
    found: dict[str, Draw] = {}
    for recording in recordings:
        found[f"read_{recording.name}"] = partial(plot_recording, recording)
    if diagnosis.windows:
        found["raster"] = partial(plot_raster, diagnosis.windows, diagnosis.shows)
    lead = identification_of(models.get(specimen.model)).leads[0].channel
    if any(trace.channel == lead for trace in diagnosis.traces):
        found["phase_plane"] = partial(plot_phase_plane, diagnosis.traces, diagnosis.windows, channel=lead)
    if diagnosis.screen:
        evidence = {effect.name: effect.evidence for effect in diagnosis.effects}
        near = [rival.name for rival in diagnosis.rivals]
        found["suspects"] = partial(
            plot_suspects, diagnosis.screen, diagnosis.null_band, evidence=evidence, rivals=near
        )
    for channel in diagnosis.errors.channels if diagnosis.errors else ():
        found[f"errors_{channel.channel}"] = partial(plot_errors, channel)
    found["fits"] = partial(plot_fits, diagnosis.train, diagnosis.holdout)
    for trace in diagnosis.traces:
        found[f"fit_{trace.recording}_{trace.channel}"] = partial(plot_before_after, trace)
    if diagnosis.windows and diagnosis.traces:
        found["worst_window"] = partial(plot_worst_window, diagnosis.traces, diagnosis.windows)
    if diagnosis.missing_force and diagnosis.missing_force["terms"]:
        found["missing_force"] = partial(plot_missing_force, diagnosis.missing_force)
    for law in diagnosis.visited:
        found[f"law_{law.effect}"] = partial(plot_visited, law)
    if any(specimen.parameters.get(name) for name in diagnosis.base):
        found["parameters"] = partial(plot_parameters, diagnosis.base, specimen.nominal, specimen.tolerance)
    return found


def pictures(diagnosis: Diagnosis, specimen: Specimen, recordings: Sequence[Recording]) -> dict[str, Picture]:
    """Every drawing, by name."""
    return {name: picture(draw, name) for name, draw in drawings(diagnosis, specimen, recordings).items()}


def write_figures(drawn: Mapping[str, Picture], folder: Path) -> None:
    """Every drawing as SVG, for a paper or a slide; drawings of an earlier diagnosis in the folder go."""
    for old in folder.glob("*.svg"):
        if old.stem not in drawn and old.read_text("utf-8", errors="replace").endswith(OURS):
            old.unlink()
    for name, figure in drawn.items():
        write_text(folder / f"{name}.svg", figure.file() + OURS)
