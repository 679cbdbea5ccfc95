"""Where a line in the means of samples stands in the recordings themselves.

Means of q samples are taken at a rate f_m: a line of frequency F leaves one at |F - k f_m| of sin(pi F q dt) over
q sin(pi F dt) times its amplitude. Which of those it is shows in the samples.
"""

from __future__ import annotations

import numpy as np

from diagnosis.data.averaging import stride
from diagnosis.data.measured import Measured
from models.base import FloatArray

AROUND = 0.04
"""Hz within which a line of the means is known, and stands in the spectrum of the samples."""
BESIDE = 20
"""Frequencies on either side of these that it is held against."""


def in_the_samples(measured: Measured, channel: str, frequency: float) -> tuple[float, float]:
    """Frequency (Hz) of the line that makes one at ``frequency`` in the means, and what the means leave of it.

    Told by the recording in which it stands clearest: of other sampling rates a line makes other ones.
    """
    best = 0.0, frequency, 1.0
    for recording in measured.recordings:
        step, q = recording.time_step, stride(recording.time_step)
        rate, samples = 1.0 / (q * step), recording.channels[channel]
        spectrum = np.abs(np.fft.rfft(samples * np.hanning(samples.size)))
        for true in {k * rate + sign * frequency for k in range(q) for sign in (1.0, -1.0)}:
            if not 0.0 < true <= 0.5 / step + AROUND:
                continue
            left = abs(np.sin(np.pi * true * q * step) / (q * np.sin(np.pi * true * step)))
            best = max(best, (_over_beside(spectrum, true, step * samples.size), true, float(left)))
    return best[1], best[2]


def _over_beside(spectrum: FloatArray, frequency: float, duration: float) -> float:
    """Largest amplitude at a frequency (Hz) over the median of those beside it."""
    low, high = int((frequency - AROUND) * duration), int(np.ceil((frequency + AROUND) * duration)) + 1
    near = spectrum[max(low, 0) : high]
    beside = np.concatenate([spectrum[max(low - BESIDE, 0) : max(low, 0)], spectrum[high : high + BESIDE]])
    return float(near.max(initial=0.0) / max(float(np.median(beside)) if beside.size else np.inf, 1e-300))
