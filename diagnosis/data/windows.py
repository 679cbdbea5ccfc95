"""Cutting a recording in windows that can be explained one by one (multiple shooting).

A rocking body forgets nothing: neighbouring trajectories from rest part quickly, but over two or
three impacts they stay together. A window starts at a peak of the leading channel above the noise,
where the state is best known, and lasts a little under a second; stretches under the noise are left out.
A system that is not chaotic is one window.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnosis.data.noise import smooth
from grids.recordings.base import FloatArray

ABOVE_NOISE = 8.0
QUIET = 5.0
"""Levels over the noise: of a peak that may start a window, and under which motion counts as quiet."""
SHORTEST, AIM, LONGEST = 0.3, 0.6, 0.85
"""s."""
QUIET_FOR = 0.35
"""s under the quiet level that end a window."""
SMOOTHING = 0.05
"""s."""


@dataclass(frozen=True)
class Window:
    """Samples ``first`` to ``first + samples - 1`` of one recording."""

    recording: int
    first: int
    samples: int


def rest_level(smoothed: FloatArray, sigma: float, time_step: float) -> float:
    """What the sensor reads while nothing moves: not zero when its own zero is off; 0 if it always moves."""
    from scipy.ndimage import maximum_filter1d, minimum_filter1d

    reach = max(1, round(QUIET_FOR / time_step))
    range_ = maximum_filter1d(smoothed, reach) - minimum_filter1d(smoothed, reach)
    still = range_ < QUIET * sigma
    return float(np.median(smoothed[still])) if still.sum() > reach else 0.0


def cut(values: FloatArray, sigma: float, time_step: float, recording: int) -> list[Window]:
    """Windows of one recording by its leading channel (n_times,), disjoint and in order."""
    from scipy.ndimage import maximum_filter1d
    from scipy.signal import find_peaks

    smoothed = smooth(values, time_step, SMOOTHING)
    size = np.abs(smoothed - rest_level(smoothed, sigma, time_step))
    peaks = np.asarray(find_peaks(size, height=ABOVE_NOISE * sigma, prominence=QUIET * sigma)[0], np.int64)
    reach = max(1, round(QUIET_FOR / time_step))
    quiet = maximum_filter1d(size, reach) < QUIET * sigma
    found: list[Window] = []
    free = 0
    for peak in peaks.tolist():
        if peak < free:
            continue
        limit = min(peak + int(LONGEST / time_step), values.size)
        quiets = np.flatnonzero(quiet[peak:limit])
        if quiets.size:
            limit = peak + int(quiets[0])
        nexts = peaks[(peaks >= peak + AIM / time_step) & (peaks < limit)]
        end = int(nexts[0]) if nexts.size else limit
        if end - peak >= SHORTEST / time_step:
            found.append(Window(recording, int(peak), end - int(peak)))
            free = end
    return found
