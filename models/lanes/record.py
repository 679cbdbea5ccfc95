"""The motion of the base as lane kernels read it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from models.base import FloatArray
from models.lanes.chunks import extremes
from models.shaking import Shaking


@dataclass(frozen=True)
class Record:
    """Channels of the base's motion at the ends of equal steps, with a quiet tail and a step to spare.

    ``samples`` (channels + 1, m): the channels, then 1 for the steps of the shaking; ``extremes`` (channels,
    chunks): the largest size of each channel in every full chunk of `models.lanes.chunks.CHUNK` steps;
    ``step`` in s; the shaking ends at step ``shaken``, the tail at step ``end``.
    """

    samples: FloatArray
    extremes: FloatArray
    step: float
    shaken: int

    @property
    def end(self) -> int:
        return int(self.samples.shape[1]) - 2


def recorded(shaking: Shaking, per_sample: int, tail: float, more: Sequence[FloatArray | None] = ()) -> Record:
    """The shaking at ``per_sample`` steps a sample, then ``tail`` s of rest.

    Channels: a, a_z and ``more`` (each at the samples of the shaking; None: zero).
    """
    step = shaking.time_step / per_sample
    channels = [shaking.horizontal, shaking.vertical, *more]
    shaken = (shaking.horizontal.size - 1) * per_sample
    quiet = int(np.ceil(tail / step - 1e-9))
    samples = np.zeros((len(channels) + 1, shaken + quiet + 2))
    samples[-1, :shaken] = 1.0
    fine = np.arange(shaken + 1) / per_sample
    for row, channel in enumerate(channels):
        if channel is not None:
            samples[row, : shaken + 1] = np.interp(fine, np.arange(channel.size), channel)
    return Record(samples, extremes(samples[:-1]), step, shaken)
