"""Dry friction between the wall and the base, one lane: its direction, where the wall turns, what follows.

A wall that friction holds is treated as a closed joint at its place: FREE_1 = 0 and no width, so that its margin is
the couple that friction has to spare and it opens where it is let go (`models.stacked.lanes.equation.contact`).
"""

from __future__ import annotations

from typing import Any

from models.lanes.arrays import Table
from models.lanes.compiler import called, inlined
from models.stacked.lanes import rows as r
from models.stacked.lanes.choice import choose
from models.stacked.lanes.corners import motion
from models.stacked.lanes.locate import Pair, State, part


@inlined
def sign(number: float) -> float:
    return 1.0 if number > 0.0 else -1.0 if number < 0.0 else 0.0


@inlined
def rub(given: Table, w: Table, lane: int, slot: int, s1: float, way: float) -> None:
    """Friction acts against ``way``, the sign of theta_1'; 0: it holds the wall, or the base is closed (``s1`` = 0)."""
    up = s1 != 0.0
    holds = up and way == 0.0 and w[r.COULOMB, slot] > 0.0
    w[r.OPPOSING, slot] = w[r.COULOMB, slot] * way if up else 0.0
    w[r.FREE_1, slot] = 1.0 if up and not holds else 0.0
    w[r.WIDE_1, slot] = 0.0 if holds else 2.0 * given[lane, r.P_B1]


@inlined
def stopped(w: Table, slot: int, s1: float, v1: float) -> bool:
    """Whether friction decides where the wall, up on ``s1``, goes from here."""
    return s1 != 0.0 and v1 == 0.0 and w[r.COULOMB, slot] > 0.0


@called
def respond(
    given: Table, w: Table, system: Table, lane: int, slot: int, s1: float, s2: float, q1: float, q2: float, v1: float,
    v2: float, a: float, g: float, turning: Any, moving: bool, linear: Any,
) -> tuple[float, float, float]:  # fmt: skip
    """s1, s2 and the sign of theta_1' under these forces: closed joints may open, friction may hold the wall."""
    motion(system, given, lane, s1, q1, q2, v1, v2, a, g, turning, linear)
    if turning is not None:
        if stopped(w, slot, s1, v1):
            way, n2 = choose(system, 0.0, s2, False)
            return s1, n2, way
    n1, n2 = choose(system, s1, s2, moving)
    return n1, n2, sign(v1) if v1 != 0.0 else n1


@inlined
def goes_on(opposing: float, v: float, x: float, v_end: float, x_end: float, step: float) -> bool:
    """Whether a wall of rate v and acceleration x keeps its direction over a step; False where it may not.

    One that is just being let go may start with an acceleration of rounding.
    """
    slows, gains = opposing * x < 0.0, opposing * x_end > 0.0
    dips = (opposing * v > 0.0) & slows & gains & (opposing * (v + step * x) < 0.0)
    return (opposing * v_end >= 0.0) & (not dips)


@called
def turns_by(
    w: Table, slot: int, state: State, second: Pair, end: State, second_end: Pair, record: Table, i: int, f: float,
    rest: float, h: float, linear: Any, general: Any,
) -> float:  # fmt: skip
    """A share of step i from its fraction f by which the wall has turned, 0 where it has not by ``rest``."""
    opposing, x, x_end = w[r.OPPOSING, slot], second[0], second_end[0]
    if opposing * end[2] < 0.0:
        return rest
    if goes_on(opposing, state[2], x, end[2], x_end, rest * h):
        return 0.0
    # slow down, nearly to a stop or beyond, and off again
    least = rest * x / (x - x_end)
    found, _, _, _, _ = part(w, slot, state, second, record, i, f, least, h, linear, general)
    return least if opposing * found[2] < 0.0 else 0.0


@called
def turn(
    w: Table, slot: int, state: State, second: Pair, record: Table, i: int, f: float, rest: float, h: float,
    linear: Any, general: Any,
) -> tuple[float, State, Pair, Pair, Pair, float]:  # fmt: skip
    """Share of the step until the wall's rate is zero; state, q'', margins, demands and work there.

    It has turned by ``rest`` of the step. Newton within a bracket on the step itself; the last correction, under
    1e-7 of the step, is applied to the state.
    """
    way = sign(w[r.OPPOSING, slot])
    low, high, share = 0.0, rest, 0.5 * rest
    while True:
        found, x, margins, demands, work = part(w, slot, state, second, record, i, f, share, h, linear, general)
        v, slope = way * found[2], way * x[0]
        if v < 0.0:
            high = share
        else:
            low = share
        near = slope < 0.0 and abs(v) <= -1e-7 * slope * h
        if near or high - low <= 1e-14:
            more = -v / (slope * h) if near else 0.0
            t = more * h
            moved = (found[0] + t * found[2], found[1] + t * found[3], 0.0, found[3] + t * x[1])
            return share + more, moved, x, margins, demands, work
        trial = share - v / (slope * h) if slope < 0.0 else -1.0
        share = trial if low < trial < high else 0.5 * (low + high)
