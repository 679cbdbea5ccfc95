"""Dry friction of the couple on the wall and of the base that slides, for all lanes.

The force that would stop its coordinate at the end of the step, cut to what friction can give: no velocity of zero is
ever stepped over, and what is held stays. Both forces act on each other through the bodies: a few sweeps.
"""

from __future__ import annotations

from models.interface.lanes import rows as r
from models.interface.lanes.effects import rows as e
from models.interface.lanes.effects.rows import More
from models.interface.lanes.effects.solve import solve
from models.lanes.arrays import Table
from models.lanes.compiler import called

SWEEPS = 6
HUGE = 1e300


@called
def hold(w: Table, m: More) -> None:
    """Find both forces and what they change of d; ``m.f`` is lent to them."""
    own, joint, lanes = m.own, m.joint, m.q.shape[1]
    for which in range(2):
        for j in range(m.size):
            for i in range(lanes):
                m.f[j, i] = 0.0
        for i in range(lanes):
            if which == 0:
                m.f[0, i] = w[r.FREE_B, i]
            else:
                m.f[4, i] = own[e.FREE_X1, i] * own[e.SLIDES, i]
        if which == 0 or m.size > 4:
            solve(m, m.f, m.held[which])
    for i in range(lanes):
        joint[e.HELD_1, i], joint[e.HELD_X, i] = 0.0, 0.0
    slips = m.size > 4
    for _ in range(SWEEPS):
        for i in range(lanes):
            far = w[r.FAR, i]
            per = 1.0 / far if far > 0.0 else HUGE
            couple, push = joint[e.HELD_1, i], joint[e.HELD_X, i]
            answer, across = m.held[0, 0, i], m.held[1, 0, i] if slips else 0.0
            rest = m.d[0, i] + across * push + min(max(m.v[0, i] * per, -HUGE), HUGE)
            most = own[e.DRY, i]
            couple = min(max(-rest / (answer + (1.0 - w[r.FREE_B, i])), -most), most)
            joint[e.HELD_1, i] = couple
            if slips:
                d0, d2 = m.d[0, i] + answer * couple + across * push, m.d[2, i]
                d2 += m.held[0, 2, i] * couple + m.held[1, 2, i] * push
                normal = joint[e.N_B, i] - joint[e.D1_B, i] * d2 + joint[e.D2_B, i] * joint[e.C1, i] * d0
                most = own[e.SLIDES, i] * own[e.FRICTION, i] * max(normal, 0.0)
                rest = m.d[4, i] + m.held[0, 4, i] * couple + min(max(m.v[4, i] * per, -HUGE), HUGE)
                joint[e.HELD_X, i] = min(max(-rest / (m.held[1, 4, i] + 1.0 - own[e.SLIDES, i]), -most), most)
    for j in range(m.size):
        for i in range(lanes):
            m.d[j, i] += m.held[0, j, i] * joint[e.HELD_1, i]
            if slips:
                m.d[j, i] += m.held[1, j, i] * joint[e.HELD_X, i]
