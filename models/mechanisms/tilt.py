"""The base leans: gravity has a part along it."""

from __future__ import annotations

import numpy as np

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block
from models.interface.layered import LayeredWall
from models.stacked.stack import Stack


def on_housner(block: Block, values: Values) -> Block:
    tilt = np.asarray(values["tilt"], float)
    return block.replace(offset=block.offset - block.gravity * np.sin(tilt), gravity=block.gravity * np.cos(tilt))


def on_stacked(stack: Stack, values: Values) -> Stack:
    tilt = np.asarray(values["tilt"], float)
    return stack.replace(offset=stack.offset - stack.gravity * np.sin(tilt), gravity=stack.gravity * np.cos(tilt))


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    tilt = np.asarray(values["tilt"], float)
    return wall.replace(offset=wall.offset - wall.gravity * np.sin(tilt), gravity=wall.gravity * np.cos(tilt))


MECHANISM = Mechanism(
    name="tilt",
    effect_class="tilt",
    parameters=(MechanismParameter("tilt", "tau", "rad", "lean of the base, positive clockwise", -0.05, 0.05),),
    equation="a -> a - g sin(tau), G -> G - g (1 - cos(tau)); a and a_z along and across the leaning base",
    signature="differs left and right; onset at unequal accelerations",
    sentence="the base leans by {tilt:+.4f} rad (clockwise positive)",
    acts={"housner": on_housner, "stacked": on_stacked, "interface": on_interface, "interface_linear": on_interface},
    static_test="put a level on the base",
    source="statics of a plane that leans",
)
