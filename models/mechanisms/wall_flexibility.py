"""The wall bends: its first cantilever mode rides on the rocking block."""

from __future__ import annotations

import numpy as np

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block


def on_housner(block: Block, values: Values) -> Block:
    return block.replace(first_frequency=values["first_frequency"])


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
