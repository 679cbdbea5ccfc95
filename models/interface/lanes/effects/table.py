"""A law in a table at the predictor, for all lanes: its forces, implicit as those of the layers are.

Sums of hat functions over the values of a table, one line from the reach below zero to that above; see
`models.interface.table`. Values are in N m and N, reaches one over the spacing of the values.
"""

from __future__ import annotations

from models.interface.lanes import rows as r
from models.interface.lanes.effects import rows as e
from models.interface.lanes.effects.solve import at
from models.interface.lanes.rows import W
from models.interface.table import ONE_LINE, SLOW
from models.lanes.arrays import Table
from models.lanes.compiler import called, inlined

LAST = (ONE_LINE - 1) / 2
STEEP = 1.0 / (SLOW * LAST)
NEXT = ONE_LINE * W
"""From the rows of one table to those of the next."""
Force = tuple[float, float, float]
"""A force and its slopes over the coordinate and its rate."""


@inlined
def value(t: Table, table: int, i: int, x: float) -> tuple[float, float]:
    """Of a table at x (in spacings), and its slope."""
    place = min(max(x, -LAST), LAST) + LAST
    found, slope = 0.0, 0.0
    for k in range(ONE_LINE):
        off, one = place - k, t[table + k * W + i]
        found += max(0.0, 1.0 - abs(off)) * one
        slope += one if (off >= -1.0) & (off < 0.0) else 0.0
        slope -= one if (off >= 0.0) & (off < 1.0) else 0.0
    return found, slope if abs(x) < LAST else 0.0


@inlined
def couple(t: Table, reach: int, tables: int, i: int, turn: float, rate: float) -> Force:
    """Of a joint at its angle and angular velocity."""
    per, per_rate = t[reach + i], t[reach + W + i]
    place = turn * per
    plain, bend = value(t, tables, i, place)
    fast, grow = value(t, tables + NEXT, i, rate * per_rate)
    damping, damping_bend = value(t, tables + 2 * NEXT, i, place)
    friction, friction_bend = value(t, tables + 3 * NEXT, i, place)
    share = STEEP * per_rate * rate
    steep = STEEP * per_rate if abs(share) < 1.0 else 0.0
    sign = min(max(share, -1.0), 1.0)
    return (
        plain + fast + damping * rate + friction * sign,
        per * (bend + damping_bend * rate + friction_bend * sign),
        per_rate * grow + damping + friction * steep,
    )


@inlined
def displacement(t: Table, i: int) -> float:
    """Of the block's mass centre along the base."""
    c1, cr, sm, cm = t[e.C1 + i], t[e.CR + i], t[e.SM + i], t[e.CM + i]
    s2, c2 = sm * cr + cm * t[e.SR + i], cm * cr - sm * t[e.SR + i]
    b1 = t[r.TOE_1 * W + i] if t[e.S1 + i] >= 0.0 else -t[r.TOE_1 * W + i]
    bt = t[r.TOE_T * W + i] if t[e.SR + i] >= 0.0 else -t[r.TOE_T * W + i]
    half = 0.5 * t[e.LENGTH + i]
    along = bt - bt * cr + t[e.Q + 5 * W + i]
    level = t[r.HEIGHT * W + i] - half + t[e.Q + 7 * W + i] + t[e.Q + 3 * W + i]
    foot = b1 - b1 * c1 + t[e.Q + 4 * W + i] + half * t[e.S1 + i]
    return float(foot + along * cm + level * sm + t[e.TOP_OFFSET + i] * c2 + t[r.H2 * W + i] * s2)


@inlined
def acceleration(t: Table, i: int) -> float:
    """Of the base, along it."""
    scale = t[r.SCALE * W + i]
    gravity = t[r.GRAVITY * W + i] + t[r.VSCALE * W + i] * t[r.RV * W + i]
    return float(scale * t[r.RA * W + i] + t[r.OFFSET * W + i] - gravity * scale * t[e.PITCH + i] * t[e.PSI + i])


@called
def act(t: Table) -> None:
    """Add the law to the right hand side and its slopes to the matrix."""
    lanes = min(W, t.size)
    for i in range(lanes):
        near, far = t[r.NEAR * W + i], t[r.FAR * W + i]
        free_b, free_t, free_m = t[r.FREE_B * W + i], t[r.FREE_T * W + i], t[e.FREE_M + i]
        force, bend, grow = couple(t, e.REACH, e.VALUES, i, t[e.Q + i], t[e.V + i])
        t[e.F + i] += free_b * force
        t[at(0, 0) + i] -= free_b * (near * bend + far * grow)
        # over the top joint's angle: theta2 less thetam, which theta1 is where the wall does not bend
        to_1, to_m = -free_t * (1.0 - free_m) * free_b, -free_t * free_m
        turn, rate = t[e.Q + W + i] - t[e.Q + 6 * W + i], t[e.V + W + i] - t[e.V + 6 * W + i]
        force, bend, grow = couple(t, e.REACH + 2 * W, e.VALUES + 4 * NEXT, i, turn, rate)
        slope = near * bend + far * grow
        t[e.F + i] += to_1 * force
        t[e.F + W + i] += free_t * force
        t[e.F + 6 * W + i] += to_m * force
        t[at(0, 0) + i] -= slope * to_1 * to_1
        t[at(1, 0) + i] -= slope * free_t * to_1
        t[at(1, 1) + i] -= slope * free_t * free_t
        t[at(6, 0) + i] -= slope * to_m * to_1
        t[at(6, 1) + i] -= slope * to_m * free_t
        t[at(6, 6) + i] -= slope * to_m * to_m
    push(t)


@called
def push(t: Table) -> None:
    """The force on the block, over the coordinates that move it along the base."""
    lanes = min(W, t.size)
    for i in range(lanes):
        t[e.ALONG + i], t[e.ALONG + W + i], t[e.ALONG + 2 * W + i] = t[e.XB_1 + i], t[e.XB_2 + i], 0.0
        t[e.ALONG + 3 * W + i], t[e.ALONG + 4 * W + i] = t[e.XB_Z2 + i], t[e.FREE_X1 + i]
        t[e.ALONG + 5 * W + i], t[e.ALONG + 6 * W + i] = t[e.XB_X2 + i], t[e.XB_M + i]
        t[e.ALONG + 7 * W + i] = t[e.X_ZM + i]
    for i in range(lanes):
        rate = 0.0
        for j in range(e.SIZE):
            rate += t[e.ALONG + j * W + i] * t[e.V + j * W + i]
        per, per_rate = t[e.REACH + 4 * W + i], t[e.REACH + 5 * W + i]
        still, bend = value(t, e.VALUES + 8 * NEXT, i, displacement(t, i) * per)
        fast, grow = value(t, e.VALUES + 9 * NEXT, i, rate * per_rate)
        by_base, _ = value(t, e.VALUES + 10 * NEXT, i, acceleration(t, i) * t[e.REACH + 6 * W + i])
        t[e.PUSH + i] = still + fast + by_base
        t[e.PUSHED + i] = t[r.NEAR * W + i] * bend * per + t[r.FAR * W + i] * grow * per_rate
    for j in range(e.SIZE):
        for i in range(lanes):
            t[e.F + j * W + i] += t[e.ALONG + j * W + i] * t[e.PUSH + i]
        for k in range(j + 1):
            for i in range(lanes):
                both = t[e.ALONG + j * W + i] * t[e.ALONG + k * W + i]
                t[e.MATRIX + (e.SIZE * j + k) * W + i] -= t[e.PUSHED + i] * both
