"""Faster impacts lose a larger share."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block


def on_housner(block: Block, values: Values) -> Block:
    return block.replace(velocity_slope=values["beta"])


MECHANISM = Mechanism(
    name="velocity_restitution",
    effect_class="velocity_restitution",
    parameters=(MechanismParameter("beta", "beta", "1", "loss of restitution per |theta'|/(p alpha)", -0.2, 0.5),),
    equation="e = e_H (1 - beta |theta'|/(p alpha))",
    signature="only at impacts, more at fast ones",
    sentence="impacts lose more the faster they are: e falls by {beta:.3f} of itself at |theta'| = p alpha",
    acts={"housner": on_housner},
    static_test="let the block rock freely from several held rotations",
    source="form of this project, linear in the dimensionless velocity",
)
