"""A rocking block with mechanisms and laws of its own: a program apart from the models, from rest.

    theta'' = -(M R_s/I_s) [ G sin(alpha_s s - theta) + A cos(alpha_s s - theta) ] - couples/I_s + law
    couples = k M g R max(0, |theta| - gap) s + I_s (viscous + quadratic |theta'|) theta' + c M g b sign(theta')
    theta'_after = [ e_s f max(floor, 1 - loss n) (1 - beta |theta'|/(p alpha)) (law's ratio) + kick_n ] theta'_before

s: side; A = a - g sin(tilt), G = g cos(tilt); e_s keeps the angular momentum about the new pivot; n: impacts so
far; kick_n: the scatter of impact n. Classical Runge-Kutta steps on the fine grid (.625 ms, the acceleration
linear in between); an impact is located by bisection of the step in which theta changes sign. Rest: an
impact slower than 2e-3 p alpha that the ground and the law let stay. Mechanisms may act in intervals: the state
goes on, the equations change with the step that begins at or after the instant.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from benchmarks.diagnosis.open_laws import Law, nothing, still, unchanged

FloatArray = NDArray[np.float64]

NULLS = {
    "pivot_inset.inset_over_half_width": 0.0,
    "eccentricity.offset_over_half_width": 0.0,
    "tilt.tilt": 0.0,
    "added_stiffness.over_m_g_R": 0.0,
    "added_stiffness.gap": 0.0,
    "restitution.factor_on_housner": 1.0,
    "velocity_restitution.beta": 0.0,
    "degradation.loss_of_restitution_per_impact": 0.0,
    "degradation.floor": 0.0,
    "viscous_damping.rate": 0.0,
    "coulomb_damping.over_m_g_b": 0.0,
    "quadratic_damping.coefficient": 0.0,
}
"""The mechanisms that this program knows, by parameter, each with the value that switches it off."""
MOST_IMPACTS = 2000
"""Scatter is drawn for so many impacts of a recording."""


@dataclass(frozen=True)
class Motion:
    """Rotation (rad) and rate (rad s-1) on the fine grid, and the number of impacts."""

    rotation: FloatArray
    rate: FloatArray
    impacts: int


@dataclass(frozen=True)
class Applied:
    """A law with its numbers in one recording: ``numbers`` are the law's own, ``active`` in s."""

    law: Law
    size: float
    numbers: tuple[float, float, float]
    active: tuple[float, float]
    largest: float

    def couple_parameters(self, height: float) -> FloatArray:
        lever = self.numbers[self.law.lever - 1] * height / 2.0 if self.law.lever else 0.0
        return np.array([self.size, *self.numbers, *self.active, lever])


def run(
    width: float,
    height: float,
    gravity: float,
    acceleration: FloatArray,
    step: float,
    applied: Applied | None = None,
    mechanisms: Mapping[str, float] | None = None,
    active: Sequence[tuple[float, float]] | None = None,
    kicks: FloatArray | None = None,
) -> Motion:
    """The motion of a solid rectangle from rest; ``acceleration`` (n,) in m s-2 at steps of ``step`` (s).

    ``mechanisms``: values by ``mechanism.parameter`` (see `NULLS`), which act in the intervals ``active`` (s; None:
    always). ``kicks`` (at least as many as impacts): change of theta'_after over theta'_before, impact by impact.
    """
    b, h = width / 2.0, height / 2.0
    radius, alpha = math.hypot(b, h), math.atan2(b, h)
    geometry = np.array([3.0 * gravity / (4.0 * radius), alpha, gravity, radius, applied.largest if applied else 0.0])
    rows = np.array([coefficients(b, h, gravity, NULLS), coefficients(b, h, gravity, {**NULLS, **(mechanisms or {})})])
    row = within(step * np.arange(acceleration.size - 1), active).astype(np.int64)
    law = applied.law if applied else None
    rotation, rate, impacts = _integrate(
        law.couple if law else nothing, law.hidden if law else still, law.ratio if law else unchanged, acceleration,
        step, geometry, applied.couple_parameters(height) if applied else np.zeros(7), rows, row,
        np.zeros(MOST_IMPACTS) if kicks is None else kicks,
    )  # fmt: skip
    return Motion(rotation, rate, int(impacts))


