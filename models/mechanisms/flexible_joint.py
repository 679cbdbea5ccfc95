"""The joint gives way: the restoring moment builds up over a small rotation instead of at once."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block


def on_housner(block: Block, values: Values) -> Block:
    return block.replace(joint_angle=values["angle"])


MECHANISM = Mechanism(
    name="flexible_joint",
    effect_class="flexible_joint",
    parameters=(
        MechanismParameter("angle", "theta_f", "rad", "rotation over which the restoring moment builds up", 0.0, 0.03),
    ),
    equation="gravity part of the restoring moment times 1 - exp(-|theta|/angle); no onset threshold, theta' times e "
    "at each crossing, at rest below 1e-6 of the largest crossing's energy",
    signature="at the first uplift and at small rotations",
    sentence="the joint is flexible: the restoring moment builds up over {angle:.2e} rad",
    acts={"housner": on_housner},
    static_test="push the block slowly and read the rotation before it lifts",
    source="form of this project, after the smooth moment-rotation curves of masonry joints",
)
