"""Where a line in the means of samples stands in the recordings themselves.

Means of q samples are taken at a rate f_m: a line of frequency F leaves one at |F - k f_m| of sin(pi F q dt) over
q sin(pi F dt) times its amplitude. Which of those it is shows in the samples.
"""

from __future__ import annotations

import numpy as np

from diagnosis.data.averaging import stride
from diagnosis.data.measured import Measured
from grids.recordings.lines import amplitude
from models.base import FloatArray

BESIDE = (2.5, 4.5, 6.5, 8.5)
"""Frequencies on either side that a line is held against, in 1/T of the recording."""


def in_the_samples(measured: Measured, channel: str, frequency: float) -> tuple[float, float]:
    """Frequency (Hz) of the line that makes one at ``frequency`` in the means, and what the means leave of it."""
    fastest = min(measured.recordings, key=lambda one: one.time_step)
    step, q = fastest.time_step, stride(fastest.time_step)
    if q == 1:
        return frequency, 1.0
    rate = 1.0 / (q * step)
    around = [k * rate + sign * frequency for k in range(q) for sign in (1.0, -1.0)]
    may_be = np.unique([f for f in around if 0.0 < f <= 0.5 / step])
    samples = fastest.channels[channel]
    clear = [_over_beside(samples, float(f) * step) for f in may_be]
    true = float(may_be[int(np.argmax(clear))])
    return true, float(abs(np.sin(np.pi * true * q * step) / (q * np.sin(np.pi * true * step))))


def _over_beside(samples: FloatArray, frequency: float) -> float:
    """Amplitude at a frequency (cycles a sample) over the median of those beside it."""
    beside = [frequency + sign * b / samples.size for b in BESIDE for sign in (1.0, -1.0)]
    return amplitude(samples, frequency) / max(float(np.median([amplitude(samples, f) for f in beside])), 1e-300)
