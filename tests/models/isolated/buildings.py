"""Buildings on bearings, laws and shakings for the tests of `isolated`."""

from __future__ import annotations

from typing import Any

import numpy as np

import models
from models.isolated.chain import Chain
from models.shaking import Shaking

MODEL = models.get("isolated")
BODY = {"total_mass": 3e5, "bearing_stiffness": 3e6, "bearing_damping": 1.5e5, "rubber_thickness": 0.1}
HOUSE = {**BODY, "levels": 6.0, "storey_stiffness": 3e8, "storey_damping": 1e6}
LAWS = {
    "hardening": {"hardening.beta2": 0.3},
    "locking": {"locking.lock_strain": 3.0},
    "maxwell": {"maxwell.arm_stiffness_ratio": 0.6, "maxwell.relaxation_time": 0.08},
    "bouc_wen, n 1": {"bouc_wen.post_yield_ratio": 0.2, "bouc_wen.yield_compression": 0.01, "bouc_wen.exponent": 1.0},
    "bouc_wen, n 2": {"bouc_wen.post_yield_ratio": 0.2, "bouc_wen.yield_compression": 0.01, "bouc_wen.exponent": 2.0},
    "two arms": {
        "maxwell.arm_stiffness_ratio": 0.6, "maxwell.relaxation_time": 0.08,
        "maxwell_2.arm_stiffness_ratio": 0.4, "maxwell_2.relaxation_time": 0.4,
    },
    "two yields": {
        "bouc_wen.post_yield_ratio": 0.5, "bouc_wen.yield_compression": 0.004, "bouc_wen.exponent": 1.0,
        "bouc_wen_2.post_yield_ratio": 0.3, "bouc_wen_2.yield_compression": 0.03, "bouc_wen_2.exponent": 2.0,
    },
    "mullins": {"mullins.softening": 0.5, "mullins.strain": 0.5},
    "payne": {"payne.softening": 0.5, "payne.strain": 0.5},
    "degradation": {"degradation.final_loss": 0.6, "degradation.cycles": 3.0},
}  # fmt: skip
NULLS = {
    "hardening": {"hardening.beta2": 0.0},
    "locking": {"locking.lock_strain": np.inf},
    "maxwell": {"maxwell.arm_stiffness_ratio": 0.0},
    "bouc_wen": {"bouc_wen.post_yield_ratio": 1.0},
    "maxwell_2": {"maxwell_2.arm_stiffness_ratio": 0.0},
    "bouc_wen_2": {"bouc_wen_2.post_yield_ratio": 1.0},
    "mullins": {"mullins.softening": 0.0},
    "payne": {"payne.softening": 0.0},
    "degradation": {"degradation.final_loss": 0.0},
}


def chain(values: dict[str, Any], size: int = 1) -> Chain:
    return MODEL.build(values, size=size)


def two_tones(duration: float = 3.0, step: float = 0.01) -> Shaking:
    """Two sines near the bearings' frequency and a little above, 2 m s-2."""
    time = step * np.arange(round(duration / step) + 1)
    return Shaking(step, 1.4 * np.sin(2 * np.pi * time) + 0.7 * np.sin(2 * np.pi * 3.1 * time))


def random_building(rng: np.random.Generator) -> dict[str, float]:
    """One to six levels on bearings of .8 to 4 s, every law and mechanism now and then."""
    mass, levels = float(rng.uniform(1e4, 1e6)), int(rng.integers(1, 7))
    omega = 2 * np.pi / float(rng.uniform(0.8, 4.0))
    stiffness = mass * omega**2
    values = {
        "levels": float(levels),
        "total_mass": mass,
        "bearing_stiffness": stiffness,
        "bearing_damping": 2 * float(rng.uniform(0.0, 0.2)) * mass * omega,
        "rubber_thickness": float(rng.uniform(0.05, 0.3)),
        "storey_stiffness": stiffness * float(10 ** rng.uniform(0.5, 3.0)),
        "storey_damping": mass * omega * float(rng.uniform(0.0, 1.0)),
    }
    for name, law in LAWS.items():
        if name != "locking" and rng.random() < 0.4:
            values |= law
    return values
