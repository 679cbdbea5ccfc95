"""Which predictions extrapolate: recordings held out with larger motion than any that was learned from."""

from __future__ import annotations

import numpy as np

from diagnosis.answer.heldout import Shown
from diagnosis.answer.result import Extrapolated
from diagnosis.search.left_out import BEYOND


def extrapolated(learned: Shown, held: Shown) -> tuple[Extrapolated, ...]:
    """By the leading channel, also where it only follows from others.

    With the misfit of the final model there: rms error over rms of the recording.
    """
    recordings = [*learned.measured.recordings, *held.measured.recordings]
    name = learned.measured.identification.leads[0].channel
    if not all(name in r.channels for r in recordings):
        name = learned.measured.channels[learned.measured.lead]
    largest = max(float(np.max(np.abs(r.channels[name]))) for r in learned.measured.recordings)
    m, found = held.measured, []
    for r, recording in enumerate(m.recordings):
        if name not in recording.channels:  # another instrument, whose size tells nothing of that one's
            continue
        peak = float(np.max(np.abs(recording.channels[name])))
        own = np.flatnonzero(m.recording_of == r)
        if peak <= BEYOND * largest or not own.size:
            continue
        inside = m.mask[own, m.lead]
        error = (held.after - m.values)[own, m.lead][inside]
        after = float(np.sqrt(np.mean(error**2) / np.mean(m.values[own, m.lead][inside] ** 2)))
        found.append(Extrapolated(recording.name, name, learned.measured.unit_of(name), peak, largest, after))
    return tuple(found)
