"""The mass centre stands beside the middle of the base."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block
from models.interface.layered import LayeredWall
from models.stacked.stack import Stack


def on_housner(block: Block, values: Values) -> Block:
    shift = values["offset_over_half_width"] * block.base_half_width
    return block.replace(right=block.right - shift, left=block.left + shift)


def on_stacked(stack: Stack, values: Values) -> Stack:
    offset = values["offset_over_half_width"]
    return stack.replace(
        shift_1=stack.shift_1 + offset * stack.half_length_1, shift_2=stack.shift_2 + offset * stack.half_joint
    )


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    return wall.with_effect("eccentricity", top_offset=values["offset_top"])


OF_TOP_MASS = Mechanism(
    name="eccentricity",
    effect_class="tilt",
    parameters=(
        MechanismParameter(
            "offset_top", "d", "m", "mass centre of the upper body off its middle, positive to +x", -0.2, 0.2
        ),
    ),
    equation="G2 = T + Rot(theta2)(d, h2), T the middle of the upper body's underside",
    signature="differs left and right; the wall leans at rest",
    sentence="the mass centre of the upper body lies {offset_top:+.3g} m off its middle (positive to +x)",
    acts={"interface": on_interface},
    static_test="turn the top mass by 180 degrees and repeat a run",
    source="geometry: models/interface/chain.py",
)


MECHANISM = Mechanism(
    name="eccentricity",
    effect_class="eccentricity",
    parameters=(
        MechanismParameter(
            "offset_over_half_width", "eps", "1", "mass centre off the middle over the half width, positive to +x",
            -0.2, 0.2,
        ),
    ),
    equation="b+ = b (1 - eps), b- = b (1 + eps); the inertia about the mass centre stays",
    signature="differs left and right; restitution and frequency of both sides differ too",
    sentence="the mass centre lies {offset_over_half_width:+.1%} of the half width off the middle (positive to +x)",
    acts={"housner": on_housner, "stacked": on_stacked},
    static_test="turn the block by 180 degrees and repeat a run",
    source="geometry; impact between unequal sides: models/housner/reference/impact.py",
)  # fmt: skip
