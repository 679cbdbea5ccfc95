"""Steady lines in what is left of a channel, such as the hum of the mains: found by their spectrum, taken out by fit.

The periodogram of noise, under a Hann window, scatters about its level as an exponential variable; a line of amplitude
A stands A^2 n/4 over a noise of variance sigma^2. One that stands `CLEAR` times over the median about it is fitted as
a cos 2 pi f t + b sin 2 pi f t over all samples, with the frequency at which most of it goes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from grids.recordings.base import FloatArray

FEWEST = 256
"""Samples from which on a line stands clear of its surroundings."""
CLEAR = 40.0
"""Times the median about it: of noise one frequency in 1e12 stands so high."""
AROUND, MOST = 25, 4
"""Frequencies on either side that a line is held against, and lines that are taken out."""
FINER = 20
"""Steps of frequency in one of the spectrum's."""


def without_lines(values: FloatArray, lowest: float = 0.0) -> FloatArray:
    """The samples (n,) without their steady lines from ``lowest`` (cycles a sample) on; as they are without any."""
    n = values.size
    first = max(2, int(np.ceil(lowest * n)))
    if n < FEWEST:
        return values
    found: list[float] = []
    for _ in range(MOST):
        left = values - _fitted(values, found)
        power = np.abs(np.fft.rfft(left * np.hanning(n))) ** 2
        near = np.lib.stride_tricks.sliding_window_view(np.pad(power, AROUND, mode="reflect"), 2 * AROUND + 1)
        over = power[first:-2] / np.maximum(np.median(near, axis=1)[first:-2], 1e-300)
        if over.max() < CLEAR:
            break
        peak = int(np.argmax(over)) + first
        fine = (peak + np.arange(-FINER, FINER + 1) / FINER) / n
        found.append(float(fine[int(np.argmax(np.abs(_waves(n, fine) @ (left * np.hanning(n)))))]))
    return values - _fitted(values, found) if found else values


def _fitted(values: FloatArray, frequencies: list[float]) -> FloatArray:
    """The sum of waves of these frequencies (cycles a sample) that is closest to the samples."""
    waves = _waves(values.size, np.array(frequencies, np.float64))
    columns = np.concatenate([waves.real, waves.imag]).T
    return np.asarray(columns @ np.linalg.lstsq(columns, values, rcond=None)[0]) if frequencies else 0.0 * values


def _waves(n: int, frequency: FloatArray) -> NDArray[np.complex128]:
    return np.asarray(np.exp(2j * np.pi * frequency[:, None] * np.arange(n)))
