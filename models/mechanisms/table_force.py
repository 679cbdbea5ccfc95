"""A law in a table: a couple, and a factor on the restitution, that no other mechanism describes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block

TERMS = {
    "rotation": ("rotation", "couple over the inertia that depends on the rotation", "rad s-2"),
    "rate": ("rate", "couple over the inertia that depends on the angular velocity", "rad s-2"),
    "damping": ("rotation", "couple over the inertia and the angular velocity that depends on the rotation", "s-1"),
    "friction": (
        "rotation", "couple over the inertia, times the sign of the angular velocity, that depends on the rotation",
        "rad s-2",
    ),
    "base": ("base", "couple over the inertia that depends on the acceleration of the base", "rad s-2"),
    "base_damping": (
        "base", "couple over the inertia and the angular velocity that depends on the acceleration of the base", "s-1",
    ),
    "impact": ("rate", "change of the factor on the restitution, by the angular velocity before", "1"),
}  # fmt: skip
"""By term: the variable of its table, what it is, the unit of its values."""
FACTORS = {"damping": "rate", "base_damping": "rate", "friction": "direction"}
"""By term, what its table is times of: the angular velocity, or its sign; of no other term anything."""
REACHES = {
    "rotation": ("reach_rotation", "rad", "rotation of the last rows"),
    "rate": ("reach_rate", "rad s-1", "angular velocity of the last rows"),
    "base": ("reach_base", "m s-2", "acceleration of the base of the last rows"),
}
SIDES = ("below", "above")
KNOTS = 6
"""Rows on either side of zero, from zero to the reach; a table may jump at zero."""


def row(term: str, side: str, knot: int) -> str:
    """Name of the parameter that holds one value of a table."""
    return f"{term}_{side}_{knot}"


ROWS = tuple(row(term, side, knot) for term in TERMS for side in SIDES for knot in range(KNOTS))


def on_housner(block: Block, values: Values) -> Block:
    columns = [values[name] for name, _, _ in REACHES.values()] + [values[name] for name in ROWS]
    table = np.stack([np.broadcast_to(np.asarray(c, float), block.mass.shape) for c in columns], axis=1)
    return replace(block, table=table)


MECHANISM = Mechanism(
    name="table_force",
    effect_class="open",
    parameters=(
        *(
            MechanismParameter(row(term, side, knot), "f", unit, f"{what}: {side} zero, {knot} of {KNOTS - 1} reaches")
            for term, (_, what, unit) in TERMS.items()
            for side in SIDES
            for knot in range(KNOTS)
        ),
        *(
            MechanismParameter(name, "x_r", unit, what, 0.0, null=1.0, shape=True)
            for name, unit, what in REACHES.values()
        ),
    ),
    equation="couple I_O [f_1(theta) + f_2(theta') + f_3(theta) theta' + f_4(theta) sign theta' + f_5(a) "
    "+ f_6(a) theta'], e times 1 + f_7(theta'); f linear between rows, constant beyond the last",
    signature="wherever it was found",
    sentence="a law in a table acts",
    acts={"housner": on_housner},
    source="estimated from recordings that no other mechanism explains",
    tabulated=True,
)  # fmt: skip
