"""A spring turns the block back (or away): a tie, a fill, a stop."""

from __future__ import annotations

import numpy as np

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block
from models.interface.layered import LayeredWall


def on_housner(block: Block, values: Values) -> Block:
    radius = np.hypot(block.base_half_width, block.height)
    return block.replace(stiffness=values["over_m_g_R"] * block.mass * block.gravity * radius, gap=values["gap"])


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    return wall.with_effect("added_stiffness", couple_stiffness=values["couple_stiffness"], couple_gap=values["gap"])


GAP = MechanismParameter("gap", "theta_g", "rad", "rotation beyond which the spring acts", 0.0, 0.5, shape=True)
OF_WALL = Mechanism(
    name="added_stiffness",
    effect_class="added_stiffness",
    parameters=(
        MechanismParameter("couple_stiffness", "k_c", "N m", "couple on the wall per radian", -5e6, 5e6),
        GAP,
    ),
    equation="couple -k_c max(0, |theta1| - gap) sign(theta1)",
    signature="at large rotations; with a gap nowhere else",
    sentence="a spring of {couple_stiffness:+.3g} N m per radian acts on the wall beyond {gap:.4f} rad",
    acts={"interface": on_interface},
    static_test="push the wall over slowly and read force over rotation",
    source="Makris, Vassiliou (Earthquake Engng Struct. Dyn. 44, 2015), vertically restrained blocks",
)
MECHANISM = Mechanism(
    name="added_stiffness",
    effect_class="added_stiffness",
    parameters=(
        MechanismParameter("over_m_g_R", "k", "1", "rotational stiffness over M g R", -0.5, 0.5),
        GAP,
    ),
    equation="couple -k M g R max(0, |theta| - gap) sign(theta)",
    signature="at large rotations, between impacts",
    sentence="a spring of {over_m_g_R:+.3f} M g R per radian acts beyond {gap:.4f} rad",
    acts={"housner": on_housner},
    static_test="push the block over slowly and read force over rotation",
    source="Makris, Vassiliou (Earthquake Engng Struct. Dyn. 44, 2015), vertically restrained blocks",
)
