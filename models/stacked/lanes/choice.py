"""Which configuration follows, one lane: the complementarity condition of `models.stacked.reference.choice`."""

from __future__ import annotations

import math

from models.lanes.arrays import Table
from models.lanes.compiler import called, inlined
from models.stacked.lanes.corners import line


@inlined
def held(system: Table, s1: float, s2: float) -> tuple[float, float]:
    """x for the joints that are up (side not 0); a closed one has x = 0."""
    k = line(s1, s2)
    m11, m12, m22, r1, r2 = system[k, 0], system[k, 1], system[k, 2], system[k, 3], system[k, 4]
    if s1 != 0.0 and s2 != 0.0:
        scale = 1.0 / (m11 * m22 - m12 * m12)
        return scale * (m22 * r1 - m12 * r2), scale * (m11 * r2 - m12 * r1)
    if s1 != 0.0:
        return r1 / m11, 0.0
    if s2 != 0.0:
        return 0.0, r2 / m22
    return 0.0, 0.0


@inlined
def margin(system: Table, base: float, top: float, s1: float, s2: float) -> float:
    """How far (s1, s2) is from inadmissible, in units of x."""
    least = math.inf
    x1, x2 = held(system, s1, s2)
    for c1 in (1.0, -1.0):
        if s1 != 0.0 and c1 != s1:
            continue
        for c2 in (1.0, -1.0):
            if s2 != 0.0 and c2 != s2:
                continue
            k = line(c1, c2)
            m11, m12, m22 = system[k, 0], system[k, 1], system[k, 2]
            if base == 0.0:
                free = m11 - m12 * m12 / m22 if s2 != 0.0 else m11
                pull = -c1 * (system[k, 3] - m12 * x2) / free
                least = min(least, s1 * x1 if s1 != 0.0 else pull)
            if top == 0.0:
                free = m22 - m12 * m12 / m11 if s1 != 0.0 else m22
                pull = -c2 * (system[k, 4] - m12 * x1) / free
                least = min(least, s2 * x2 if s2 != 0.0 else pull)
    return least


@called
def choose(system: Table, base: float, top: float, moving: bool) -> tuple[float, float]:
    """The admissible pair; ``base``, ``top``: 0 in contact, else the corner of a joint already up."""
    best, b1, b2 = -math.inf, base, top
    for s1 in (1.0, -1.0, 0.0):
        if base != 0.0 and s1 != base:
            continue
        for s2 in (1.0, -1.0, 0.0):
            if (top != 0.0 and s2 != top) or (moving and s1 == 0.0 and s2 == 0.0):
                continue
            found = margin(system, base, top, s1, s2)
            if found > best:
                best, b1, b2 = found, s1, s2
    return b1, b2
