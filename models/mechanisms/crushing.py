"""The corners crush: the pivots move inwards with the largest rotation so far."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block


def on_housner(block: Block, values: Values) -> Block:
    return block.replace(crushing_rate=values["inset_per_rotation"])


MECHANISM = Mechanism(
    name="crushing",
    effect_class="contact_geometry",
    parameters=(
        MechanismParameter(
            "inset_per_rotation", "inset/theta", "rad-1", "inset over the half width per largest rotation so far",
            0.0, 5.0,
        ),
    ),
    equation="b' = b [1 - min(.35, inset_per_rotation max|theta|)]",
    signature="grows with time and record, at constant sign of theta",
    sentence="the corners crush: the pivots have moved inwards by {inset_per_rotation:.2f} of the half width per "
    "radian of the largest rotation",
    acts={"housner": on_housner},
    static_test="inspect the corners and push the block over slowly before and after a run",
    source="form of this project; the inset stays under .35 of the half width",
)  # fmt: skip
