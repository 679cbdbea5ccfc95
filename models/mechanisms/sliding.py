"""The corner on which the block stands slides when friction cannot hold it."""

from __future__ import annotations

import numpy as np

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block
from models.interface.layered import LayeredWall


def on_housner(block: Block, values: Values) -> Block:
    return block.replace(friction=values["friction"])


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    return wall.with_effect("sliding", friction=values["friction"])


MECHANISM = Mechanism(
    name="sliding",
    effect_class="sliding",
    parameters=(
        MechanismParameter(
            "friction", "mu", "1", "Coulomb friction at the base", 0.03, 1.5, null=np.inf, fit_inverse=True
        ),
    ),
    equation="|H| <= mu N; while the contact slips with velocity u', H = -mu N sign(u')",
    signature="only where the friction demand |H|/N exceeds mu",
    sentence="the block slides on its base at a friction coefficient of {friction:.3f}",
    acts={"housner": on_housner, "interface": on_interface},
    static_test="mark the base before a run and look for a shift after it",
    source="Shenton (J. Eng. Mech. 122, 1996); law at impacts: models/housner/reference/slip.py",
)
