"""Impacts lose more or less energy than the conservation of angular momentum says."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block
from models.stacked.stack import Stack, at_joint


def on_housner(block: Block, values: Values) -> Block:
    return block.replace(restitution_factor=block.restitution_factor * values["factor_on_housner"])


def on_stacked(stack: Stack, values: Values) -> Stack:
    return stack.replace(
        base_factor=stack.base_factor * at_joint(values, "factor_on_housner", "base"),
        top_factor=stack.top_factor * at_joint(values, "factor_on_housner", "top"),
    )


MECHANISM = Mechanism(
    name="restitution",
    effect_class="restitution",
    parameters=(
        MechanismParameter(
            "factor_on_housner", "f_e", "1", "factor on the restitution of angular momentum", 0.5, 1.1, null=1.0
        ),
    ),
    equation="theta'_after = f_e e_H theta'_before",
    signature="only at impacts",
    sentence="each impact keeps {factor_on_housner:.3f} times the angular velocity that angular momentum predicts",
    acts={"housner": on_housner, "stacked": on_stacked},
    at_joints=("stacked",),
    static_test="let the block rock freely from a held rotation",
    source="ElGawady et al. (Earthquake Engng Struct. Dyn. 40, 2011): .95 on concrete, .67 on rubber",
)
