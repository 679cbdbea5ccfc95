"""The noise of a channel, from what a local polynomial leaves over, and whether it is white.

A Savitzky-Golay filter (9 points, degree 4; Anal. Chem. 36, 1964) with coefficients h leaves the
residual r = x - h * x. White noise of standard deviation sigma leaves

    std(r) = sigma sqrt(1 - h_0),        corr(r_i, r_i+1) = sum g_k g_k+1 / sum g_k^2,   g = delta - h,

since h is a projection (sum h_k^2 = h_0). The median absolute deviation ignores impacts. Steady lines are no noise of
this kind, and are taken out of the residual first.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np

from grids.recordings.base import FloatArray, Recording
from grids.recordings.lines import without_lines
from models.errors import InputError

WINDOW, DEGREE = 9, 4
MAD_TO_SIGMA = 1.482602218505602
"""Of a normal distribution."""
PASSED = 0.16
"""Cycles a sample, from which on more than a hundredth of a power is left; what is left of a motion lies below."""
OUTLIER = 4.0
PARTS, LEAST_PART = 20, 60
"""Part of a channel at either end that is compared with the other, and the fewest samples of it."""
CHANGED = 2.0
"""Ratio of two levels of noise from which on one is another; of `LEAST_PART` samples they scatter by a seventh."""
LAG_TOLERANCE = 0.1
"""Departure of the lag-one correlation that still counts as white, beside its own scatter 4/sqrt(n)."""


@dataclass(frozen=True)
class Noise:
    """``sigma`` in the channel's unit; lag-one correlation of the residual, found and if white."""

    sigma: float
    lag_one: float
    lag_one_if_white: float
    white: bool


@cache
def _high_pass() -> FloatArray:
    from scipy.signal import savgol_coeffs

    kernel = -np.asarray(savgol_coeffs(WINDOW, DEGREE), dtype=np.float64)
    kernel[WINDOW // 2] += 1.0
    return kernel


def noise_of(values: FloatArray) -> Noise:
    """The noise of one channel (n_times,), n_times >= 20.

    A channel without any noise (a computed one) has sigma 0 and counts as white. Valid while the
    signal is smooth over 9 samples except at isolated instants; a signal sampled too coarsely, or
    noise that was filtered, shows as not white. Raises InputError for a channel that is too short.
    """
    if values.size < 2 * WINDOW + 2:
        raise InputError(f"a channel of {values.size} samples is too short to estimate its noise; give at least 20.")
    kernel = _high_pass()
    energy = float(kernel @ kernel)
    if_white = float(kernel[:-1] @ kernel[1:]) / energy
    residual = without_lines(np.convolve(values, kernel, mode="valid"), PASSED)
    spread = MAD_TO_SIGMA * float(np.median(np.abs(residual - np.median(residual))))
    if spread <= 1e-12 * float(np.max(np.abs(values))):
        return Noise(0.0, if_white, if_white, True)
    quiet = np.abs(residual) < OUTLIER * spread
    pairs = quiet[:-1] & quiet[1:]
    before, after = residual[:-1][pairs], residual[1:][pairs]
    size = float(np.sqrt((before @ before) * (after @ after)))
    if size == 0.0:  # silent but for the signal
        return Noise(0.0, if_white, if_white, True)
    lag_one = float(before @ after) / size
    tolerance = max(LAG_TOLERANCE, 4.0 / np.sqrt(pairs.sum()))
    return Noise(spread / np.sqrt(energy), lag_one, if_white, abs(lag_one - if_white) < tolerance)


@dataclass(frozen=True)
class Louder:
    """White noise whose level changes at a ``sample``: standard deviations ``before`` and ``after``."""

    sample: int
    before: float
    after: float


def louder(values: FloatArray) -> Louder | None:
    """Where a channel's white noise becomes another for good; None where it does not.

    The likeliest sample at which the variance of the residual r changes, min_k k log v_k + (n - k) log v'_k with v_k
    the mean square of the first k and v'_k of the others. It counts where the first and the last part of the channel,
    in which nothing moves as a rule, differ alike: noise that grows with the motion is the same there.
    """
    kernel = _high_pass()
    part = max(LEAST_PART, values.size // PARTS)
    if values.size < 4 * part:
        return None
    residual = without_lines(np.convolve(values, kernel, mode="valid"), PASSED)
    spread = MAD_TO_SIGMA * float(np.median(np.abs(residual - np.median(residual))))
    if spread <= 1e-12 * float(np.max(np.abs(values))):
        return None
    squares = np.minimum(np.abs(residual), OUTLIER * spread) ** 2
    sums, n = np.cumsum(squares), squares.size
    k = np.arange(part, n - part)
    first, last = sums[k - 1] / k, (sums[-1] - sums[k - 1]) / (n - k)
    least = 1e-6 * spread**2
    split = int(k[np.argmin(k * np.log(first + least) + (n - k) * np.log(last + least))])
    at = split + WINDOW // 2
    sides = [noise_of(side) for side in (values[:at], values[at:], values[:part], values[-part:])]
    if not (sides[0].white and sides[1].white and min(side.sigma for side in sides) > 0.0):
        return None
    before, after, start, end = (side.sigma for side in sides)
    changes = np.log([after / before, end / start])
    if not (np.all(changes > np.log(CHANGED)) or np.all(changes < -np.log(CHANGED))):
        return None
    return Louder(at, before, after)


def noise_levels(recording: Recording) -> Mapping[str, tuple[Noise, ...]]:
    """The noise of every channel; one entry, or one for each level."""
    return {name: tuple(noise_of(row) for row in np.atleast_2d(values)) for name, values in recording.channels.items()}
