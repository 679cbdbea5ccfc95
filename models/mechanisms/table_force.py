"""A law in a table: forces, and a factor on the restitution, that no other mechanism describes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block
from models.interface.layered import LayeredWall
from models.interface.table import TABLES as ON_WALL
from models.tables import KNOTS, Tables, Term, Variable

COUPLE = "couple over the inertia"
TABLES = Tables(
    terms={
        "rotation": Term("rotation", f"{COUPLE} that depends on the rotation", "rad s-2", "base"),
        "rate": Term("rate", f"{COUPLE} that depends on the angular velocity", "rad s-2", "base"),
        "damping": Term(
            "rotation", f"{COUPLE} and the angular velocity that depends on the rotation", "s-1", "base", "rate"
        ),
        "friction": Term(
            "rotation", f"{COUPLE}, times the sign of the angular velocity, that depends on the rotation", "rad s-2",
            "base", "direction",
        ),
        "base": Term("base", f"{COUPLE} that depends on the acceleration of the base", "rad s-2", "base"),
        "base_damping": Term(
            "base", f"{COUPLE} and the angular velocity that depends on the acceleration of the base", "s-1", "base",
            "rate",
        ),
        "outward": Term(
            "rotation", f"{COUPLE} and the angular velocity, while the rotation grows, that depends on the rotation",
            "s-1", "base", "outward",
        ),
        "impact": Term(
            "rate", "change of the factor on the restitution, by the angular velocity before", "1", "base", event=True
        ),
    },
    variables={
        "rotation": Variable("coordinate", "reach_rotation", "rad", "rotation of the last rows"),
        "rate": Variable("rate", "reach_rate", "rad s-1", "angular velocity of the last rows"),
        "base": Variable("base", "reach_base", "m s-2", "acceleration of the base of the last rows"),
    },
    units=lambda block: {"base": 1.0},
    jumps=("rotation",),
    oscillator=("oscillator_motion", "oscillator_force", "oscillator_frequency", "oscillator_damping"),
)  # fmt: skip
"""Of one block."""
OSCILLATOR = (
    MechanismParameter(
        "oscillator_motion", "c_m", "1", "share of the oscillator's motion against the base that carries the block",
        -3.0, 3.0,
    ),
    MechanismParameter(
        "oscillator_force", "c_f", "1", "force on the oscillator over its mass that pushes the block, over the block's",
        -3.0, 3.0,
    ),
    MechanismParameter(
        "oscillator_frequency", "f_o", "Hz", "frequency of the oscillator", 0.2, 25.0, null=1.0, shape=True
    ),
    MechanismParameter(
        "oscillator_damping", "zeta_o", "1", "damping of the oscillator over critical", 0.005, 0.5, null=0.05,
        shape=True,
    ),
)  # fmt: skip
"""What the base drives beside the tables of one block."""


def on_housner(block: Block, values: Values) -> Block:
    columns = [values[v.reach] for v in TABLES.variables.values()] + [values[name] for name, _ in TABLES.rows]
    table = np.stack([np.broadcast_to(np.asarray(c, float), block.mass.shape) for c in columns], axis=1)
    return replace(block, table=table).replace(**{name: values[name] for name in TABLES.oscillator})


def on_interface(wall: LayeredWall, values: Values) -> LayeredWall:
    return wall.with_law_in_table(values)


def _parameters(tables: Tables) -> tuple[MechanismParameter, ...]:
    """Every value of the tables, then how far they reach."""
    rows = []
    for name, term in tables.rows:
        _, side, knot = name.rsplit("_", 2)
        one = tables.terms[term]
        rows.append(
            MechanismParameter(name, "f", one.unit, f"{one.meaning}: {side} zero, {knot} of {KNOTS - 1} reaches")
        )
    reaches = [
        MechanismParameter(v.reach, "x_r", v.unit, v.meaning, 0.0, null=1.0, shape=True)
        for v in tables.variables.values()
    ]
    return (*rows, *reaches, *(OSCILLATOR if tables.oscillator else ()))


SENTENCE = "a law in a table acts"
SOURCE = "estimated from recordings that no other mechanism explains"
MECHANISM = Mechanism(
    name="table_force",
    effect_class="open",
    parameters=_parameters(TABLES),
    equation="couple I_O [f_1(theta) + f_2(theta') + f_3(theta) theta' + f_4(theta) sign theta' + f_5(a) "
    "+ f_6(a) theta' + f_7(theta) sign theta <theta' sign theta>], e times 1 + f_8(theta'); <x> = max(x, 0), f linear "
    "between rows, constant beyond the last; a -> a + c_m u'' + c_f (u'' + a), u an oscillator that the base drives",
    signature="wherever it was found",
    sentence=SENTENCE,
    acts={"housner": on_housner},
    source=SOURCE,
    tabulated=TABLES,
)
OF_WALL = Mechanism(
    name="table_force",
    effect_class="open",
    parameters=_parameters(ON_WALL),
    equation="couples M g b [f_1(r) + f_2(r') + f_3(r) r' + f_4(r) s(r')] in the base (r = theta1) and in the top "
    "joint (r = theta2 - theta1, m2 g bt), force m2 g [f_1(x) + f_2(x') + f_3(a)] on the block; f linear between rows, "
    "constant beyond the last, without a jump at zero; s = r' over .02 of the reach of r', within -1 and 1",
    signature="wherever it was found",
    sentence=SENTENCE,
    acts={"interface": on_interface},
    source=SOURCE,
    tabulated=ON_WALL,
)
