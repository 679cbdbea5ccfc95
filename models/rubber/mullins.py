"""Softening by the largest past compression: s = k [1 - softening (1 - exp(-u_max/(strain e)))] u + c u'.

u_max is the largest |u| so far. Beside other laws the factor in brackets multiplies what all of them carry.
"""

from __future__ import annotations

import numpy as np

from models.base import FloatArray, MechanismParameter
from models.lanes.elementary import exponential_decay
from models.rubber.base import Numbers, RubberLaw, rubber_mechanism


def effect(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(-p["softening"] * np.expm1(-reached(u, h, p) / (p["strain"] * p["thickness"])))


def rate(u: FloatArray, u_rate: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.where(np.abs(u) >= h, np.maximum(np.sign(u) * u_rate, 0.0), 0.0)


def relaxed(u: FloatArray, p: Numbers) -> FloatArray:
    return np.abs(u)


def turned(u: FloatArray, rest: FloatArray, p: Numbers) -> FloatArray:
    return reached(u, np.abs(rest), p)


def reached(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.maximum(h, np.abs(u))


def numbers(p: Numbers, step: FloatArray) -> Numbers:
    """softening, 1/(strain e) (m-1)."""
    return {"softening": p["softening"], "per_length": 1.0 / (p["strain"] * p["thickness"])}


def update(u: float, _: float, h: float, softening: float, per_length: float) -> tuple[float, float, float]:
    largest = max(h, abs(u))
    return largest, softening - softening * exponential_decay(largest * per_length), 0.0


LAW = RubberLaw(
    rubber_mechanism(
        "mullins",
        (
            MechanismParameter("softening", "s_M", "1", "largest share of stiffness lost", 0.0, 0.7),
            MechanismParameter("strain", "eps_M", "1", "strain over which it is lost", 0.02, 2.0, null=0.5, shape=True),
        ),
        equation="s = k [1 - softening (1 - exp(-u_max/(strain e)))] u + c u'",
        signature="grows with the largest rotation so far",
        sentence="the rubber has lost up to {softening:.1%} of its stiffness over a strain of {strain:.2f}",
        static_test="cycle the rubber slowly to a small strain, to a large one and to the small one again",
        source="Mullins (Rubber Chem. Technol. 42, 1969): models/rubber/mullins.py",
    ),
    "softens", effect, numbers, update, rate=rate, relaxed=relaxed, turned=turned, reached=reached, of_strain=True,
)  # fmt: skip
