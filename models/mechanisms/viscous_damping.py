"""A dashpot acts on the rotation."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block
from models.interface.layered import LayeredWall
from models.stacked.stack import Stack


def on_housner(block: Block, values: Values) -> Block:
    return block.replace(viscous=values["rate"])


def on_stacked(stack: Stack, values: Values) -> Stack:
    return stack.replace(viscous=stack.viscous + values["rate"])


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    return wall.with_effect("viscous_damping", couple_damping=values["couple_damping"])


OF_WALL = Mechanism(
    name="viscous_damping",
    effect_class="viscous_damping",
    parameters=(
        MechanismParameter("couple_damping", "c_c", "N m s", "couple on the wall per angular velocity", 0.0, 5e5),
    ),
    equation="couple -c_c theta1'",
    signature="with theta1', beyond what the layers' dashpots explain",
    sentence="a dashpot of {couple_damping:.3g} N m s acts on the wall's rotation",
    acts={"interface": on_interface},
    static_test="let the wall rock freely from several held rotations",
    source="linear viscous couple",
)
MECHANISM = Mechanism(
    name="viscous_damping",
    effect_class="viscous_damping",
    parameters=(MechanismParameter("rate", "d", "s-1", "dashpot couple over the inertia about the corner", 0.0, 1.0),),
    equation="couple -d I_O theta'",
    signature="between impacts, with theta'",
    sentence="a dashpot takes {rate:.3f} of the angular velocity per second",
    acts={"housner": on_housner, "stacked": on_stacked},
    static_test="let the block rock freely from several held rotations",
    source="linear viscous couple",
)
