"""The impact of a block that slides, one lane.

The new corner sticks when the tangential impulse that this takes is within mu times the normal impulse,
else it slips with mu times that. The law of restitution enters as an impulsive couple J (e - e_H) theta'.
"""

from __future__ import annotations

import math
from typing import Any

from models.housner.lanes import rows as r
from models.housner.lanes.impact import pivot, restitution
from models.housner.lanes.onset import excess
from models.housner.lanes.step import come_down, inputs, stand_on
from models.lanes.arrays import Counts, Table
from models.lanes.compiler import called, inlined
from models.lanes.events import note

JAM = 0.05
"""Share of its value without friction at which the inertia of slip counts as lost."""


@inlined
def energy(j: float, height: float, omega: float, v: float) -> float:
    """Kinetic energy over M at theta = 0."""
    return 0.5 * j * omega * omega + height * v * omega + 0.5 * v * v


@called
def land(
    given: Table, result: Table, w: Table, lane: int, slot: int, record: Table, i: int, f: float, h: float,
    log: Table, count: Counts, linear: Any,
) -> None:  # fmt: skip
    """An impact at theta = 0: change of pivot, the new corner sticks or slips."""
    side, omega, v = w[r.SIDE, slot], w[r.OM, slot], w[r.U1, slot]
    height, mu = given[lane, r.Q_HEIGHT], given[lane, r.Q_FRICTION]
    inertia = given[lane, r.Q_INERTIA] / given[lane, r.Q_MASS]
    old, new = pivot(given, w, lane, slot, side), pivot(given, w, lane, slot, -side)
    j_old, j_new = inertia + height * height + old * old, inertia + height * height + new * new
    e = restitution(given, result, w, lane, slot, side, omega)
    before = energy(j_old, height, omega, v)
    om1, v1 = e * omega + height * v / j_new, 0.0
    across, up = height * (om1 - omega) - v, -side * (new * om1 + old * omega)
    if abs(across) > mu * up:
        pull = mu if across > 0.0 else -mu
        lever = new - side * pull * height
        couple = (j_new * e - inertia - height * height + old * new) * omega
        size = inertia + new * lever
        om2 = (inertia * omega - old * lever * omega + couple) / size
        v2 = v - pull * side * (new * om2 + old * omega) - height * (om2 - omega)
        if size > JAM * inertia and pull * v2 <= 0.0 and energy(j_new, height, om2, v2) <= before:
            om1, v1 = om2, v2
    if side * om1 > 0.0:
        # pressed on both corners: the block lands flat
        om1, v1 = 0.0, v + height * omega
        v1 -= math.copysign(min(abs(v1), mu * old * abs(omega)), v1)
    note(log, count, lane, (i + f) * h, r.LOG_IMPACT, 1.0)
    result[lane, r.R_IMPACTS] += 1.0
    result[lane, r.R_SWING] = 0.0
    stand_on(given, w, lane, slot, -side, linear)
    calm = abs(om1) < given[lane, r.Q_REST]
    if calm and abs(v1) * given[lane, r.Q_P] ** 2 < given[lane, r.Q_REST] * given[lane, r.Q_GRAVITY]:
        # ever smaller impacts leave ever less slip, whose full friction would lift the block again without end
        v1 = 0.0
    w[r.U1, slot] = v1
    if calm and not tips(given, w, lane, slot, record, i, f, linear):
        om1 = 0.0
        result[lane, r.R_MODE] = r.SLIDING if v1 != 0.0 else r.DOWN
        come_down(result, lane, (i + f) * h, log, count)
    w[r.OM, slot] = om1
    result[lane, r.R_DISSIPATED] += given[lane, r.Q_MASS] * (before - energy(j_new, height, om1, v1))


@inlined
def tips(given: Table, w: Table, lane: int, slot: int, record: Table, i: int, f: float, linear: Any) -> bool:
    """Whether the block in full contact would be lifted at once, under friction if it slides."""
    a, g, p, q = inputs(w, slot, record, i, f)
    v, base = w[r.U1, slot], a - g * p + given[lane, r.Q_HEIGHT] * q
    hold = given[lane, r.Q_FRICTION] * g
    if v != 0.0:
        a += -base - math.copysign(hold, v)
    elif abs(base) > hold:
        a += math.copysign(hold, base) - base
    return bool(
        excess(given, w, lane, slot, 1.0, a, g, p, q, linear) > 0.0
        or excess(given, w, lane, slot, -1.0, a, g, p, q, linear) > 0.0
    )
