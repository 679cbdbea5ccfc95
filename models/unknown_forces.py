"""Forms of the forces that a model may lack and what they may depend on, alike for every model that rocks."""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.identification import Dependence, Force, Motion, Port


def _over_largest(values: FloatArray) -> FloatArray:
    return np.asarray(values / max(float(np.max(np.abs(values))), 1e-12))


def over_largest_rate(motion: Motion) -> FloatArray:
    """In proportion to the rate."""
    return _over_largest(motion.rate)


def over_largest_base(motion: Motion) -> FloatArray:
    """In proportion to the base acceleration."""
    return _over_largest(motion.base)


def over_reach(motion: Motion) -> FloatArray:
    """In proportion to the coordinate."""
    return motion.coordinate / motion.reach


def against(motion: Motion) -> FloatArray:
    """Of one size, against the motion."""
    return np.asarray(np.sign(motion.rate))


def side(motion: Motion) -> FloatArray:
    """Of one size, back to the middle from either side."""
    return np.asarray(np.sign(motion.coordinate))


def constant(motion: Motion) -> FloatArray:
    """Of one size and direction."""
    return np.ones_like(motion.coordinate)


DEPENDENCES = (
    Dependence("side", side, ("for theta < 0, to the left", "for theta > 0, to the right"), ("left", "right")),
    Dependence(
        "size of the rotation", lambda m: np.abs(m.coordinate) / m.reach,
        ("at small rotation", "at large rotation"), ("small_rotation", "large_rotation"), about_mean=True,
    ),
    Dependence("direction of motion", lambda m: np.sign(m.coordinate * m.rate), ("on the way back", "on the way out")),
)  # fmt: skip
PHASES = {
    "large_rotation": "at large rotations",
    "small_rotation": "at small rotations",
    "left": "while rocking to the left",
    "right": "while rocking to the right",
}
"""Words for the halves of the dependences, in plain English."""


def couples(port: Port, end: str = "", where: str = "") -> tuple[Force, ...]:
    """Kinds of couples in a joint; ``end`` of their names, and ``where`` in their meaning."""
    return (
        Force(f"viscous_damping{end}", f"couple{where} with the angular velocity", port, over_largest_rate),
        Force(f"coulomb_damping{end}", f"couple{where} against the motion", port, against),
        Force(f"contact{end}", f"constant couple{where} on either side", port, side),
        Force(
            f"stiffness{end}", f"couple{where} with the rotation", port, over_reach,
            # |theta| sign(theta') = theta sign(theta theta')
            named={"direction of motion": (f"coulomb_damping{end}", "size of the rotation")},
        ),
        Force(
            f"lean{end}", f"constant couple{where} in one direction", port, constant, signed=True,
            # sign(theta theta') = sign(theta') sign(theta)
            named={"direction of motion": (f"coulomb_damping{end}", "side")},
        ),
    )  # fmt: skip
