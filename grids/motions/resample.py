"""Another sampling rate without another signal."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from models.errors import InputError

ZERO_CROSSINGS = 64
KAISER_BETA = 15.0
LARGEST_RATIO = 10_000


@lru_cache(maxsize=16)
def _window(rate: int) -> NDArray[np.float64]:
    from scipy.signal import firwin

    taps = firwin(2 * ZERO_CROSSINGS * rate + 1, 1.0 / rate, window=("kaiser", KAISER_BETA))
    return np.asarray(taps, dtype=np.float64)


def resample(
    values: NDArray[np.float64], old_step: float, new_step: float, where: str = "resampling"
) -> NDArray[np.float64]:
    """Samples (n,) at ``old_step`` as samples (m,) at ``new_step`` (s), the first at the same instant.

    Polyphase sinc with a Kaiser window (beta 15: side lobes below 1e-7), 64 zero crossings a side,
    cut-off at the lower of both Nyquist frequencies: content below 0.92 of it is kept to 1e-6,
    content above 1.08 of it is removed; with a whole number of new steps in an old one the old
    samples are kept. The record is zero before its first and after its last sample. The ratio of
    the steps must be a fraction of whole numbers up to 10 000.
    Source: Oppenheim and Schafer, Discrete-Time Signal Processing, 3rd ed., 4.6 and 7.5.
    """
    if not (math.isfinite(new_step) and new_step > 0.0):
        raise InputError(f"{where}: time_step is {new_step!r} s: give a positive step")
    ratio = Fraction(old_step / new_step).limit_denominator(LARGEST_RATIO)
    exact = ratio > 0 and abs(float(ratio) * new_step / old_step - 1.0) < 1e-9
    if not exact or ratio.numerator > LARGEST_RATIO:
        cure = old_step / float(max(ratio, Fraction(1, LARGEST_RATIO)))
        raise InputError(
            f"{where}: cannot be resampled from {old_step:.9g} s to {new_step:.9g} s, the ratio is no "
            f"fraction of whole numbers up to {LARGEST_RATIO}: give for instance {cure:.9g} s"
        )
    up, down = ratio.numerator, ratio.denominator
    if up == down:
        return values.copy()
    from scipy.signal import resample_poly

    count = ((values.size - 1) * up) // down + 1
    if count < 2:
        raise InputError(
            f"{where}: lasts {(values.size - 1) * old_step:g} s, shorter than the time_step "
            f"{new_step:g} s: give a smaller step"
        )
    taps = _window(max(up, down))
    whole = resample_poly(values, up, down, window=taps)  # type: ignore[call-overload,unused-ignore]  # older stubs: no array
    return np.asarray(whole[:count], dtype=np.float64)
