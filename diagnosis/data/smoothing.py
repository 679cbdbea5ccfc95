"""Local cubics through a channel: its value or slope with less noise (Savitzky and Golay, Anal. Chem. 36, 1964)."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from models.base import FloatArray

FEWEST = 7
"""Samples of a cubic."""


def smooth(values: FloatArray, time_step: float, width: float, slope: bool = False) -> FloatArray:
    """Local cubic over ``width`` seconds, at least `FEWEST` samples; its ``slope`` (per s) instead of its value.

    The first and the last cubic go on to the ends.
    """
    count = min(max(FEWEST, round(width / time_step) | 1), (values.size - 1) | 1)
    weights, half = _weights(count, slope), count // 2
    found = np.empty(values.size)
    found[half : values.size - half] = np.correlate(values, weights[half])
    found[:half] = weights[:half] @ values[:count]
    found[values.size - half :] = weights[half + 1 :] @ values[values.size - count :]
    return found / time_step if slope else found


@lru_cache(maxsize=256)
def _weights(count: int, slope: bool) -> FloatArray:
    """Weights (count, count) of the samples of a cubic in its value, or its slope a sample, at each of them."""
    from scipy.signal import savgol_coeffs

    return np.array([savgol_coeffs(count, 3, deriv=int(slope), pos=k, use="dot") for k in range(count)])
