"""Which predictions extrapolate: recordings held out with larger motion than any that was learned from."""

from __future__ import annotations

import numpy as np

from diagnosis.answer.heldout import Shown, channel_misfit
from diagnosis.answer.result import Extrapolated
from diagnosis.search.left_out import BEYOND


def extrapolated(learned: Shown, held: Shown) -> tuple[Extrapolated, ...]:
    """By the leading channel, also where it only follows from others.

    With the misfit of the final model there.
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
        if peak <= BEYOND * largest or r not in m.recording_of:
            continue
        after = channel_misfit(m, held.after, r, m.lead)
        if np.isnan(after):  # no sample of it is compared
            continue
        found.append(Extrapolated(recording.name, name, learned.measured.unit_of(name), peak, largest, after))
    return tuple(found)
