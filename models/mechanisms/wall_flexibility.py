"""The wall bends: its first cantilever mode rides on the rocking block."""

from __future__ import annotations

import numpy as np

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block
from models.interface.layered import LayeredWall


def on_housner(block: Block, values: Values) -> Block:
    return block.replace(first_frequency=values["first_frequency"])


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    return wall.with_effect("wall_flexibility", bending=values["flexural_stiffness_ratio"])


OF_TWO_HALVES = Mechanism(
    name="wall_flexibility",
    effect_class="wall_flexibility",
    parameters=(
        MechanismParameter(
            "flexural_stiffness_ratio", "r_f", "1", "stiffness of the cut at mid height over that of the base layer",
            1.0, 100.0, null=np.inf, fit_inverse=True,
        ),
    ),
    equation="the wall cut at mid height: couple (2/3) r_f k b1^3 (thetam - theta1), axial force 2 r_f k b1 zm",
    signature="above 10 Hz after closings; a softer, earlier first uplift",
    sentence="the wall bends: cut at mid height it is {flexural_stiffness_ratio:.1f} times as stiff as its base layer",
    acts={"interface": on_interface},
    static_test="tap the standing wall and read its frequencies",
    source="form of this project: models/interface/chain.py",
)  # fmt: skip


MECHANISM = Mechanism(
    name="wall_flexibility",
    effect_class="wall_flexibility",
    parameters=(
        MechanismParameter(
            "first_frequency", "f_1", "Hz", "first frequency of the wall clamped at its base", 3.0, 100.0,
            null=np.inf, fit_inverse=True, stiff=True,
        ),
    ),
    equation="Lagrange's equations of theta and of the mode's amplitude: models/housner/reference/flexure.py",
    signature="above 10 Hz after impacts; a softer, earlier first uplift",
    sentence="the wall bends with a first frequency of {first_frequency:.1f} Hz and rings after impacts",
    acts={"housner": on_housner},
    static_test="tap the standing wall and read its first frequency",
    source="Acikgoz, DeJong (Earthquake Engng Struct. Dyn. 41, 2012) for the interplay; shape of a uniform cantilever",
)  # fmt: skip
