"""Softening by the largest past compression: s = k [1 - softening (1 - exp(-u_max/(strain e)))] u + c u'."""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.rubber.base import Numbers, RubberLaw


def extra(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    lost = p["softening"] * -np.expm1(-np.maximum(h, u) / (p["strain"] * p["thickness"]))
    return np.asarray(-p["stiffness"] * lost * u)


def rate(u: FloatArray, u_rate: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.where(u >= h, np.maximum(u_rate, 0.0), 0.0)


def relaxed(u: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(u)


def tangent(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(p["stiffness"] * p["softening"] * np.expm1(-np.maximum(h, u) / (p["strain"] * p["thickness"])))


def energy(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(0.5 * u * extra(u, h, p))


def turned(u: FloatArray, rest: FloatArray, p: Numbers) -> FloatArray:
    return np.maximum(u, rest)


LAW = RubberLaw("mullins", ("softening", "strain"), extra, rate, relaxed, tangent, energy, turned)
