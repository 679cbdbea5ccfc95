"""Extremes of a record in chunks, by which a lane at rest jumps over what cannot lift it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

CHUNK = 64
"""Steps of a chunk."""


def extremes(channels: NDArray[np.float64]) -> NDArray[np.float64]:
    """The largest sizes of ``(k, m)`` in its full chunks, ends included; one chunk of zeros where none is full."""
    count = channels.shape[1] // CHUNK
    size = np.abs(channels)
    found = np.zeros((channels.shape[0], max(count, 1)))
    if count:
        found[:] = size[:, : count * CHUNK].reshape(-1, count, CHUNK).max(axis=2)
        ends = size[:, CHUNK : count * CHUNK + 1 : CHUNK]
        found[:, : ends.shape[1]] = np.maximum(found[:, : ends.shape[1]], ends)
    return found
