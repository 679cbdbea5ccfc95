"""A rocking block under a law of `open_laws`: a program apart from the models, from rest.

    theta'' = -p^2 [ sin(alpha s - theta) + (a/g) cos(alpha s - theta) ] + law,  theta'_after = e f theta'_before

Classical Runge-Kutta steps on the fine grid (.625 ms, the acceleration linear in between); an impact is
located by bisection of the step in which theta changes sign. Rest: an impact slower than 2e-3 p alpha that
the ground and the law let stay.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from benchmarks.diagnosis.open_laws import Law

FloatArray = NDArray[np.float64]


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


def run(width: float, height: float, gravity: float, acceleration: FloatArray, step: float, applied: Applied) -> Motion:
    """The motion of a solid rectangle from rest; ``acceleration`` (n,) in m s-2 at steps of ``step`` (s)."""
    b, h = width / 2.0, height / 2.0
    radius, alpha = math.hypot(b, h), math.atan2(b, h)
    geometry = np.array([3.0 * gravity / (4.0 * radius), alpha, gravity, radius, applied.largest])
    e = 1.0 - 1.5 * math.sin(alpha) ** 2
    law = applied.law
    rotation, rate, impacts = _integrate(
        law.couple, law.hidden, law.ratio, acceleration, step, geometry, applied.couple_parameters(height), e
    )
    return Motion(rotation, rate, int(impacts))


@njit
def _derivative(couple: Any, hidden: Any, y: Any, s: float, held: bool, t: float, a: float, p: Any, g: Any):  # type: ignore[no-untyped-def]
    theta, rate, u, v = y
    if held:
        return np.array([0.0, 0.0, v, hidden(t, u, v, 0.0, a, p)])
    lean = g[1] * s - theta
    second = -g[0] * (math.sin(lean) + a / g[2] * math.cos(lean)) + couple(t, theta, rate, u, v, a, p, g)
    return np.array([rate, second, v, hidden(t, u, v, second, a, p)])


@njit
def _step(couple: Any, hidden: Any, y: Any, s: float, held: bool, t: float, h: float, a: float, slope: float,  # type: ignore[no-untyped-def]
          p: Any, g: Any):  # fmt: skip
    k1 = _derivative(couple, hidden, y, s, held, t, a, p, g)
    k2 = _derivative(couple, hidden, y + 0.5 * h * k1, s, held, t + 0.5 * h, a + 0.5 * h * slope, p, g)
    k3 = _derivative(couple, hidden, y + 0.5 * h * k2, s, held, t + 0.5 * h, a + 0.5 * h * slope, p, g)
    k4 = _derivative(couple, hidden, y + h * k3, s, held, t + h, a + h * slope, p, g)
    return y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)


@njit
def _tips(couple: Any, hidden: Any, y: Any, t: float, a: float, p: Any, g: Any):  # type: ignore[no-untyped-def]
    """The side to which the block at rest starts to turn, 0 if it stays."""
    for s in (1.0, -1.0):
        lying = y.copy()
        lying[0], lying[1] = s * 1e-12, 0.0
        if s * _derivative(couple, hidden, lying, s, False, t, a, p, g)[1] > 0.0:
            return s
    return 0.0


@njit
def _integrate(couple: Any, hidden: Any, ratio: Any, acceleration: Any, step: float, g: Any, p: Any, e: float):  # type: ignore[no-untyped-def]
    count = acceleration.size
    rotation, rate = np.zeros(count), np.zeros(count)
    y, s, held, impacts = np.zeros(4), 1.0, True, 0
    slow = 2e-3 * math.sqrt(g[0]) * g[1]
    for k in range(count - 1):
        slope = (acceleration[k + 1] - acceleration[k]) / step
        t, left = k * step, step
        for _ in range(100):
            a = acceleration[k + 1] - slope * left
            t = (k + 1) * step - left
            if held:
                side = _tips(couple, hidden, y, t, a, p, g)
                if side == 0.0 and _tips(couple, hidden, y, t + left, acceleration[k + 1], p, g) != 0.0:
                    low, high = 0.0, left
                    for _ in range(50):
                        middle = 0.5 * (low + high)
                        tips = _tips(couple, hidden, y, t + middle, a + slope * middle, p, g)
                        low, high = (low, middle) if tips != 0.0 else (middle, high)
                    y = _step(couple, hidden, y, s, True, t, high, a, slope, p, g)
                    left -= high
                    side = _tips(couple, hidden, y, t + high, a + slope * high, p, g)
                    a, t = a + slope * high, t + high
                if side != 0.0:
                    held, s = False, side
            new = _step(couple, hidden, y, s, held, t, left, a, slope, p, g)
            if held or s * new[0] >= 0.0:
                y = new
                break
            low, high = 0.0, left
            for _ in range(60):
                middle = 0.5 * (low + high)
                if s * _step(couple, hidden, y, s, held, t, middle, a, slope, p, g)[0] >= 0.0:
                    low = middle
                else:
                    high = middle
            y = _step(couple, hidden, y, s, held, t, high, a, slope, p, g)
            left -= high
            s = -s
            before = y[1]
            y[0] = 0.0
            y[1] = e * ratio(t + high, s, p) * before
            y[3] -= p[6] * (y[1] - before)
            impacts += 1
            if abs(y[1]) < slow and _tips(couple, hidden, y, t + high, a + high * slope, p, g) == 0.0:
                y[1], held = 0.0, True
            if left <= 1e-15:
                break
        rotation[k + 1], rate[k + 1] = y[0], y[1]
        if abs(y[0]) > 1.5:
            rotation[k + 1 :] = y[0]
            break
    return rotation, rate, impacts
