"""A layer that stiffens as it is compressed: s = k u (1 + beta2 (u/e)^2) + c u'."""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.rubber.base import Numbers, RubberLaw


def extra(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(p["stiffness"] * u * p["beta2"] * (u / p["thickness"]) ** 2)


def rate(u: FloatArray, u_rate: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.zeros_like(u)


def relaxed(u: FloatArray, p: Numbers) -> FloatArray:
    return np.zeros_like(u)


def tangent(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(3.0 * p["stiffness"] * p["beta2"] * (u / p["thickness"]) ** 2)


def energy(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(0.25 * p["stiffness"] * u**2 * p["beta2"] * (u / p["thickness"]) ** 2)


def turned(u: FloatArray, rest: FloatArray, p: Numbers) -> FloatArray:
    return np.zeros_like(u)


LAW = RubberLaw("hardening", ("beta2",), extra, rate, relaxed, tangent, energy, turned, hidden=False)