def within(time: FloatArray, active: Sequence[tuple[float, float]] | None) -> NDArray[np.bool_]:
    """Whether each time (s) lies in one of the intervals; None: always."""
    if active is None:
        return np.ones(time.shape, bool)
    found = np.zeros(time.shape, bool)
    for begin, end in active:
        found |= (time >= begin) & (time < end)
    return found


def coefficients(b: float, h: float, gravity: float, values: Mapping[str, float]) -> FloatArray:
    """What `_derivative` and the impact read: five numbers of the left side, five of the right, ten of both.

    By side: M R/I, alpha, e on leaving it, and the couples of spring and dry friction over I. ``b``, ``h``: half the
    width and height (m).
    """
    inset, offset = values["pivot_inset.inset_over_half_width"], values["eccentricity.offset_over_half_width"]
    tilt = values["tilt.tilt"]
    own = (b * b + h * h) / 3.0
    arm = {s: b * (1.0 - inset) - s * offset * b for s in (-1, 1)}
    sides = []
    for s in (-1, 1):
        inertia, after = (own + h * h + arm[k] ** 2 for k in (s, -s))
        sides.append([
            math.hypot(arm[s], h) / inertia, math.atan2(arm[s], h), (own + h * h - arm[s] * arm[-s]) / after,
            values["added_stiffness.over_m_g_R"] * gravity * math.hypot(b, h) / inertia,
            values["coulomb_damping.over_m_g_b"] * gravity * b / inertia,
        ])  # fmt: skip
    return np.array([
        *sides[0], *sides[1], gravity * math.cos(tilt), gravity * math.sin(tilt), values["added_stiffness.gap"],
        values["viscous_damping.rate"], values["quadratic_damping.coefficient"],
        values["restitution.factor_on_housner"], values["velocity_restitution.beta"],
        values["degradation.loss_of_restitution_per_impact"], values["degradation.floor"],
        min(math.sqrt(gravity * side[0]) * side[1] for side in sides),
    ])  # fmt: skip


@njit
def _derivative(couple: Any, hidden: Any, y: Any, s: float, held: bool, t: float, a: float, p: Any, g: Any, m: Any):  # type: ignore[no-untyped-def]
    theta, rate, u, v = y
    if held:
        return 0.0, 0.0, v, hidden(t, u, v, 0.0, a, p)
    k = 5 if s > 0.0 else 0
    lean = m[k + 1] * s - theta
    second = -m[k] * (m[10] * math.sin(lean) + (a - m[11]) * math.cos(lean))
    second -= m[k + 3] * max(0.0, abs(theta) - m[12]) * s + (m[13] + m[14] * abs(rate)) * rate
    second -= m[k + 4] * (s if rate == 0.0 else math.copysign(1.0, rate))
    second += couple(t, theta, rate, u, v, a, p, g)
    return rate, second, v, hidden(t, u, v, second, a, p)


@njit
def _moved(y: Any, h: float, k: Any):  # type: ignore[no-untyped-def]
    return y[0] + h * k[0], y[1] + h * k[1], y[2] + h * k[2], y[3] + h * k[3]


