"""Hysteresis that does not depend on the rate (Bouc-Wen): s = a k u + (1-a) k zeta + c u'.

zeta' = u' - beta |u'| |zeta|^(n-1) zeta - gamma u' |zeta|^n with beta = gamma = 1/(2 u_y^n): zeta follows u
where it is unloaded, and d zeta/du = 1 - |zeta/u_y|^n where it is loaded.
"""

from __future__ import annotations

import numpy as np

from models.base import FloatArray, MechanismParameter
from models.lanes.elementary import exponential_decay
from models.rubber.base import Numbers, RubberLaw, rubber_mechanism

STEPS = 200
"""Steps of the fourth-order rule for the virgin curve of an exponent that has no closed form."""
EXPONENTS = (1.0, 2.0, 3.0, 4.0)


def effect(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray((1.0 - p["post_yield_ratio"]) * p["stiffness"] * (h - u))


def energy(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(0.5 * (1.0 - p["post_yield_ratio"]) * p["stiffness"] * (h**2 - u**2))


def rate(u: FloatArray, u_rate: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    loaded = u_rate * h > 0.0
    return np.asarray(u_rate * np.where(loaded, 1.0 - np.abs(h / p["yield_compression"]) ** p["exponent"], 1.0))


def relaxed(u: FloatArray, p: Numbers) -> FloatArray:
    """The virgin curve from zeta(0) = 0; n = 1: u_y (1 - exp(-u/u_y)), n = 2: u_y tanh(u/u_y); odd in u."""
    limit = p["yield_compression"]
    x, n = np.broadcast_arrays(np.asarray(np.abs(u) / limit), p["exponent"])
    found = np.where(n == 1.0, -np.expm1(-x), np.tanh(x))
    other = ~np.isin(n, (1.0, 2.0))
    if np.any(other):
        found[other] = _integrated(x[other], n[other])
    return np.asarray(np.copysign(limit * found, u))


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


def turned(u: FloatArray, rest: FloatArray, p: Numbers) -> FloatArray:
    """Down from ``rest`` along u to zeta = 0, and a virgin curve of the other sign from there."""
    kept = relaxed(rest, p) - (rest - u)
    down = np.where(kept < 0.0, relaxed(np.minimum(kept, 0.0), p), kept)
    return np.where(u > rest, relaxed(u, p), down)


def left(p: Numbers) -> FloatArray:
    return p["post_yield_ratio"]


def refusal(p: Numbers) -> str:
    odd = p["exponent"][~np.isin(p["exponent"], EXPONENTS)]
    return f"exponent is {odd.flat[0]:g}; give 1, 2, 3 or 4" if odd.size else ""


def numbers(p: Numbers, step: FloatArray) -> Numbers:
    """(1 - a) k (N m-2), 1/u_y (m-1), n."""
    return {
        "stiffness": (1.0 - p["post_yield_ratio"]) * p["stiffness"],
        "yielding": 1.0 / p["yield_compression"],
        "order": p["exponent"],
    }


def update(
    u: float, change: float, h: float, stiffness: float, yielding: float, order: float
) -> tuple[float, float, float]:
    """zeta by the exponential Rosenbrock-Euler rule; its slope over u is that of the step."""
    loaded = min(max((h if change >= 0.0 else -h) * yielding, 0.0), 1.0)
    # |zeta/u_y|^(n-1), n = 1, 2, 3, 4; 0 while unloading, where zeta follows u
    first = 1.0 if loaded > 0.0 else 0.0
    second, third = loaded if order > 1.5 else 1.0, loaded if order > 2.5 else 1.0
    lower = first * second * third * (loaded if order > 3.5 else 1.0)
    eased = order * yielding * lower * abs(change) + 1e-8
    part = (1.0 - lower * loaded) * (1.0 - exponential_decay(eased)) / eased
    zeta = h + change * part
    return zeta, stiffness * (zeta - u), stiffness * (part - 1.0)


LAW = RubberLaw(
    rubber_mechanism(
        "bouc_wen",
        (
            MechanismParameter(
                "post_yield_ratio", "a", "1", "stiffness after yielding over the first", 0.0, 1.0, null=1.0
            ),
            MechanismParameter(
                "yield_compression", "u_y", "m", "compression at which it yields", 1e-5, 0.05, null=1e-3, shape=True,
                required=True,
            ),
            MechanismParameter(
                "exponent", "n", "1", "sharpness of yielding, a whole number", 1.0, 4.0, null=1.0, shape=True
            ),
        ),
        equation="s = a k u + (1-a) k zeta + c u', zeta' = u' - beta |u'| |zeta|^(n-1) zeta - gamma u' |zeta|^n, "
        "beta = gamma = 1/(2 u_y^n)",
        signature="with the amplitude; loops at any frequency",
        sentence="the rubber yields at {yield_compression:.2e} m to {post_yield_ratio:.2f} of its stiffness "
        "(its parameters are not unique: look at the loop)",
        static_test="cycle the rubber slowly at several amplitudes and read its loops",
        source="Wen (J. Eng. Mech. Div. 102, 1976): models/rubber/bouc_wen.py",
    ),
    "adds", effect, numbers, update, energy=energy, rate=rate, relaxed=relaxed, turned=turned, refusal=refusal,
    left=left,
)  # fmt: skip
