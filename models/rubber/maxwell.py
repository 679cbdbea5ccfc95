"""A spring and dashpot in series beside the layer (Zener): s = k u + k1 d + c u', d' = u' - d/tau.

d = u - v is the extension of the arm's spring, k1 = arm_stiffness_ratio k, tau its relaxation time.
"""

from __future__ import annotations

import numpy as np

from models.base import FloatArray, MechanismParameter
from models.rubber.base import Numbers, RubberLaw, rubber_mechanism

NOTHING = 1e-100
"""m: an extension below it is none."""


def effect(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(p["arm_stiffness_ratio"] * p["stiffness"] * h)


def slope(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    """Of the arm at once, v held: slower motions meet less."""
    return np.asarray(p["arm_stiffness_ratio"] * p["stiffness"] + 0.0 * u)


def energy(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(0.5 * p["arm_stiffness_ratio"] * p["stiffness"] * h**2)


def rate(u: FloatArray, u_rate: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    return np.asarray(u_rate - h / p["relaxation_time"])


def numbers(p: Numbers, step: FloatArray) -> Numbers:
    """k1 (N m-2); d after a step of constant u' is ``decay`` d + ``gain`` times the change of u, exactly."""
    tau = p["relaxation_time"]
    return {
        "stiffness": p["arm_stiffness_ratio"] * p["stiffness"],
        "decay": np.exp(-step / tau),
        "gain": -np.expm1(-step / tau) * tau / step,
    }


def update(
    u: float, change: float, h: float, stiffness: float, decay: float, gain: float
) -> tuple[float, float, float]:
    arm = decay * h + gain * change
    arm = arm if abs(arm) > NOTHING else 0.0  # what fades for ever becomes a subnormal number: ten times slower
    return arm, stiffness * arm, stiffness * gain


LAW = RubberLaw(
    rubber_mechanism(
        "maxwell",
        (
            MechanismParameter(
                "arm_stiffness_ratio", "k_1/k", "1", "stiffness of the relaxing arm over the layer's", 0.0, 1.5
            ),
            MechanismParameter(
                "relaxation_time", "tau", "s", "relaxation time of the arm", 0.005, 0.5, null=0.05, shape=True,
                required=True,
            ),
        ),
        equation="s = k u + k1 (u - v) + c u', v' = (u - v)/tau",
        signature="everywhere, more at higher frequencies",
        sentence="an arm of {arm_stiffness_ratio:.2f} times the layer's stiffness relaxes within "
        "{relaxation_time:.3f} s",
        static_test="hold the rubber at a constant strain and follow its force as it relaxes",
        source="models/rubber/maxwell.py",
    ),
    "adds", effect, numbers, update, slope, energy, rate,
)  # fmt: skip
