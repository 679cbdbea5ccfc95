"""The landing corner bounces off the base."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block


def on_housner(block: Block, values: Values) -> Block:
    return block.replace(contact_restitution=values["contact_restitution"])


MECHANISM = Mechanism(
    name="bounce",
    effect_class="bounce",
    parameters=(
        MechanismParameter(
            "contact_restitution", "c", "1", "vertical velocity of the landing corner, after over before", 0.0, 0.6
        ),
    ),
    equation="the corner leaves with (b+ + b-) c |theta'|, theta'_after = [e - c (1 - e)] theta'_before, then free "
    "flight until a corner lands again",
    signature="only at impacts; constant theta' for a while after them",
    sentence="the landing corner bounces with {contact_restitution:.3f} of its vertical velocity",
    acts={"housner": on_housner},
    static_test="film an impact, or add a vertical accelerometer at a corner",
    source="rigid-body impact without slip; landings: models/housner/reference/flight.py",
)
