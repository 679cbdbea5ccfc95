"""The body rocks on points inside its corners."""

from __future__ import annotations

import numpy as np

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block
from models.interface.layered import LayeredWall
from models.stacked.stack import Stack, at_joint


def on_housner(block: Block, values: Values) -> Block:
    inset = values["inset_over_half_width"]
    shift = inset * block.base_half_width
    return block.replace(right=block.right - shift, left=block.left - shift, aspect=block.aspect * (1.0 - inset))


def on_stacked(stack: Stack, values: Values) -> Stack:
    return stack.replace(
        base_pivot=stack.base_pivot * (1.0 - at_joint(values, "inset_over_half_width", "base")),
        top_pivot=stack.top_pivot * (1.0 - at_joint(values, "inset_over_half_width", "top")),
    )


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    """The base strip is shorter at unchanged stiffness per metre."""
    return wall.replace(base_half_width=wall.base_half_width * (1.0 - np.asarray(values["inset_over_half_width"])))


MECHANISM = Mechanism(
    name="pivot_inset",
    effect_class="contact_geometry",
    parameters=(
        MechanismParameter(
            "inset_over_half_width", "inset", "1", "shift of both pivots inwards over the half width", 0.0, 0.35
        ),
    ),
    equation="b' = (1 - inset) b; alpha, R, I_O, the onset and e follow",
    signature="all rocking at constant sign of theta; the onset comes earlier",
    sentence="the block rocks on points {inset_over_half_width:.1%} of the half width inside its corners",
    acts={"housner": on_housner, "stacked": on_stacked, "interface": on_interface, "interface_linear": on_interface},
    at_joints=("stacked",),
    static_test="push the block over slowly and read the force at which it lifts",
    source="Mordant, Denoel, Degee (COMPDYN 2015), section 2.1",
)
