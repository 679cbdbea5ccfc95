"""Dry friction acts on the rotation."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block
from models.interface.layered import LayeredWall
from models.stacked.stack import Stack


def on_housner(block: Block, values: Values) -> Block:
    return block.replace(coulomb=values["over_m_g_b"] * block.mass * block.gravity * block.base_half_width)


def on_stacked(stack: Stack, values: Values) -> Stack:
    return stack.replace(coulomb=values["over_m_g_b"] * stack.mass * stack.gravity * stack.half_length_1)


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    couple = values["over_m_g_b"] * wall.mass * wall.gravity * wall.base_half_width
    return wall.with_effect("coulomb_damping", dry_couple=couple)


MECHANISM = Mechanism(
    name="coulomb_damping",
    effect_class="coulomb_damping",
    parameters=(MechanismParameter("over_m_g_b", "m_c", "1", "couple of dry friction over M g b", 0.0, 0.1),),
    equation="couple -m_c M g b sign(theta'); it holds the block where it stops as long as it can",
    signature="between impacts, with the sign of theta'",
    sentence="dry friction of {over_m_g_b:.4f} M g b acts against the rotation",
    acts={"housner": on_housner, "stacked": on_stacked, "interface": on_interface},
    static_test="let the block rock freely and follow the last small swings",
    source="Coulomb's law on a couple",
)
