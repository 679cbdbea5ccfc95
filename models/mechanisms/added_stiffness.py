"""A spring turns the block back (or away): a tie, a fill, a stop."""

from __future__ import annotations

import numpy as np

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block


def on_housner(block: Block, values: Values) -> Block:
    radius = np.hypot(block.base_half_width, block.height)
    return block.replace(stiffness=values["over_m_g_R"] * block.mass * block.gravity * radius, gap=values["gap"])


MECHANISM = Mechanism(
    name="added_stiffness",
    effect_class="added_stiffness",
    parameters=(
        MechanismParameter("over_m_g_R", "k", "1", "rotational stiffness over M g R", -0.5, 0.5),
        MechanismParameter("gap", "theta_g", "rad", "rotation beyond which the spring acts", 0.0, 0.5, shape=True),
    ),
    equation="couple -k M g R max(0, |theta| - gap) sign(theta)",
    signature="at large rotations, between impacts",
    sentence="a spring of {over_m_g_R:+.3f} M g R per radian acts beyond {gap:.4f} rad",
    acts={"housner": on_housner},
    static_test="push the block over slowly and read force over rotation",
    source="Makris, Vassiliou (Earthquake Engng Struct. Dyn. 44, 2015), vertically restrained blocks",
)
