"""What a model that runs through whole recordings gets wrong by itself: smooth, and in proportion to the motion.

No model of a building reproduces a recording down to its sensors' noise over minutes. If that went unsaid, everything
that bends a prediction a little would be evidence. So the error of the model is a part of the errors, estimated with
them: a smooth random function in each stretch, in proportion to the motion of its recording, the same at all levels,
for they move together. An effect counts when it explains more than such a function would.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from diagnosis.data.measured import Measured
from grids.recordings.levels import stem
from models.base import FloatArray

KEPT = 1e-4
"""Share of the largest variance under which a direction of the random function is left out."""


def own_error(measured: Measured, scale: float) -> FloatArray:
    """Columns (W, C, n, K) in the channels' units: correlation exp(-lag^2/(2 scale^2)), ``scale`` in s.

    At a variance of one the function has the deviation of the unit in a recording in which the motion has the channel's
    rms over all recordings. Every quantity has a function of its own.
    """
    m = measured
    n = m.values.shape[2]
    step = m.recordings[0].time_step
    lag = step * np.abs(np.arange(n)[:, None] - np.arange(n)[None, :])
    values, vectors = np.linalg.eigh(np.exp(-0.5 * (lag / scale) ** 2))
    kept = values > KEPT * values[-1]
    root = vectors[:, kept] * np.sqrt(values[kept])
    whole = np.array([_rms(m, c, range(len(m.recordings))) for c in range(len(m.channels))])
    each = np.array([[_rms(m, c, [r]) for c in range(len(m.channels))] for r in range(len(m.recordings))])
    size = (each / whole)[m.recording_of]
    quantities = list(dict.fromkeys(stem(c) for c in m.channels))
    found = np.zeros((*m.values.shape, len(quantities) * root.shape[1]))
    for c, name in enumerate(m.channels):
        first = quantities.index(stem(name)) * root.shape[1]
        found[:, c, :, first : first + root.shape[1]] = size[:, c, None, None] * root
    return np.asarray(found * m.mask[..., None] * m.unit[:, None, None])


def _rms(measured: Measured, channel: int, recordings: Iterable[int]) -> float:
    """Of a channel over some recordings."""
    name = measured.channels[channel]
    values = np.concatenate([measured.recordings[r].channels[name] for r in recordings])
    return max(float(np.sqrt(np.mean(values**2))), 1e-300)
