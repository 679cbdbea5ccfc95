"""A law in a table on a wall: couples in both joints and a force along the base on the block, of any form.

With r the angle of a joint (theta1; theta2 - thetam) and x the block's displacement along the base, a its acceleration,

    C_b = M g b1 [f_1(theta1) + f_2(theta1') + f_3(theta1) theta1' + f_4(theta1) s(theta1')],   C_t alike with m2 g bt,
    F = m2 g [f_1(x) + f_2(x') + f_3(a)],      s(r') = r' over SLOW of the reach of r', within -1 and 1.

Both sides of a table meet at zero in the mean of their values there: a step of the lanes' rule cannot resolve a jump.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from models.tables import KNOTS, SIDES, Tables, Term, Variable, row

SLOW = 0.02
"""Share of the reach of a joint's angular velocity over which friction changes its sign."""


def _couple(joint: str, where: str, over: str) -> dict[str, Term]:
    couple = f"couple {where} over {over}"
    rotation, rate = f"rotation_{joint}", f"rate_{joint}"
    return {
        rotation: Term(rotation, f"{couple} that depends on the joint's rotation", "1", joint),
        rate: Term(rate, f"{couple} that depends on the joint's angular velocity", "1", joint),
        f"damping_{joint}": Term(
            rotation, f"{couple} and the joint's angular velocity that depends on its rotation", "s", joint, "rate"
        ),
        f"friction_{joint}": Term(
            rotation, f"{couple}, times the sign of the joint's angular velocity, that depends on its rotation", "1",
            joint, "direction",
        ),
    }  # fmt: skip


def units(wall: Any) -> dict[str, Any]:
    """M g b1 and m2 g bt (N m), m2 g (N): what the values of the tables are shares of, by port."""
    block = wall.mass_2 * wall.gravity
    return {
        "base": wall.mass * wall.gravity * wall.base_half_width, "top": block * wall.top_half_width, "block": block,
    }  # fmt: skip


FORCE = "force along the base on the block over m2 g"
TABLES = Tables(
    terms={
        **_couple("base", "in the base", "M g b"),
        **_couple("top", "in the top joint", "m2 g bt"),
        "displacement_block": Term("displacement_block", f"{FORCE} that depends on its displacement", "1", "block"),
        "velocity_block": Term("velocity_block", f"{FORCE} that depends on its velocity", "1", "block"),
        "push_block": Term("base", f"{FORCE} that depends on the acceleration of the base", "1", "block"),
    },
    variables={
        "rotation_base": Variable("coordinate", "reach_rotation_base", "rad", "rotation of the wall, last rows"),
        "rate_base": Variable("rate", "reach_rate_base", "rad s-1", "angular velocity of the wall, last rows"),
        "rotation_top": Variable("coordinate", "reach_rotation_top", "rad", "rotation of the top joint, last rows"),
        "rate_top": Variable("rate", "reach_rate_top", "rad s-1", "angular velocity of the top joint, last rows"),
        "displacement_block": Variable("coordinate", "reach_displacement", "m", "displacement of the last rows"),
        "velocity_block": Variable("rate", "reach_velocity", "m s-1", "velocity of the last rows"),
        "base": Variable("base", "reach_base", "m s-2", "acceleration of the base of the last rows"),
    },
    units=units,
)  # fmt: skip
"""Of a wall between two layers."""
ONE_LINE = 2 * KNOTS - 1


def merged(law: Mapping[str, Any], term: str) -> list[Any]:
    """The values of a table from the reach below zero to that above, one at zero."""
    below, above = ([law[row(term, side, k)] for k in range(KNOTS)] for side in SIDES)
    return [*below[:0:-1], 0.5 * (below[0] + above[0]), *above[1:]]


class LawInTable:
    """The law of one wall with plain floats in its fields, or of n whose arrays broadcast to what it is asked of."""

    def __init__(self, wall: Any) -> None:
        self.law: Mapping[str, Any] = wall.effects.law
        self.units, law = units(wall), self.law
        self.tables = {term: np.array(np.broadcast_arrays(*merged(law, term))) for term in TABLES.terms}
        self.acting = {term for term, values in self.tables.items() if np.any(values)}

    def _at(self, term: str, x: Any) -> Any:
        """Value of a term's table at x."""
        if term not in self.acting:
            return 0.0
        last = KNOTS - 1
        place = np.clip(x * last / self.law[TABLES.variable(term).reach], -last, last)
        return sum(np.maximum(0.0, 1.0 - np.abs(place + last - k)) * value for k, value in enumerate(self.tables[term]))

    def _couple(self, joint: str, turn: Any, rate: Any) -> Any:
        slow = SLOW * self.law[TABLES.variables[f"rate_{joint}"].reach]
        return (
            self._at(f"rotation_{joint}", turn)
            + self._at(f"rate_{joint}", rate)
            + self._at(f"damping_{joint}", turn) * rate
            + self._at(f"friction_{joint}", turn) * np.clip(rate / slow, -1.0, 1.0)
        )

    def forces(
        self, base: tuple[Any, Any], top: tuple[Any, Any], block: tuple[Any, Any], acceleration: Any
    ) -> tuple[Any, Any, Any]:
        """Couples (N m) in the base and in the top joint, force (N) on the block; of each its coordinate and rate."""
        push = (
            self._at("displacement_block", block[0])
            + self._at("velocity_block", block[1])
            + self._at("push_block", acceleration)
        )
        return (
            self.units["base"] * self._couple("base", *base),
            self.units["top"] * self._couple("top", *top),
            self.units["block"] * push,
        )
