"""Samples that hold no measurement: spikes, and what a logger held. They are bridged and not compared.

A bridge serves to read off rates and starts; it is no measurement. Of channels by level each level is looked at alone,
and lost under its own name (`grids.recordings.levels`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from grids.recordings.base import FloatArray, Recording
from grids.recordings.spikes import bridged, spikes
from grids.recordings.stuck import stuck

UNITS = ("rad", "m")
"""Of positions: velocities and accelerations have true spikes, at impacts."""
SHOWN = 3
"""Instants that a note names."""


def with_lost_samples(recording: Recording) -> Recording:
    """The recording with what is lost bridged, in `Recording.lost` and in notes; as it is where nothing is."""
    channels, lost = dict(recording.channels), dict(recording.lost)
    notes: list[str] = []
    for name in recording.responses:
        if recording.channel(name).unit not in UNITS:
            continue
        whole = np.atleast_2d(channels[name]).copy()
        by_level = channels[name].ndim > 1
        for k, values in enumerate(whole):
            held = stuck(values)
            sound = _between(values, held)
            alone = np.setdiff1d(spikes(sound), held)
            if not held.size and not alone.size:
                continue
            own = f"{name}_{recording.levels[k]}" if by_level else name
            whole[k], lost[own] = bridged(sound, alone), np.union1d(held, alone)
            notes += _notes(recording, own, alone, held)
        channels[name] = whole if by_level else whole[0]
        channels[name].flags.writeable = False
    return replace(recording, channels=channels, lost=lost, notes=(*recording.notes, *notes)) if notes else recording


def _notes(recording: Recording, name: str, alone: NDArray[np.intp], held: NDArray[np.intp]) -> Iterator[str]:
    for at, said in ((alone, "stand alone"), (held, "repeat the one before")):
        if at.size:
            where = ", ".join(f"{t:.4g} s" for t in recording.time[at[:SHOWN]])
            more = " ..." if at.size > SHOWN else ""
            yield f"{at.size} sample(s) of {name} {said} ({where}{more}): they are lost and not compared"


def _between(values: FloatArray, at: NDArray[np.intp]) -> FloatArray:
    """The samples with those ``at`` on straight lines between the others."""
    kept = np.setdiff1d(np.arange(values.size), at)
    return np.asarray(np.interp(np.arange(values.size), kept, values[kept])) if at.size else values
