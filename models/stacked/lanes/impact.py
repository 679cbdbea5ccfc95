"""What an impact leaves, one lane: the projection of `models.stacked.reference.impact`."""

from __future__ import annotations

import math

from models.lanes.arrays import Table
from models.lanes.compiler import called, inlined
from models.stacked.lanes import rows as r
from models.stacked.lanes.choice import choose, held
from models.stacked.lanes.corners import line

Landing = tuple[float, float, float, float]
BASE, TOP = 0, 1


@called
def land(
    system: Table, given: Table, lane: int, joint: int, s1: float, s2: float, v1: float, v2: float, energy: float
) -> Landing:
    """s1, s2 and the rates after ``joint`` has closed; ``system`` and ``energy`` from `corners.impulses`.

    ``s1``, ``s2``: before it, 0 for a closed joint.
    """
    base = 0.0 if joint == BASE else s1
    top = 0.0 if joint == TOP else s2
    n1, n2 = choose(system, base, top, False)
    x1, x2 = held(system, n1, n2)
    if joint == BASE:
        ratio, factor, before, after = given[lane, r.P_GIVEN_1], given[lane, r.P_FACTOR_1], v1, x1
    else:
        ratio, factor, before, after = given[lane, r.P_GIVEN_2], given[lane, r.P_FACTOR_2], v2, x2
    wanted = factor * (ratio * before if ratio == ratio else after)
    if wanted == after:
        return n1, n2, x1, x2
    return imposed(system, joint, wanted, top if joint == BASE else base, energy)


@inlined
def seen(system: Table, joint: int, side: float, other: float) -> tuple[float, float, float, float, float]:
    """The system with the unknown of ``joint`` first."""
    if joint == BASE:
        k = line(side, other)
        return system[k, 0], system[k, 1], system[k, 2], system[k, 3], system[k, 4]
    k = line(other, side)
    return system[k, 2], system[k, 1], system[k, 0], system[k, 4], system[k, 3]


@called
def imposed(system: Table, joint: int, wanted: float, other: float, energy: float) -> Landing:
    """The rate of ``joint`` is ``wanted``, less where energy would grow; the other joint: up or in contact."""
    side = 1.0 if wanted > 0.0 else -1.0 if wanted < 0.0 else 0.0
    best, b, b_rate, b_second = -math.inf, other, 0.0, 0.0
    for s in (1.0, -1.0, 0.0):
        if other != 0.0 and s != other:
            continue
        m11, m12, m22, _, r2 = seen(system, joint, side, s)
        stiff, spare = m11, energy
        if s != 0.0:
            stiff = m11 - m12 * m12 / m22
            spare = energy - 0.5 * r2 * r2 / m22
        rate = side * min(abs(wanted), math.sqrt(max(0.0, 2.0 * spare / stiff)))
        second = (r2 - m12 * rate) / m22 if s != 0.0 else 0.0
        fits = 0.0
        if other == 0.0:
            fits = s * second
            if s == 0.0:
                fits = math.inf
                for c in (1.0, -1.0):
                    _, n12, n22, _, p2 = seen(system, joint, side, c)
                    fits = min(fits, -c * (p2 - n12 * rate) / n22)
        if fits > best:
            best, b, b_rate, b_second = fits, s, rate, second
    if joint == BASE:
        return side, b, b_rate, b_second
    return b, side, b_second, b_rate
