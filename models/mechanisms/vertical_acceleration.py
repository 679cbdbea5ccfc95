"""The vertical motion of the base acts, though the base model leaves it out."""

from __future__ import annotations

import numpy as np

from models.base import Mechanism, MechanismParameter, Values
from models.errors import InputError
from models.housner.block import Block
from models.interface.layered import LayeredWall
from models.stacked.stack import Stack


def _acting(model: Block | LayeredWall | Stack, values: Values) -> bool:
    """Whether it acts; an error where the base model takes the vertical motion already."""
    if np.all(np.asarray(values["kappa"]) == 0.0):
        return False
    if np.any(model.vertical_factor != 0.0):
        raise InputError(
            "vertical_acceleration.kappa stands for a vertical motion that the base model leaves out, but it "
            "acts already; set [motion] vertical = false or leave the mechanism out"
        )
    return True


def on_housner(block: Block, values: Values) -> Block:
    return block.replace(vertical_factor=values["kappa"]) if _acting(block, values) else block


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    return wall.replace(vertical_factor=values["kappa"]) if _acting(wall, values) else wall


def on_stacked(stack: Stack, values: Values) -> Stack:
    return stack.replace(vertical_factor=values["kappa"]) if _acting(stack, values) else stack


MECHANISM = Mechanism(
    name="vertical_acceleration",
    effect_class="vertical_acceleration",
    parameters=(
        MechanismParameter("kappa", "kappa", "1", "share of the measured vertical acceleration that acts", 0.0, 1.5),
    ),
    equation="G = g (1 + kappa a_z/g) in place of g",
    signature="between impacts at constant sign of theta, coherent with the vertical acceleration",
    sentence="{kappa:.2f} times the measured vertical acceleration acts on the block",
    acts={
        "housner": on_housner, "stacked": on_stacked, "interface": on_interface, "interface_linear": on_interface,
    },
    static_test="repeat a run without vertical shaking",
    source="Yim, Chopra, Penzien (Earthquake Engng Struct. Dyn. 8, 1980)",
)  # fmt: skip
