"""Hysteresis that does not depend on the rate (Bouc-Wen): s = a k u + (1-a) k zeta + c u'.

zeta' = u' - beta |u'| |zeta|^(n-1) zeta - gamma u' |zeta|^n with beta = gamma = 1/(2 u_y^n): zeta follows u
where it is unloaded, and d zeta/du = 1 - |zeta/u_y|^n where it is loaded.
"""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.rubber.base import Numbers, RubberLaw

STEPS = 200
"""Steps of the fourth-order rule for the virgin curve of an exponent that has no closed form."""


def extra(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray((1.0 - p["post_yield_ratio"]) * p["stiffness"] * (h - u))


def rate(u: FloatArray, u_rate: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    loaded = u_rate * h > 0.0
    return np.asarray(u_rate * np.where(loaded, 1.0 - np.abs(h / p["yield_compression"]) ** p["exponent"], 1.0))


def relaxed(u: FloatArray, p: Numbers) -> FloatArray:
    """The virgin curve from zeta(0) = 0; n = 1: u_y (1 - exp(-u/u_y)), n = 2: u_y tanh(u/u_y)."""
    limit = p["yield_compression"]
    x, n = np.broadcast_arrays(np.asarray(u / limit), p["exponent"])
    found = np.where(n == 1.0, -np.expm1(-x), np.tanh(x))
    other = ~np.isin(n, (1.0, 2.0))
    if np.any(other):
        found[other] = _integrated(x[other], n[other])
    return np.asarray(limit * found)


def _integrated(x: FloatArray, n: FloatArray) -> FloatArray:
    """zeta/u_y at u/u_y = x on the virgin curve, by the classical Runge-Kutta rule."""
    step, found = x / STEPS, np.zeros_like(x)
    for _ in range(STEPS):
        k1 = 1.0 - found**n
        k2 = 1.0 - (found + 0.5 * step * k1) ** n
        k3 = 1.0 - (found + 0.5 * step * k2) ** n
        k4 = 1.0 - (found + step * k3) ** n
        found = np.clip(found + step / 6.0 * (k1 + 2.0 * (k2 + k3) + k4), 0.0, 1.0)
    return found


def tangent(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    """zeta follows u on unloading: the slope of all is k."""
    return np.zeros_like(u)


def energy(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(0.5 * (1.0 - p["post_yield_ratio"]) * p["stiffness"] * (h**2 - u**2))


def turned(u: FloatArray, rest: FloatArray, p: Numbers) -> FloatArray:
    """Down from ``rest`` along u to zeta = 0, and a virgin curve of the other sign from there."""
    kept = relaxed(rest, p) - (rest - u)
    down = np.where(kept < 0.0, -relaxed(np.maximum(-kept, 0.0), p), kept)
    return np.where(u > rest, relaxed(u, p), down)


PARAMETERS = ("post_yield_ratio", "yield_compression", "exponent")
LAW = RubberLaw("bouc_wen", PARAMETERS, extra, rate, relaxed, tangent, energy, turned)
