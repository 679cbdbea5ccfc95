"""The rule of `models.stacked.reference.overturning` for one lane."""

from __future__ import annotations

import math

from models.lanes.arrays import Table
from models.lanes.compiler import called
from models.stacked.lanes import rows as r
from models.stacked.lanes.corners import kinetic_energy, turns, vectors


@called
def overturned(
    given: Table, lane: int, s1: float, s2: float, q1: float, q2: float, v1: float, v2: float, a: float, g: float
) -> int:  # fmt: skip
    """1 for the wall (and what stands on it), 2 for the upper block, 0 for none: what cannot come back."""
    m1, m2 = given[lane, r.P_M1], given[lane, r.P_M2]
    c1 = s1 if s1 != 0.0 else 1.0
    c2 = s2 if s2 != 0.0 else 1.0
    v = vectors(given, lane, c1, c2, turns(q1, q2, None), 1.0)
    pivot = c1 * given[lane, r.P_B1]
    energy = kinetic_energy(given, lane, c1, c2, q1, q2, v1, v2, None)
    energy += g * (m1 * v[1] + m2 * v[5]) + a * (m1 * (pivot + v[0]) + m2 * (pivot + v[4]))
    whole = math.sqrt(a * a + g * g)
    if s1 != 0.0 and s1 * (g * v[0] - a * v[1]) > given[lane, r.P_COULOMB] / m1 and s1 * v1 > 0.0:
        mass = m1 + m2
        arm = pivot - (m1 * given[lane, r.P_D1] + m2 * given[lane, r.P_D2]) / mass
        centre = (m1 * given[lane, r.P_H1] + m2 * (given[lane, r.P_TALL] + given[lane, r.P_H2])) / mass
        if energy < mass * (whole * math.sqrt(arm * arm + centre * centre) + a * pivot):
            return 1
    if s2 != 0.0 and s2 * (g * v[2] - a * v[3]) > 0.0 and s2 * (v1 + v2) > 0.0:
        joint = s2 * given[lane, r.P_B2]
        arm = joint - given[lane, r.P_D2]
        radius = math.sqrt(arm * arm + given[lane, r.P_H2] ** 2)
        wall = m1 * (g * given[lane, r.P_H1] + a * given[lane, r.P_D1])
        if energy < wall + m2 * (g * given[lane, r.P_TALL] + a * joint + whole * radius):
            return 2
    return 0
