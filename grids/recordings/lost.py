"""Samples that hold no measurement: spikes, and what a logger held. They are bridged and not compared.

A bridge serves to read off rates and starts; it is no measurement. Channels by level are not looked at.
"""

from __future__ import annotations

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
    channels, lost, notes = dict(recording.channels), dict(recording.lost), []
    for name in recording.responses:
        if recording.channel(name).unit not in UNITS or channels[name].ndim > 1:
            continue
        held = stuck(channels[name])
        whole = _between(channels[name], held)
        alone = np.setdiff1d(spikes(whole), held)
        if not held.size and not alone.size:
            continue
        channels[name], lost[name] = bridged(whole, alone), np.union1d(held, alone)
        channels[name].flags.writeable = False
        for at, said in ((alone, "stand alone"), (held, "repeat the one before")):
            if at.size:
                where = ", ".join(f"{t:.4g} s" for t in recording.time[at[:SHOWN]])
                more = " ..." if at.size > SHOWN else ""
                notes.append(f"{at.size} sample(s) of {name} {said} ({where}{more}): they are lost and not compared")
    return replace(recording, channels=channels, lost=lost, notes=(*recording.notes, *notes)) if notes else recording


def _between(values: FloatArray, at: NDArray[np.intp]) -> FloatArray:
    """The samples with those ``at`` on straight lines between the others."""
    kept = np.setdiff1d(np.arange(values.size), at)
    return np.asarray(np.interp(np.arange(values.size), kept, values[kept])) if at.size else values
