"""A spring and dashpot in series beside the layer (Zener): s = k u + k1 d + c u', d' = u' - d/tau.

d = u - v is the extension of the arm's spring, k1 = arm_stiffness_ratio k, tau its relaxation time.
"""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.rubber.base import Numbers, RubberLaw


def extra(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(p["arm_stiffness_ratio"] * p["stiffness"] * h)


def rate(u: FloatArray, u_rate: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(u_rate - h / p["relaxation_time"])


def relaxed(u: FloatArray, p: Numbers) -> FloatArray:
    return np.zeros_like(u)


def tangent(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    """Of the arm at once, v held: slower motions meet less."""
    return np.asarray(p["arm_stiffness_ratio"] * p["stiffness"] + 0.0 * u)


def energy(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(0.5 * p["arm_stiffness_ratio"] * p["stiffness"] * h**2)


def turned(u: FloatArray, rest: FloatArray, p: Numbers) -> FloatArray:
    return np.zeros_like(u)


LAW = RubberLaw("maxwell", ("arm_stiffness_ratio", "relaxation_time"), extra, rate, relaxed, tangent, energy, turned)
