"""Wear: restitution falls from impact to impact, the rubber softens from cycle to cycle."""

from __future__ import annotations

from functools import partial

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block
from models.interface.layered import LayeredWall
from models.rubber.base import with_law


def on_housner(block: Block, values: Values) -> Block:
    return block.replace(loss_per_impact=values["loss_of_restitution_per_impact"], restitution_floor=values["floor"])


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    return wall.with_effect("degradation", final_loss=values["final_loss"], loss_cycles=values["cycles"])


OF_RUBBER = Mechanism(
    name="degradation",
    effect_class="degradation",
    parameters=(
        MechanismParameter("final_loss", "l_k", "1", "share of the stiffness lost at last", 0.0, 0.7),
        MechanismParameter("cycles", "n_k", "1", "cycles over which it is lost", 2.0, 50.0, null=10.0, shape=True),
    ),
    equation="k [1 - final_loss (1 - exp(-n/cycles))], after n full cycles of bearings; of the base of a wall after n "
    "uplifts (contact share under .9) closed again (over .98)",
    signature="grows with time and record",
    sentence="the rubber loses {final_loss:.1%} of its stiffness, over {cycles:.0f} cycles",
    acts={"isolated": partial(with_law, name="degradation"), "interface": on_interface},
    static_test="repeat a run and compare",
    source="form of this project: models/isolated/bearing.py, models/interface/effects.py",
)


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
    static_test="repeat a run and compare",
    source="form of this project",
)
