"""The noise of the channels that a fit weighs its residuals with.

Responses: the local-polynomial level of `grids.recordings.noise`. Base: earthquakes are not smooth
over nine samples everywhere, so the level is that of the record's quietest tenth; it acts on the
model as a disturbance (see `diagnosis.whitening`), not as a residual.
"""

from __future__ import annotations

import numpy as np

from grids.recordings.base import REQUIRED, FloatArray, Recording
from grids.recordings.noise import noise_of

BLOCK = 40
QUIET_SHARE = 0.1
RELATIVE_FLOOR = 1e-4
"""Of the channel's peak: the least noise assumed, for computed channels."""


def response_noise(recording: Recording, channel: str) -> float:
    """Standard deviation of a response channel's noise, in its unit."""
    values = recording.channels[channel]
    return max(noise_of(values).sigma, RELATIVE_FLOOR * float(np.max(np.abs(values))))


def base_noise(recording: Recording) -> float:
    """Standard deviation (m s-2) of the noise of the horizontal base acceleration."""
    values = recording.channels[REQUIRED]
    blocks = max(values.size // BLOCK, 1)
    levels = [noise_of(part).sigma for part in np.array_split(values, blocks)]
    return float(np.quantile(levels, QUIET_SHARE)) if np.any(values) else 0.0


def smooth(values: FloatArray, time_step: float, width: float) -> FloatArray:
    """Local cubic over ``width`` seconds, at least 7 samples."""
    from scipy.signal import savgol_filter

    count = min(max(7, round(width / time_step) | 1), (values.size - 1) | 1)
    return np.asarray(savgol_filter(values, count, 3))
