"""Samples that are compared: means over about 10 ms.

What mechanisms leave in a recording lies below some tens of hertz. Averages keep it and the errors' density there,
however fast the logger was, so that neither evidence nor cost grows with the sampling rate alone.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray

RATE = 100.0
"""Hz, least rate of the averages of a recording sampled faster."""


def stride(time_step: float) -> int:
    """Samples in one average."""
    return max(1, int(1.0 / (RATE * time_step) + 1e-6))


def averaged(values: FloatArray, strides: NDArray[np.int64]) -> FloatArray:
    """Means (..., W, C, n) of ``strides`` (W,) successive samples (..., W, C, N); 0 beyond the last whole one."""
    sizes = np.unique(strides).tolist()
    if len(sizes) == 1:
        return _means(values, sizes[0])
    found = np.zeros((*values.shape[:-1], values.shape[-1] // sizes[0]))
    for size in sizes:
        own = np.flatnonzero(strides == size)
        means = _means(values[..., own, :, :], size)
        found[..., own, :, : means.shape[-1]] = means
    return found


def _means(values: FloatArray, size: int) -> FloatArray:
    """Of ``size`` successive samples (..., N)."""
    if size == 1:
        return values
    last = values.shape[-1] // size * size
    total = values[..., :last:size].copy()
    for k in range(1, size):  # many times as fast as means over a short last axis
        total += values[..., k:last:size]
    total /= size
    return total
