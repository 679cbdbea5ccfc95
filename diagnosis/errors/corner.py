"""Where a filter begins to weaken noise: the frequency at which half of its density is left, -3 dB.

It is read off the spectrum of the residuals. The estimated errors are sums of a few kernels of given widths
(`diagnosis.errors.components`), which weigh residuals well and have the corner of the nearest kernel: of filters
of the fourth order from 16 to 30 Hz theirs is 16 Hz.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from models.base import FloatArray

LOW, MIDDLE = (2.0, 6.0), (6.0, 12.0)
"""Hz, bands of which the denser one is what a filter leaves as it was."""
SMOOTH = 7
"""Frequencies, 1 Hz apart, over which a density is averaged: that of some twenty windows scatters by a quarter."""


def corner(frequency: FloatArray, found: FloatArray, hum: Sequence[float] = ()) -> float | None:
    """Hz, the highest ``frequency`` (n,) at which half of the density ``found`` (n,) below `MIDDLE`'s end is left.

    Of twenty windows or more mostly within 2 to 3 Hz of that of filters of the second and fourth order from 8 to 40 Hz,
    where the model leaves no error of its own; of fewer the density scatters more. None where the density never falls
    to half, a line of ``hum`` (Hz) lies at the corner, or nothing is left to see.
    """
    if frequency[-1] <= MIDDLE[1]:
        return None
    counted = np.convolve(np.ones_like(frequency), np.ones(SMOOTH), "same")
    smooth = np.convolve(found, np.ones(SMOOTH), "same") / counted
    bands = [smooth[(frequency >= low) & (frequency <= high)] for low, high in (LOW, MIDDLE)]
    whole = max(float(np.mean(band)) for band in bands)
    left = np.flatnonzero(smooth >= 0.5 * whole)
    if whole == 0.0 or left[-1] + 1 == frequency.size:
        return None
    highest = float(frequency[left[-1]])
    return None if any(abs(line - highest) <= SMOOTH // 2 for line in hum) else highest
