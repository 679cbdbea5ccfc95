"""The contact wears: restitution falls from impact to impact."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block


def on_housner(block: Block, values: Values) -> Block:
    return block.replace(loss_per_impact=values["loss_of_restitution_per_impact"], restitution_floor=values["floor"])


MECHANISM = Mechanism(
    name="degradation",
    effect_class="degradation",
    parameters=(
        MechanismParameter("loss_of_restitution_per_impact", "l_n", "1", "share of e lost at each impact", 0.0, 0.03),
        MechanismParameter("floor", "l_min", "1", "share of e that is left at last", 0.5, 1.0, null=0.5, shape=True),
    ),
    equation="e = e_H max(floor, 1 - l_n n) after n impacts",
    signature="grows with time and record, at impacts",
    sentence="each impact takes {loss_of_restitution_per_impact:.2%} of the restitution, down to {floor:.2f} of it",
    acts={"housner": on_housner},
    source="form of this project",
)
