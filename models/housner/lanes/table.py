"""A law in a table in the kernel: sums of hat functions, without branches; compiled in for integer ``general`` only.

A table has KNOTS values from zero to its reach on either side of zero, may jump there, and is constant beyond.
Columns of a lane: one over the spacing of rotation, rate and base acceleration, then the terms in the order of
`models.mechanisms.table_force.TERMS`, the values below zero first.
"""

from __future__ import annotations

from typing import Any

from numba import types

from models.lanes.arrays import Table
from models.lanes.compiler import in_kernels, inlined

KNOTS = 6
SPACINGS = 3
LAST = float(KNOTS - 1)
LENGTH = 2 * KNOTS
TERMS = 8
ROTATION, RATE, DAMPING, FRICTION, BASE, BASE_DAMPING, OUTWARD, IMPACT = range(
    SPACINGS, SPACINGS + TERMS * LENGTH, LENGTH
)
N_TABLE = SPACINGS + TERMS * LENGTH


@inlined
def of_work(w: Table, first: int, at: int, slot: int, x: float, side: float) -> float:
    """Value at ``x`` (in spacings, on ``side`` of zero) of the table whose rows start at ``first + at`` of ``work``."""
    size = min(max(side * x, 0.0), LAST)
    below, above = 0.0, 0.0
    for k in range(KNOTS):
        hat = max(0.0, 1.0 - abs(size - k))
        below += hat * w[first + at + k, slot]
        above += hat * w[first + at + KNOTS + k, slot]
    return above if side > 0.0 else below


@inlined
def of_given(given: Table, first: int, at: int, lane: int, x: float) -> float:
    """The same from a line of ``given``."""
    size = min(abs(x), LAST)
    start = first + at + (KNOTS if x > 0.0 else 0)
    value = 0.0
    for k in range(KNOTS):
        value += max(0.0, 1.0 - abs(size - k)) * given[lane, start + k]
    return value


@inlined
def _acting(
    w: Table, first: int, slot: int, theta: float, omega: float, a: float, side: float, direction: float
) -> float:
    x, y = theta * w[first, slot], a * w[first + 2, slot]
    push = 1.0 if a > 0.0 else -1.0
    return (
        of_work(w, first, ROTATION, slot, x, side)
        + of_work(w, first, RATE, slot, omega * w[first + 1, slot], direction)
        + of_work(w, first, DAMPING, slot, x, side) * omega
        + of_work(w, first, FRICTION, slot, x, side) * direction
        + of_work(w, first, BASE, slot, y, push)
        + of_work(w, first, BASE_DAMPING, slot, y, push) * omega
        + of_work(w, first, OUTWARD, slot, x, side) * side * max(side * omega, 0.0)
    )


def table_acceleration(
    w: Table, first: int, slot: int, theta: float, omega: float, a: float, side: float, direction: float, general: Any
) -> float:
    """Angular acceleration (rad s-2) of the law in the rows from ``first`` on; 0 where ``general`` knows none.

    ``side`` and ``direction`` are the signs of theta and theta'.
    """
    return _acting(w, first, slot, theta, omega, a, side, direction)


def _choose(w, first, slot, theta, omega, a, side, direction, general):  # type: ignore[no-untyped-def]
    if isinstance(general, types.Integer):
        return lambda w, first, slot, theta, omega, a, side, direction, general: _acting(
            w, first, slot, theta, omega, a, side, direction
        )
    return lambda w, first, slot, theta, omega, a, side, direction, general: 0.0


in_kernels(table_acceleration, _choose)
