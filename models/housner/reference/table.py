"""A law in a table, read plainly: linear between rows, constant beyond the last, a jump at zero allowed."""

from __future__ import annotations

import math

import numpy as np

from models.base import FloatArray
from models.housner.block import REACHES

TERMS, KNOTS = 8, 6


class LawInTable:
    """The law of one lane; ``columns`` as in `Block.table`: reaches of rotation, rate, base, then the tables."""

    def __init__(self, columns: FloatArray) -> None:
        self.reach = columns[:REACHES]
        self.values = columns[REACHES:].reshape(TERMS, 2, KNOTS)

    def _at(self, term: int, variable: int, x: float, side: float) -> float:
        rows = self.values[term, 1 if side > 0.0 else 0]
        return float(
            np.interp(max(0.0, math.copysign(1.0, side) * x), np.linspace(0.0, self.reach[variable], KNOTS), rows)
        )

    def acceleration(self, theta: float, rate: float, base: float, side: float, direction: float) -> float:
        """Angular acceleration (rad s-2); ``side`` and ``direction`` are the signs of theta and theta'."""
        push = math.copysign(1.0, base)
        at_rotation, at_rate, at_base = (
            self._at(0, 0, theta, side),
            self._at(1, 1, rate, direction),
            self._at(4, 2, base, push),
        )
        damping = self._at(2, 0, theta, side) + self._at(5, 2, base, push)
        outward = self._at(6, 0, theta, side) * (rate if side * rate > 0.0 else 0.0)
        return at_rotation + at_rate + at_base + damping * rate + self._at(3, 0, theta, side) * direction + outward

    def at_impact(self, rate: float) -> float:
        """Change of the factor on the restitution for the rate before (rad s-1)."""
        return self._at(7, 1, rate, rate)
