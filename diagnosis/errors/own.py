"""What a model that runs through whole recordings gets wrong by itself: in proportion to the motion.

No model of a building reproduces a recording down to its sensors' noise over minutes. If that went unsaid, everything
that bends a prediction a little would be evidence. So the error of the model is a part of the errors, estimated with
them: random functions in each stretch, in proportion to the motion of its recording, the same at all levels, for they
move together. An effect counts when it explains more than such functions would.

A stiffness or a damping that is a little wrong leaves an oscillation at the building's own frequency that goes on for
periods: few independent numbers, however many samples it spans. Such a function is correlated as the motion itself is,

    E[e(t) e(t + lag)] = theta sum_s x(s) x(s + lag) / sum_s x(s)^2,

and beside it stand smooth ones, exp(-lag^2/(2 scale^2)), for what is wrong within a cycle.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from scipy.linalg import toeplitz

from diagnosis.data.measured import Measured
from grids.recordings.levels import stem
from models.base import FloatArray

AS_MOTION = 0.0
"""Scale of the function that is correlated as the motion."""
KEPT = 1e-4
"""Share of the largest variance under which a direction of the random function is left out."""


def own_error(measured: Measured, scale: float) -> FloatArray:
    """Columns (W, C, n, K) in the channels' units; ``scale`` in s of a Gaussian kernel, or `AS_MOTION`.

    At a variance of one the function has the deviation of the unit in a recording in which the motion has the channel's
    rms over all recordings. Every quantity has a function of its own.
    """
    m = measured
    n, every = m.values.shape[2], range(len(m.recordings))
    whole = np.array([_rms(m, c, every) for c in range(len(m.channels))])
    each = np.array([[_rms(m, c, [r]) for c in range(len(m.channels))] for r in every])
    quantities = list(dict.fromkeys(stem(c) for c in m.channels))
    of_quantity = [quantities.index(stem(c)) for c in m.channels]
    roots = [[_root(_correlation(m, r, of_quantity.index(q), scale, n)) for q in range(len(quantities))] for r in every]
    most = max(root.shape[1] for of_recording in roots for root in of_recording)
    found = np.zeros((*m.values.shape, len(quantities) * most))
    for w, r in enumerate(m.recording_of):
        for c, q in enumerate(of_quantity):
            root = roots[r][q]
            found[w, c, :, q * most : q * most + root.shape[1]] = each[r, c] / whole[c] * root
    return np.asarray(found * m.mask[..., None] * m.unit[:, None, None])


def _correlation(measured: Measured, recording: int, channel: int, scale: float, count: int) -> FloatArray:
    """Of the function at lags of 0 to ``count`` - 1 means."""
    if scale != AS_MOTION:
        return np.asarray(np.exp(-0.5 * (measured.recordings[recording].time_step * np.arange(count) / scale) ** 2))
    x = measured.recordings[recording].channels[measured.channels[channel]]
    spectrum = np.abs(np.fft.rfft(x, 2 * x.size)) ** 2  # padded, so that what wraps around is zero
    found = np.fft.irfft(spectrum)[: min(count, x.size)]
    return np.asarray(np.pad(found, (0, count - found.size)) / max(found[0], 1e-300))


def _root(correlation: FloatArray) -> FloatArray:
    """R (n, k) with R R' the matrix of the correlations, small directions left out."""
    values, vectors = np.linalg.eigh(toeplitz(correlation))
    kept = values > KEPT * values[-1]
    return np.asarray(vectors[:, kept] * np.sqrt(values[kept]))


def _rms(measured: Measured, channel: int, recordings: Iterable[int]) -> float:
    """Of a channel over some recordings."""
    name = measured.channels[channel]
    values = np.concatenate([measured.recordings[r].channels[name] for r in recordings])
    return max(float(np.sqrt(np.mean(values**2))), 1e-300)
