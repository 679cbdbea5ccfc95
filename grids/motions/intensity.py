"""Intensity measures of a ground motion, with the rules for velocity and displacement."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from grids.motions.base import Motion
from grids.units import STANDARD_GRAVITY
from models.errors import InputError

FloatArray = NDArray[np.float64]

HIGH_PASS = 0.1
"""Default corner of the high-pass, Hz."""
ORDER = 4


@dataclass(frozen=True)
class IntensityMeasures:
    """Of the horizontal component: ``pga`` (m s-2), ``pgv`` (m s-1), ``pgd`` (m), ``arias`` (m s-1),
    ``significant_duration`` (s) from 5 to 95 % of Arias intensity, reached at ``start`` and ``end`` (s);
    ``rule`` is the baseline and high-pass rule of velocity and displacement."""

    pga: float
    pgv: float
    pgd: float
    arias: float
    significant_duration: float
    start: float
    end: float
    rule: str


def intensity_measures(motion: Motion, high_pass: float | None = HIGH_PASS) -> IntensityMeasures:
    """PGA, PGV, PGD, Arias intensity and significant duration of the horizontal component.

    PGA, Arias intensity and duration are of the acceleration as it is. ``high_pass`` as in
    `velocity_and_displacement`; a pulse or an artificial motion needs none, its velocity is never filtered.
    """
    corner = high_pass_of(motion, high_pass)
    velocity, displacement = velocity_and_displacement(motion.horizontal, motion.time_step, corner)
    start, end = significant_interval(motion.horizontal, motion.time_step)
    return IntensityMeasures(
        pga=motion.pga,
        pgv=float(np.max(np.abs(velocity))),
        pgd=float(np.max(np.abs(displacement))),
        arias=float(arias_growth(motion.horizontal, motion.time_step)[-1]),
        significant_duration=end - start,
        start=start,
        end=end,
        rule=velocity_rule(corner),
    )


def high_pass_of(motion: Motion, high_pass: float | None = HIGH_PASS) -> float | None:
    """The corner of the high-pass for a motion, Hz: none for a pulse or an artificial motion."""
    return None if motion.source.get("format") in ("pulse", "artificial") else high_pass


def velocity_rule(high_pass: float | None) -> str:
    """One sentence: what is done before acceleration is integrated."""
    if high_pass is None:
        return "integrated from rest as it is, no baseline correction and no filter"
    return (
        f"mean removed, zero pads of {_pad_time(high_pass):g} s on both sides, Butterworth high-pass "
        f"of order {ORDER} at {high_pass:g} Hz forward and backward (no phase shift), integrated from rest"
    )


def velocity_and_displacement(
    acceleration: FloatArray, time_step: float, high_pass: float | None = HIGH_PASS
) -> tuple[FloatArray, FloatArray]:
    """Velocity (n,) in m s-1 and displacement (n,) in m of samples (n,) in m s-2.

    With ``high_pass`` (Hz): the mean is removed, 1.5 order / corner seconds of zeros are added on both
    sides, a Butterworth high-pass of order 4 runs forward and backward, and the pads are dropped
    after integration (Boore, Bull. Seism. Soc. Am. 95, 2005). With None: integrated as it is.
    Integration is exact for an acceleration linear between samples.
    """
    values = np.asarray(acceleration, dtype=np.float64)
    pad = 0
    if high_pass is not None:
        from scipy.signal import butter, sosfiltfilt

        if not 0.0 < high_pass < 0.5 / time_step:
            raise InputError(
                f"high_pass is {high_pass!r} Hz: give a corner between 0 and {0.5 / time_step:g} Hz, or None"
            )
        pad = math.ceil(_pad_time(high_pass) / time_step)
        padded = np.pad(values - values.mean(), pad)
        sections = butter(ORDER, high_pass, btype="highpass", fs=1.0 / time_step, output="sos")
        values = sosfiltfilt(sections, padded, padtype=None)
    velocity = np.zeros_like(values)
    velocity[1:] = np.cumsum(0.5 * time_step * (values[1:] + values[:-1]))
    displacement = np.zeros_like(values)
    displacement[1:] = np.cumsum(time_step * velocity[:-1] + time_step**2 / 6 * (2 * values[:-1] + values[1:]))
    kept = slice(pad, values.size - pad)
    return velocity[kept], displacement[kept]


def _pad_time(high_pass: float) -> float:
    return 1.5 * ORDER / high_pass


def arias_growth(acceleration: FloatArray, time_step: float) -> FloatArray:
    """Arias intensity pi/(2 g) int a^2 dt up to each sample (n,), m s-1 (Arias, 1970).

    Exact for an acceleration linear between samples; g is 9.80665 m s-2.
    """
    a0, a1 = acceleration[:-1], acceleration[1:]
    growth = np.zeros(acceleration.size)
    growth[1:] = np.cumsum(time_step / 3 * (a0**2 + a0 * a1 + a1**2))
    return math.pi / (2 * STANDARD_GRAVITY) * growth


def significant_interval(acceleration: FloatArray, time_step: float) -> tuple[float, float]:
    """Times (s) at which Arias intensity reaches 5 and 95 % of its total.

    Source: Trifunac and Brady, Bull. Seism. Soc. Am. 65 (1975). Raises InputError for silence.
    """
    growth = arias_growth(acceleration, time_step)
    if growth[-1] == 0.0:
        raise InputError("significant duration: the acceleration is zero throughout, it has none")
    times = []
    for share in (0.05, 0.95):
        after = int(np.searchsorted(growth, share * growth[-1]))
        step = growth[after] - growth[after - 1]
        times.append(float(after - 1 + (share * growth[-1] - growth[after - 1]) / step) * time_step)
    return times[0], times[1]
