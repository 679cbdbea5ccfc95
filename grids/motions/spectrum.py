"""Elastic response spectrum of a motion."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.errors import InputError

FloatArray = NDArray[np.float64]

SAMPLES_A_PERIOD = 64
"""Instants per natural period at which a response is looked at: a peak is missed by 0.12 % at most."""


@dataclass(frozen=True, eq=False)
class ResponseSpectrum:
    """Peaks (n,) of u'' + 2 zeta w u' + w^2 u = -a(t), w = 2 pi / period, from rest.

    ``displacement`` |u| (m, relative to the ground) and ``pseudo_acceleration`` w^2 |u| (m s-2),
    over ``periods`` (s), at ``damping`` zeta.
    """

    periods: FloatArray
    damping: float
    displacement: FloatArray

    @property
    def pseudo_acceleration(self) -> FloatArray:
        return (2 * np.pi / self.periods) ** 2 * self.displacement


def default_periods() -> FloatArray:
    """120 periods from 0.02 to 10 s, evenly spaced on a logarithmic axis."""
    return np.geomspace(0.02, 10.0, 120)


def response_spectrum(
    acceleration: FloatArray, time_step: float, periods: Sequence[float] | FloatArray, damping: float = 0.05
) -> ResponseSpectrum:
    """Spectrum of samples (n,) in m s-2 at ``time_step`` (s) for ``periods`` (m,) in s.

    Exact for an acceleration linear between samples and zero outside of them (Nigam and Jennings,
    Bull. Seism. Soc. Am. 59, 1969); free motion after the record counts. Needs 0 <= damping < 1.
    """
    wanted = np.atleast_1d(np.asarray(periods, dtype=np.float64))
    if wanted.ndim != 1 or wanted.size == 0 or not (np.isfinite(wanted) & (wanted > 0.0)).all():
        raise InputError("response spectrum: periods must be positive finite numbers, in s")
    if not 0.0 <= damping < 1.0:
        raise InputError(f"response spectrum: damping is {damping!r}: give a ratio from 0 to below 1")
    values = np.ascontiguousarray(acceleration, dtype=np.float64)
    peaks = np.array([_peak_displacement(values, time_step, 2 * math.pi / period, damping) for period in wanted])
    return ResponseSpectrum(wanted, damping, peaks)


def _transition(omega: float, damping: float, step: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """x1 = A x0 + b0 p0 + b1 p1 for x = (u, u'), forcing p = -a linear over the step: exact."""
    from scipy.linalg import expm

    system = np.zeros((4, 4))
    system[0, 1] = 1.0
    system[1] = -(omega**2), -2 * damping * omega, 1.0, 0.0
    system[2, 3] = 1.0 / step  # the force grows by (p1 - p0)/step, held in the fourth state
    whole = expm(system * step)
    return whole[:2, :2], whole[:2, 2] - whole[:2, 3], whole[:2, 3]


def recursive_filter(omega: float, damping: float, step: float) -> tuple[FloatArray, FloatArray]:
    """Coefficients of the displacement u for the force p = -a: u_k = f.(p_k, p_k-1, p_k-2) - b.(u_k-1, u_k-2).

    Returns (f, (1, b)) as `scipy.signal.lfilter` takes them: the two-state recurrence with u' eliminated.
    """
    a, b0, b1 = _transition(omega, damping, step)
    forward = np.array([b1[0], b0[0] - a[1, 1] * b1[0] + a[0, 1] * b1[1], a[0, 1] * b0[1] - a[1, 1] * b0[0]])
    return forward, np.array([1.0, -np.trace(a), np.linalg.det(a)])


def _peak_displacement(acceleration: FloatArray, time_step: float, omega: float, damping: float) -> float:
    """Largest |u| over the record and the free motion after it."""
    from scipy.signal import lfilter

    refine = max(1, math.ceil(SAMPLES_A_PERIOD * time_step * omega / (2 * math.pi)))
    force = -acceleration
    if refine > 1:
        fine = np.arange((force.size - 1) * refine + 1) / refine
        force = np.interp(fine, np.arange(force.size), force)
    a, b0, b1 = _transition(omega, damping, time_step / refine)
    forward, backward = recursive_filter(omega, damping, time_step / refine)
    # u is zero at the first sample, although the force there need not be
    initial = np.array([-forward[0], a[1, 1] * b1[0] - a[0, 1] * b1[1]]) * force[0]
    u, _ = lfilter(forward, backward, force, zi=initial)
    velocity = (u[-1] - a[0, 0] * u[-2] - b0[0] * force[-2] - b1[0] * force[-1]) / a[0, 1]
    velocity = a[1, 0] * u[-2] + a[1, 1] * velocity + b0[1] * force[-2] + b1[1] * force[-1]
    return max(float(np.max(np.abs(u))), _free_peak(float(u[-1]), float(velocity), omega, damping))


def _free_peak(u: float, velocity: float, omega: float, damping: float) -> float:
    """First extremum of the free motion that starts at ``u``, ``velocity``."""
    damped = omega * math.sqrt(1.0 - damping**2)
    phase = math.atan2(velocity * damped, omega**2 * u + damping * omega * velocity) % math.pi
    sine = (velocity + damping * omega * u) / damped
    decay = math.exp(-damping * omega / damped * phase)
    return abs(decay * (u * math.cos(phase) + sine * math.sin(phase)))
