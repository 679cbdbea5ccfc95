"""The motion of the base as lane kernels read it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray
from models.errors import InputError
from models.lanes.arrays import Record
from models.lanes.chunks import CHUNK, extremes
from models.pitch import pitch
from models.shaking import Shaking, Shakings

LONGEST_KEPT = 50_000
"""Steps of a record, 2 MB, up to which it is kept for the next call."""
MOST_STEPS = 20_000_000
"""Of one run: a day at 5 ms; a motion of that length takes a GB."""


def recorded(shaking: Shaking, per_sample: int, tail: float, more: Sequence[FloatArray | None] = ()) -> Record:
    """The shaking at ``per_sample`` steps a sample, then ``tail`` s of rest.

    Channels: a, a_z and ``more`` (each at the samples of the shaking; None: zero).
    """
    step = shaking.time_step / per_sample
    channels = [shaking.horizontal, shaking.vertical, *more]
    shaken = (shaking.horizontal.size - 1) * per_sample
    end = shaken + int(np.ceil(tail / step - 1e-9))
    if end > MOST_STEPS:
        raise InputError(
            f"the run takes {end:.3g} steps of {step:.3g} s ({end * step:.3g} s), more than {MOST_STEPS:.0e}: "
            "shorten the motion or its tail, or stretch time less"
        )
    samples = np.zeros((len(channels) + 1, -(-(end + 2) // CHUNK) * CHUNK))  # full chunks: records join end to end
    samples[-1, :shaken] = 1.0
    fine = np.arange(shaken + 1) / per_sample
    for row, channel in enumerate(channels):
        if channel is not None:
            samples[row, : shaken + 1] = np.interp(fine, np.arange(channel.size), channel)
    return Record(samples, extremes(samples[:-1]), step, shaken, end)


def pitched(shaking: Shaking, per_sample: int, tail: float, low_pass: float) -> Record:
    """The same with psi and psi'' of a table that follows the shaking up to ``low_pass`` Hz (0: it does not pitch)."""

    def make() -> Record:
        return recorded(shaking, per_sample, tail, pitch(shaking, low_pass) if low_pass > 0.0 else (None, None))

    short = per_sample * shaking.horizontal.size < LONGEST_KEPT
    return shaking.once((__name__, per_sample, tail, low_pass), make) if short else make()


def of_lanes(shakings: Shakings, make: Callable[[Shaking], Record]) -> tuple[Record, NDArray[np.int64]]:
    """The records that ``make`` gives of the motions of n lanes, as one, and the step where that of a lane begins (n,).

    A lane stays within its own.
    """
    if len(shakings.each) == 1:
        return make(shakings.first), np.zeros(shakings.of.size, np.int64)
    record, begins = _end_to_end([make(shaking) for shaking in shakings.each])
    return record, begins[shakings.of]


def _end_to_end(records: Sequence[Record]) -> tuple[Record, NDArray[np.int64]]:
    """Records of one step after one another, for lanes of which each stays within its own; where each begins."""
    samples = np.concatenate([record.samples for record in records], axis=1)
    begins = np.cumsum([0, *(record.samples.shape[1] for record in records[:-1])])
    last = records[-1]
    largest = np.concatenate([record.extremes for record in records], axis=1)
    joined = Record(samples, largest, last.step, int(begins[-1]) + last.shaken, int(begins[-1]) + last.end)
    return joined, begins.astype(np.int64)
