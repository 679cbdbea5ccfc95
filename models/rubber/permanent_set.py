"""A layer that stays compressed: s = k (u - u_p) + c u', u_p' = rate e max(0, (u - u_p)/e - strain_limit).

Beside other laws u - u_p is what they all see as the compression. The set grows with the strain, whatever the stress:
beside `bouc_wen` or `maxwell`, whose stress may turn to tension while the layer is compressed, it then gives energy.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray, MechanismParameter
from models.rubber.base import Numbers, RubberLaw, rubber_mechanism


def effect(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return h


def rate(u: FloatArray, u_rate: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    e = p["thickness"]
    return np.asarray(p["rate"] * e * np.maximum(0.0, (u - h) / e - p["strain_limit"]))


def restless(p: Numbers, u: FloatArray) -> tuple[NDArray[np.bool_], str]:
    limit, strain = np.broadcast_arrays(p["strain_limit"], u / p["thickness"])
    worst = int(np.argmax(np.where(limit <= strain, strain - limit, -np.inf)))
    return limit <= strain, (
        f"permanent_set.strain_limit is {limit.flat[worst]:.3g}, not above the strain at rest, "
        f"{strain.flat[worst]:.3g}: the layer would creep without end; give a larger limit"
    )


def numbers(p: Numbers, step: FloatArray) -> Numbers:
    """Share of what exceeds the limit (m) that flows in a step, at the step's mean compression."""
    return {"share": -np.expm1(-p["rate"] * step), "limit": p["strain_limit"] * p["thickness"]}


def update(u: float, change: float, h: float, share: float, limit: float) -> tuple[float, float, float]:
    kept = h + share * max(u - 0.5 * change - h - limit, 0.0)
    return kept, kept, 0.0


LAW = RubberLaw(
    rubber_mechanism(
        "permanent_set",
        (
            MechanismParameter(
                "rate", "r_p", "s-1", "rate of permanent compression beyond the strain limit", 0.0, 20.0
            ),
            MechanismParameter(
                "strain_limit", "eps_p", "1", "strain without permanent compression", 0.0, 2.0, null=0.5, shape=True,
                required=True,
            ),
        ),
        equation="s = k (u - u_p) + c u', u_p' = rate e max(0, (u - u_p)/e - strain_limit)",
        signature="late; rotations that do not come back",
        sentence="the rubber takes a set at {rate:.2f} per second beyond a strain of {strain_limit:.2f}",
        static_test="measure the thickness of the rubber before and after a run",
        source="models/rubber/permanent_set.py",
        models=("interface",),
    ),
    "shifts", effect, numbers, update, rate=rate, of_strain=True, restless=restless,
)  # fmt: skip
