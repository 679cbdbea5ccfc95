"""What a diagnosis needs to know of the one-block model: theta leads, impacts separate, wear is remembered."""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.housner.ladder import LADDER
from models.identification import (
    Count,
    Dependence,
    Force,
    Identification,
    Largest,
    Lead,
    Motion,
    Scatter,
    Separation,
    State,
    WindowLengths,
)


def _over_largest(values: FloatArray) -> FloatArray:
    return np.asarray(values / max(float(np.max(np.abs(values))), 1e-12))


def _side(motion: Motion) -> FloatArray:
    return np.sign(motion.coordinate)


FORCES = (
    Force("restitution", "loss of velocity at impacts", 1, "base", None, event="impact"),
    Force("viscous_damping", "couple with the angular velocity", 1, "base", lambda m: _over_largest(m.rate)),
    Force("coulomb_damping", "couple against the motion", 1, "base", lambda m: np.sign(m.rate)),
    Force("contact", "constant couple on either side", 1, "base", _side),
    Force(
        "stiffness", "couple with the rotation", 1, "base", lambda m: m.coordinate / m.reach,
        # |theta| sign(theta') = theta sign(theta theta')
        named={"direction of motion": ("coulomb_damping", "size of the rotation")},
    ),
    Force(
        "lean", "constant couple in one direction", 1, "base", lambda m: np.ones_like(m.coordinate), signed=True,
        # sign(theta theta') = sign(theta') sign(theta)
        named={"direction of motion": ("coulomb_damping", "side")},
    ),
    Force("base_motion", "couple with the base acceleration", 1, "base", lambda m: _over_largest(m.base)),
)  # fmt: skip

IDENTIFICATION = Identification(
    leads=(Lead("rotation_1", 1, "base"),),
    states=(State("rotation_1", "rotation_1"), State("rotation_rate_1", "rotation_1", rate=True)),
    # In s, not in 1/p: the lengths with which the rates of right answers were measured, on piers of 1 to 2.6 m.
    windows=WindowLengths(shortest=0.3, aim=0.6, longest=0.85, quiet=0.35, smoothing=0.05),
    chaotic=True,
    memories=(Largest("peak_rotation_1", "rotation_1"), Count("impacts", "impact", "rotation_1")),
    forces=FORCES,
    dependences=(
        Dependence("side", _side, ("for theta < 0, to the left", "for theta > 0, to the right"), ("left", "right")),
        Dependence(
            "size of the rotation", lambda m: np.abs(m.coordinate) / m.reach,
            ("at small rotation", "at large rotation"), ("small_rotation", "large_rotation"), about_mean=True,
        ),
        Dependence(
            "direction of motion", lambda m: np.sign(m.coordinate * m.rate), ("on the way back", "on the way out")
        ),
    ),
    separation=Separation("impact", lambda m: m.coordinate, "between_impacts"),
    scatter=Scatter("impacts", "rotation_1", "rotation_rate_1"),
    phases={
        "impact": "at impacts",
        "between_impacts": "between impacts",
        "large_rotation": "at large rotations",
        "small_rotation": "at small rotations",
        "left": "while rocking to the left",
        "right": "while rocking to the right",
    },
    same={"rotation_2": "rotation_1"},
    ladder=LADDER,
)  # fmt: skip
