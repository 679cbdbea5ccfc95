"""Drag grows with the square of the angular velocity."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block


def on_housner(block: Block, values: Values) -> Block:
    return block.replace(quadratic=values["coefficient"])


MECHANISM = Mechanism(
    name="quadratic_damping",
    effect_class="quadratic_damping",
    parameters=(MechanismParameter("coefficient", "q", "1", "drag couple over I_O theta'^2", 0.0, 5.0),),
    equation="couple -q I_O theta' |theta'|",
    signature="between impacts, with theta' |theta'|",
    sentence="drag grows with the square of the angular velocity, coefficient {coefficient:.3f}",
    acts={"housner": on_housner},
    static_test="let the block rock freely from several held rotations",
    source="turbulent drag on a turning body",
)
