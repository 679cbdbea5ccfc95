"""Dry friction of the couple on the wall and of the base that slides, for all lanes.

The force that would stop its coordinate at the end of the step, cut to what friction can give: no velocity of zero is
ever stepped over, and what is held stays. Both forces act on each other through the bodies: a few sweeps.
"""

from __future__ import annotations

from models.interface.lanes import rows as r
from models.interface.lanes.effects import rows as e
from models.interface.lanes.effects.rows import More
from models.interface.lanes.effects.solve import solve
from models.interface.lanes.rows import W
from models.lanes.arrays import Table
from models.lanes.compiler import called

SWEEPS = 6
HUGE = 1e300
STUCK = 1e-9
"""m/s: what rounding leaves of the velocity along a base that friction holds. Where a run begins it is no slip, whose
friction would be that of the whole weight in a direction of chance."""


@called
def hold(t: Table, m: More) -> None:
    """Find both forces and what they change of d; the right hand side is lent to them."""
    lanes = min(W, t.size)
    for which in range(2):
        for j in range(m.size):
            for i in range(lanes):
                t[e.F + j * W + i] = 0.0
        for i in range(lanes):
            if which == 0:
                t[e.F + i] = t[r.FREE_B * W + i]
            else:
                t[e.F + 4 * W + i] = t[e.FREE_X1 + i] * t[e.SLIDES + i]
        if which == 0 or m.size > 4:
            solve(t, m, e.F, e.HELD if which == 0 else e.HELD_BASE)
    for i in range(lanes):
        t[e.HELD_1 + i], t[e.HELD_X + i] = 0.0, 0.0
    slips = m.size > 4
    for _ in range(SWEEPS if slips else 1):
        for i in range(lanes):
            far = t[r.FAR * W + i]
            per = 1.0 / far if far > 0.0 else HUGE
            couple, push = t[e.HELD_1 + i], t[e.HELD_X + i]
            answer, across = t[e.HELD + i], t[e.HELD_BASE + i] if slips else 0.0
            rest = t[e.D + i] + across * push + min(max(t[e.V + i] * per, -HUGE), HUGE)
            most = t[e.DRY + i]
            couple = min(max(-rest / (answer + (1.0 - t[r.FREE_B * W + i])), -most), most)
            t[e.HELD_1 + i] = couple
            if slips:
                d0, d2 = t[e.D + i] + answer * couple + across * push, t[e.D + 2 * W + i]
                d2 += t[e.HELD + 2 * W + i] * couple + t[e.HELD_BASE + 2 * W + i] * push
                normal = t[e.N_B + i] - t[e.D1_B + i] * d2 + t[e.D2_B + i] * t[e.C1 + i] * d0
                most = t[e.SLIDES + i] * t[e.FRICTION + i] * max(normal, 0.0)
                slip = t[e.V + 4 * W + i]
                slip = slip if far > 0.0 or abs(slip) > STUCK else 0.0
                rest = t[e.D + 4 * W + i] + t[e.HELD + 4 * W + i] * couple + min(max(slip * per, -HUGE), HUGE)
                t[e.HELD_X + i] = min(max(-rest / (t[e.HELD_BASE + 4 * W + i] + 1.0 - t[e.SLIDES + i]), -most), most)
    for j in range(m.size):
        for i in range(lanes):
            t[e.D + j * W + i] += t[e.HELD + j * W + i] * t[e.HELD_1 + i]
            if slips:
                t[e.D + j * W + i] += t[e.HELD_BASE + j * W + i] * t[e.HELD_X + i]
