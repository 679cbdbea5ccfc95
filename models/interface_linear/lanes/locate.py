"""Whether and when a watched value becomes positive: between the ends of a step, and along a Taylor series."""

from __future__ import annotations

import math

from models.interface_linear.lanes.propagate import ORDER
from models.interface_linear.lanes.rows import RATE, VALUE
from models.lanes.arrays import Table
from models.lanes.compiler import called, inlined

TOUCH = 1e-12
"""A watched value (over its size at rest) counts as positive above this: rounding switches nothing."""
DOUBT = 0.02
"""Share of its change by which a value may come closer to zero inside a step than its cubic says."""
ITERATIONS = 100


@inlined
def may_cross(before: Table, after: Table, t: float) -> bool:
    """Whether one of the four watched values may become positive within a step of length t (s).

    At its start, at its end, or at the maximum inside of the cubic through the values and rates at both.
    """
    found = False
    for row in range(4):
        g0, g1 = before[VALUE + row], after[VALUE + row]
        r0, r1 = t * before[RATE + row], t * after[RATE + row]
        if (g0 > TOUCH) | (g1 > TOUCH):
            found = True
        elif (r0 > 0.0) & (r1 < 0.0):
            found = found | (inner_maximum(g0, r0, g1, r1) + DOUBT * (abs(g1 - g0) + r0 - r1) > 0.0)
    return found


@inlined
def inner_maximum(g0: float, r0: float, g1: float, r1: float) -> float:
    """Maximum on (0, 1) of the cubic with values g and slopes r at both ends, r0 > 0 > r1."""
    change = g1 - g0
    second, third = 3.0 * change - 2.0 * r0 - r1, r0 + r1 - 2.0 * change
    # zero of r0 + 2 second s + 3 third s^2 in the stable form, the one at which the slope falls
    s = r0 / (math.sqrt(second * second - 3.0 * third * r0) - second)
    return float(g0 + s * (r0 + s * (second + s * third)))


@inlined
def value(watched: Table, row: int, share: float) -> float:
    found = watched[row, ORDER]
    for order in range(ORDER - 1, -1, -1):
        found = found * share + watched[row, order]
    return float(found)


@inlined
def slope(watched: Table, row: int, share: float) -> float:
    found = ORDER * watched[row, ORDER]
    for order in range(ORDER - 1, 0, -1):
        found = found * share + order * watched[row, order]
    return float(found)


@called
def first_crossing(watched: Table, until: float) -> tuple[float, int]:
    """The first share of the unit in [0, until] past which a value is positive, and which; (until, -1) for none."""
    best, which = until, -1
    for row in range(4):
        if watched[row, 0] > TOUCH:
            return 0.0, row
        high = best
        if value(watched, row, high) <= TOUCH:
            if not (slope(watched, row, 0.0) > 0.0 and slope(watched, row, high) < 0.0):
                continue
            low, top = 0.0, high
            for _ in range(ITERATIONS):
                middle = 0.5 * (low + top)
                if middle in (low, top):
                    break
                if slope(watched, row, middle) > 0.0:
                    low = middle
                else:
                    top = middle
            if value(watched, row, top) <= TOUCH:
                continue
            high = top
        low = 0.0
        for _ in range(ITERATIONS):
            middle = 0.5 * (low + high)
            if middle in (low, high):
                break
            if value(watched, row, middle) > TOUCH:
                high = middle
            else:
                low = middle
        best, which = high, row
    return best, which
