"""Cutting a recording in windows that can be explained one by one (multiple shooting).

Where motion is chaotic neighbouring trajectories from rest part quickly, but for a while they stay together. A
window starts at a peak of a leading channel above the noise, where the state is best known, and lasts as long as
the model declares (`models.identification.WindowLengths`); stretches under the noise are left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnosis.data.smoothing import smooth
from grids.recordings.base import FloatArray
from models.identification import WindowLengths

ABOVE_NOISE = 8.0
QUIET = 5.0
"""Levels over the noise: of a peak that may start a window, and under which motion counts as quiet."""


@dataclass(frozen=True)
class Window:
    """Samples ``first`` to ``first + samples - 1`` of one recording."""

    recording: int
    first: int
    samples: int


def rest_level(smoothed: FloatArray, sigma: float, time_step: float, quiet: float) -> float:
    """What the sensor reads while nothing moves for ``quiet`` s: its zero, which may be off; 0 if it always moves."""
    from scipy.ndimage import maximum_filter1d, minimum_filter1d

    reach = max(1, round(quiet / time_step))
    range_ = maximum_filter1d(smoothed, reach) - minimum_filter1d(smoothed, reach)
    still = range_ < QUIET * sigma
    return float(np.median(smoothed[still])) if still.sum() > reach else 0.0


def over_noise(values: FloatArray, sigma: float, time_step: float, lengths: WindowLengths) -> FloatArray:
    """Size of a channel's motion (n_times,) about its level at rest, over its noise ``sigma``."""
    smoothed = smooth(values, time_step, lengths.smoothing)
    return np.abs(smoothed - rest_level(smoothed, sigma, time_step, lengths.quiet)) / sigma


def cut(size: FloatArray, time_step: float, recording: int, lengths: WindowLengths) -> list[Window]:
    """Windows of one recording, disjoint and in order, by the ``size`` of its motion over the noise (n_times,)."""
    from scipy.ndimage import maximum_filter1d
    from scipy.signal import find_peaks

    peaks = np.asarray(find_peaks(size, height=ABOVE_NOISE, prominence=QUIET)[0], np.int64)
    quiet = maximum_filter1d(size, max(1, round(lengths.quiet / time_step))) < QUIET
    found: list[Window] = []
    free = 0
    for peak in peaks.tolist():
        if peak < free:
            continue
        limit = min(peak + int(lengths.longest / time_step), size.size)
        quiets = np.flatnonzero(quiet[peak:limit])
        if quiets.size:
            limit = peak + int(quiets[0])
        nexts = peaks[(peaks >= peak + lengths.aim / time_step) & (peaks < limit)]
        end = int(nexts[0]) if nexts.size else limit
        if end - peak >= lengths.shortest / time_step:
            found.append(Window(recording, int(peak), end - int(peak)))
            free = end
    return found
