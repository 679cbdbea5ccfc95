"""Exact motion within one configuration: propagators of a step and of its halves, and the Taylor series.

x' = F x + b_a a + b_G G with a and G linear in time. Over a step t, from the inputs (a, a', G, G') at its
start, x(t) = [exp(F t) | g0 | g1 | ...] (x, a, a', G, G'). The smallest step, so short that |F| t is at most
`NORM`, is summed as a Taylor series to rounding; twice a step is the step after the step.
"""

from __future__ import annotations

from models.interface_linear.equation import ACCELERATION, WATCH
from models.interface_linear.lanes.rows import A_SLOPE, ACC, G_SLOPE, RATE, A, G
from models.lanes.arrays import Table
from models.lanes.compiler import called, inlined

ORDER = 14
NORM = 0.5
"""0.5^15/15! = 2e-17: the series' remainder is below rounding."""
COLUMNS = 12
LOADS = 8
"""Columns of a propagator: q, q', then a, a', G, G'."""


@inlined
def read(system: Table, c: int, x: Table, reading: Table) -> None:
    """q'', the watched values and their rates of a state."""
    # taken out of the array first: the loops over rows become vector code
    q0, q1, q2, q3, v0, v1, v2, v3, a, g = x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7], x[A], x[G]
    for row in range(8):
        by_place = system[c, 0, row] * q0 + system[c, 1, row] * q1 + system[c, 2, row] * q2 + system[c, 3, row] * q3
        by_rate = system[c, 4, row] * v0 + system[c, 5, row] * v1 + system[c, 6, row] * v2 + system[c, 7, row] * v3
        reading[row] = by_place + by_rate + (system[c, 8, row] * a + system[c, 9, row] * g)
    a, g = x[A_SLOPE], x[G_SLOPE]
    f0, f1, f2, f3 = reading[ACC], reading[ACC + 1], reading[ACC + 2], reading[ACC + 3]
    for row in range(WATCH, WATCH + 4):
        by_rate = system[c, 0, row] * v0 + system[c, 1, row] * v1 + system[c, 2, row] * v2 + system[c, 3, row] * v3
        by_force = system[c, 4, row] * f0 + system[c, 5, row] * f1 + system[c, 6, row] * f2 + system[c, 7, row] * f3
        reading[RATE - WATCH + row] = by_rate + by_force + (system[c, 8, row] * a + system[c, 9, row] * g)


@inlined
def step(table: Table, c: int, level: int, x: Table, length: float, to: Table) -> None:
    """The state ``to`` at the end of a step of ``level``, ``length`` (s), from x."""
    q0, q1, q2, q3, v0, v1, v2, v3 = x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7]
    a, a_slope, g, g_slope = x[A], x[A_SLOPE], x[G], x[G_SLOPE]
    for row in range(8):
        by_place = (
            table[c, level, 0, row] * q0
            + table[c, level, 1, row] * q1
            + table[c, level, 2, row] * q2
            + table[c, level, 3, row] * q3
        )
        by_rate = (
            table[c, level, 4, row] * v0
            + table[c, level, 5, row] * v1
            + table[c, level, 6, row] * v2
            + table[c, level, 7, row] * v3
        )
        to[row] = (
            by_place
            + by_rate
            + (
                table[c, level, 8, row] * a
                + table[c, level, 9, row] * a_slope
                + table[c, level, 10, row] * g
                + table[c, level, 11, row] * g_slope
            )
        )
    to[A], to[A_SLOPE], to[G], to[G_SLOPE] = a + length * a_slope, a_slope, g + length * g_slope, g_slope


@called
def build(table: Table, system: Table, c: int, levels: int, unit: float, now: Table, then: Table) -> None:
    """Propagators of configuration c: ``table[c, l]`` (12, 8) over 2^(levels - l) units, for l = 0 ... levels.

    ``unit`` (s) is the smallest step; ``now``, ``then`` (12, 8) are scratch.
    """
    finest = table[c, levels]
    for k in range(COLUMNS):
        for row in range(8):
            now[k, row] = 1.0 if k == row else 0.0
            finest[k, row] = now[k, row]
    for order in range(1, ORDER + 1):
        scale = unit / order
        for k in range(COLUMNS):
            for row in range(4):
                then[k, row] = scale * now[k, 4 + row]
                force = 0.0
                for j in range(8):
                    force += system[c, j, ACCELERATION + row] * now[k, j]
                then[k, 4 + row] = scale * force
        if order <= 2:
            # the input itself drives the first order, its slope the second
            for row in range(4):
                length = unit if order == 1 else 0.5 * unit * unit
                then[LOADS + order - 1, 4 + row] = length * system[c, 8, ACCELERATION + row]
                then[LOADS + order + 1, 4 + row] = length * system[c, 9, ACCELERATION + row]
        for k in range(COLUMNS):
            for row in range(8):
                now[k, row] = then[k, row]
                finest[k, row] += then[k, row]
    length = unit
    for level in range(levels, 0, -1):
        half, whole = table[c, level], table[c, level - 1]
        for k in range(COLUMNS):
            for row in range(8):
                whole[k, row] = 0.0
            for j in range(8):
                for row in range(8):
                    whole[k, row] += half[j, row] * half[k, j]
        # during the second half the inputs have grown
        for k in (LOADS, LOADS + 2):
            for row in range(8):
                whole[k, row] += half[k, row]
                whole[k + 1, row] += half[k + 1, row] + length * half[k, row]
        length *= 2.0


@called
def series(system: Table, c: int, x: Table, unit: float, motion: Table, watched: Table) -> None:
    """Coefficients of the powers of t/unit: the state ``motion`` (15, 8), the watched values (4, 15)."""
    for row in range(8):
        motion[0, row] = x[row]
    for order in range(ORDER):
        scale = unit / (order + 1)
        for row in range(4):
            motion[order + 1, row] = scale * motion[order, 4 + row]
            force = 0.0
            if order == 0:
                force = system[c, 8, ACCELERATION + row] * x[A] + system[c, 9, ACCELERATION + row] * x[G]
            elif order == 1:
                slope = system[c, 8, ACCELERATION + row] * x[A_SLOPE] + system[c, 9, ACCELERATION + row] * x[G_SLOPE]
                force = unit * slope
            for j in range(8):
                force += system[c, j, ACCELERATION + row] * motion[order, j]
            motion[order + 1, 4 + row] = scale * force
    for row in range(4):
        for order in range(ORDER + 1):
            value = 0.0
            if order == 0:
                value = system[c, 8, WATCH + row] * x[A] + system[c, 9, WATCH + row] * x[G]
            elif order == 1:
                value = unit * (system[c, 8, WATCH + row] * x[A_SLOPE] + system[c, 9, WATCH + row] * x[G_SLOPE])
            for j in range(8):
                value += system[c, j, WATCH + row] * motion[order, j]
            watched[row, order] = value


@inlined
def along(motion: Table, share: float, x: Table, length: float, to: Table) -> None:
    """The state ``to`` at ``share`` of the unit, ``length`` (s) after x."""
    for row in range(8):
        to[row] = motion[ORDER, row]
    for order in range(ORDER - 1, -1, -1):
        for row in range(8):
            to[row] = to[row] * share + motion[order, row]
    to[A], to[A_SLOPE], to[G], to[G_SLOPE] = (
        x[A] + length * x[A_SLOPE],
        x[A_SLOPE],
        x[G] + length * x[G_SLOPE],
        x[G_SLOPE],
    )
