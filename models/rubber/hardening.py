"""A layer that stiffens as it is compressed: s = k u (1 + beta2 (u/e)^2) + c u'."""

from __future__ import annotations

import numpy as np

from models.base import FloatArray, MechanismParameter
from models.rubber.base import Numbers, RubberLaw, rubber_mechanism


def effect(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(p["stiffness"] * u * p["beta2"] * (u / p["thickness"]) ** 2)


def slope(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(3.0 * p["stiffness"] * p["beta2"] * (u / p["thickness"]) ** 2)


def energy(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(0.25 * p["stiffness"] * u**2 * p["beta2"] * (u / p["thickness"]) ** 2)


def numbers(p: Numbers, step: FloatArray) -> Numbers:
    """k beta2/e^2 (N m-4)."""
    return {"cubic": p["stiffness"] * p["beta2"] / p["thickness"] ** 2}


def update(u: float, _: float, h: float, cubic: float) -> tuple[float, float, float]:
    steeper = cubic * (u * u)
    return h, steeper * u, 3.0 * steeper


LAW = RubberLaw(
    rubber_mechanism(
        "hardening",
        (MechanismParameter("beta2", "beta_2", "1", "stiffening over the squared strain", 0.0, 80.0),),
        equation="s = k u (1 + beta2 (u/e)^2) + c u'",
        signature="at large rotations, while a joint presses on a short length",
        sentence="the rubber stiffens with the squared strain, coefficient {beta2:.1f}",
        static_test="load the rubber slowly and read force over deformation",
        source="models/rubber/hardening.py",
    ),
    "adds", effect, numbers, update, slope, energy, hidden=False, of_strain=True,
)  # fmt: skip
