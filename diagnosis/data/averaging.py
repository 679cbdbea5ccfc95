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
    if np.all(strides == 1):
        return values
    samples = values.shape[-1]
    found = np.zeros((*values.shape[:-1], samples // int(strides.min())))
    for size in np.unique(strides).tolist():
        own = np.flatnonzero(strides == size)
        part = values if own.size == strides.size else values[..., own, :, :]
        n = samples // size
        total = part[..., : n * size : size].copy()
        for k in range(1, size):  # many times as fast as means over a short last axis
            total += part[..., k : n * size : size]
        found[..., own, :, :n] = total / size
    return found
