"""A layer that stays compressed: s = k (u - u_p) + c u', u_p' = rate e max(0, (u - u_p)/e - strain_limit)."""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.rubber.base import Numbers, RubberLaw


def extra(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(-p["stiffness"] * h)


def rate(u: FloatArray, u_rate: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    e = p["thickness"]
    return np.asarray(p["rate"] * e * np.maximum(0.0, (u - h) / e - p["strain_limit"]))


def relaxed(u: FloatArray, p: Numbers) -> FloatArray:
    return np.zeros_like(u)


def tangent(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.zeros_like(u)


def energy(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    """k (u - u_p)^2/2 in all."""
    return np.asarray(p["stiffness"] * h * (0.5 * h - u))


def turned(u: FloatArray, rest: FloatArray, p: Numbers) -> FloatArray:
    return np.zeros_like(u)


LAW = RubberLaw("permanent_set", ("rate", "strain_limit"), extra, rate, relaxed, tangent, energy, turned)