@njit
def _step(couple: Any, hidden: Any, y: Any, s: float, held: bool, t: float, h: float, a: float, slope: float,  # type: ignore[no-untyped-def]
          p: Any, g: Any, m: Any):  # fmt: skip
    middle = a + 0.5 * h * slope
    k1 = _derivative(couple, hidden, y, s, held, t, a, p, g, m)
    k2 = _derivative(couple, hidden, _moved(y, 0.5 * h, k1), s, held, t + 0.5 * h, middle, p, g, m)
    k3 = _derivative(couple, hidden, _moved(y, 0.5 * h, k2), s, held, t + 0.5 * h, middle, p, g, m)
    k4 = _derivative(couple, hidden, _moved(y, h, k3), s, held, t + h, a + h * slope, p, g, m)
    y = _moved(_moved(y, h / 6.0, k1), h / 3.0, k2)
    return _moved(_moved(y, h / 3.0, k3), h / 6.0, k4)


@njit
def _tips(couple: Any, hidden: Any, y: Any, t: float, a: float, p: Any, g: Any, m: Any):  # type: ignore[no-untyped-def]
    """The side to which the block at rest starts to turn, 0 if it stays."""
    for s in (1.0, -1.0):
        lying = (s * 1e-12, 0.0, y[2], y[3])
        if s * _derivative(couple, hidden, lying, s, False, t, a, p, g, m)[1] > 0.0:
            return s
    return 0.0


@njit
def _integrate(couple: Any, hidden: Any, ratio: Any, acceleration: Any, step: float, g: Any, p: Any, rows: Any,  # type: ignore[no-untyped-def]
               row: Any, kicks: Any):  # fmt: skip
    count = acceleration.size
    rotation, rate = np.zeros(count), np.zeros(count)
    y, s, held, impacts = (0.0, 0.0, 0.0, 0.0), 1.0, True, 0
    for k in range(count - 1):
        slope = (acceleration[k + 1] - acceleration[k]) / step
        t, left, m = k * step, step, rows[row[k]]
        for _ in range(100):
            a = acceleration[k + 1] - slope * left
            t = (k + 1) * step - left
            if held:
                side = _tips(couple, hidden, y, t, a, p, g, m)
                if side == 0.0 and _tips(couple, hidden, y, t + left, acceleration[k + 1], p, g, m) != 0.0:
                    low, high = 0.0, left
                    for _ in range(50):
                        middle = 0.5 * (low + high)
                        tips = _tips(couple, hidden, y, t + middle, a + slope * middle, p, g, m)
                        low, high = (low, middle) if tips != 0.0 else (middle, high)
                    y = _step(couple, hidden, y, s, True, t, high, a, slope, p, g, m)
                    left -= high
                    side = _tips(couple, hidden, y, t + high, a + slope * high, p, g, m)
                    a, t = a + slope * high, t + high
                if side != 0.0:
                    held, s = False, side
            new = _step(couple, hidden, y, s, held, t, left, a, slope, p, g, m)
            if held or s * new[0] >= 0.0:
                y = new
                break
            low, high = 0.0, left
            for _ in range(60):
                middle = 0.5 * (low + high)
                if s * _step(couple, hidden, y, s, held, t, middle, a, slope, p, g, m)[0] >= 0.0:
                    low = middle
                else:
                    high = middle
            y = _step(couple, hidden, y, s, held, t, high, a, slope, p, g, m)
            left -= high
            e = m[15] * m[7 if s > 0.0 else 2] * (1.0 - m[16] * abs(y[1]) / m[19])
            s = -s
            before = y[1]
            kept = e * max(m[18], 1.0 - m[17] * impacts) * ratio(t + high, s, p) + kicks[impacts % kicks.size]
            after = max(0.0, kept) * before
            y = (0.0, after, y[2], y[3] - p[6] * (after - before))
            impacts += 1
            if abs(after) < 2e-3 * m[19] and _tips(couple, hidden, y, t + high, a + high * slope, p, g, m) == 0.0:
                y, held = (0.0, 0.0, y[2], y[3]), True
            if left <= 1e-15:
                break
        rotation[k + 1], rate[k + 1] = y[0], y[1]
        if abs(y[0]) > 1.5:
            rotation[k + 1 :] = y[0]
            break
    return rotation, rate, impacts
