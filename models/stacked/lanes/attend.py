"""The life of one lane: its start, what a flagged step needs, its end."""

from __future__ import annotations

import math
from typing import Any

from models.lanes.arrays import Counts, Table
from models.lanes.compiler import called, inlined
from models.lanes.events import note
from models.stacked import account as acc
from models.stacked.lanes import rows as r
from models.stacked.lanes.bookkeeping import add_time, mark_configuration, raise_peaks, stand
from models.stacked.lanes.equation import acceleration
from models.stacked.lanes.events import one_step
from models.stacked.lanes.friction import goes_on, rub, sign
from models.stacked.lanes.locate import base
from models.stacked.lanes.overturning import overturned

HALF_TURN = 0.5 * math.pi


@inlined
def side_of(q: float, v: float) -> float:
    """Side of a joint in a given state: that of its opening, else of its rate; 0 in contact."""
    return sign(q if q != 0.0 else v)


@called
def start(given: Table, result: Table, w: Table, lane: int, slot: int, time: float) -> None:
    """Put a lane in a slot, in its initial state."""
    w[r.SCALE, slot] = given[lane, r.P_SCALE]
    w[r.OFFSET, slot] = given[lane, r.P_OFFSET]
    w[r.GRAVITY, slot] = given[lane, r.P_GRAVITY]
    w[r.VSCALE, slot] = given[lane, r.P_VSCALE]
    m1, m2 = given[lane, r.P_M1], given[lane, r.P_M2]
    high = given[lane, r.P_TALL] + given[lane, r.P_H2]
    w[r.COULOMB, slot] = given[lane, r.P_COULOMB] / (m1 + m2)
    w[r.PITCH, slot] = given[lane, r.P_PITCH]
    w[r.FRAME_1, slot], w[r.FRAME_2, slot] = given[lane, r.P_FRAME_1] / (m1 + m2), given[lane, r.P_FRAME_2] / (m1 + m2)
    w[r.LEVER_1, slot] = (m1 * given[lane, r.P_H1] + m2 * high) / (m1 + m2)
    w[r.LEVER_2, slot] = m2 * high / (m1 + m2)
    w[r.DEMAND_1, slot], w[r.DEMAND_2, slot] = 0.0, 0.0
    w[r.WORK, slot], w[r.WORK_STEP, slot] = 0.0, 0.0
    q1, q2, v1, v2 = given[lane, r.P_Q1], given[lane, r.P_Q2], given[lane, r.P_V1], given[lane, r.P_V2]
    w[r.Q1, slot], w[r.Q2, slot], w[r.V1, slot], w[r.V2, slot] = q1, q2, v1, v2
    for column in range(result.shape[1]):
        result[lane, column] = 0.0
    for column in (acc.ONSET_BASE, acc.ONSET_TOP, acc.OVERTURNED_1, acc.OVERTURNED_2):
        result[lane, column] = math.nan
    result[lane, acc.PEAK_1], result[lane, acc.PEAK_2] = abs(q1), abs(q1 + q2)
    s1, s2 = side_of(q1, v1), side_of(q2, v2)
    result[lane, r.R_SIDE_1], result[lane, r.R_SIDE_2], result[lane, r.R_SINCE] = s1, s2, time
    result[lane, r.R_CLOSED] = 1.0 if s1 == 0.0 and s2 == 0.0 else 0.0
    stand(given, w, lane, slot, s1, s2)
    if w[r.COULOMB, slot] > 0.0:
        rub(given, w, lane, slot, s1, sign(v1))
    mark_configuration(result, lane)


@inlined
def load(w: Table, slot: int, record: Table, i: int, linear: Any, general: Any) -> None:
    """Inputs and accelerations at the start of step i."""
    a, g, psi, turning = base(w, slot, record, i, 0.0, general)
    w[r.A0, slot], w[r.G0, slot] = a, g
    if general is not None:
        w[r.PSI0, slot], w[r.TURNING0, slot] = psi, turning
        a -= g * psi
    w[r.X1, slot], w[r.X2, slot] = acceleration(
        w, slot, w[r.Q1, slot], w[r.Q2, slot], w[r.V1, slot], w[r.V2, slot], a, g, turning, linear
    )


@inlined
def watch(given: Table, w: Table, lane: int, slot: int, shaken: bool) -> None:
    """Set the rotations beyond which the lane needs attention."""
    w[r.LIMIT_1, slot] = HALF_TURN if shaken else given[lane, r.P_STAND_1]
    w[r.LIMIT_2, slot] = HALF_TURN if shaken else given[lane, r.P_STAND_2]


@called
def finish(given: Table, result: Table, kept: Table, w: Table, lane: int, slot: int, time: float) -> None:
    """Close the account of a lane at ``time``; one that overturned before has closed it then."""
    over = result[lane, acc.OVERTURNED_2]
    if over == over and over < time:
        for column in range(result.shape[1]):
            result[lane, column] = kept[slot, column]
        return
    add_time(result, lane, time)
    end_1, end_2 = w[r.Q1, slot], w[r.Q1, slot] + w[r.Q2, slot]
    result[lane, acc.END_1], result[lane, acc.END_2] = end_1, end_2
    # a body that still moves outwards has not turned back, where peaks are taken otherwise
    result[lane, acc.PEAK_1] = max(result[lane, acc.PEAK_1], abs(end_1))
    result[lane, acc.PEAK_2] = max(result[lane, acc.PEAK_2], abs(end_2))
    result[lane, acc.FRICTION_BASE], result[lane, acc.FRICTION_TOP] = w[r.DEMAND_1, slot], w[r.DEMAND_2, slot]
    result[lane, acc.LOST_BASE] += (given[lane, r.P_M1] + given[lane, r.P_M2]) * w[r.WORK, slot]


@inlined
def fraction(q_start: float, q_end: float) -> float:
    """Fraction of the step at which |q| passes pi/2."""
    if abs(q_end) == abs(q_start):
        return 1.0
    return min(1.0, max(0.0, (HALF_TURN - abs(q_start)) / (abs(q_end) - abs(q_start))))


@called
def attend(
    given: Table, result: Table, kept: Table, w: Table, system: Table, lane: int, slot: int, record: Table, i: int,
    h: float, shaken: bool, fall: bool, log: Table, count: Counts, linear: Any, general: Any,
) -> float:  # fmt: skip
    """What a flagged lane needs after step i; the time at which it ends, nan when it goes on."""
    started = (w[r.Q1S, slot], w[r.Q2S, slot], w[r.V1S, slot], w[r.V2S, slot])
    ended = (w[r.Q1, slot], w[r.Q2, slot], w[r.V1, slot], w[r.V2, slot])
    eventful = not (w[r.MARGIN_1, slot] >= 0.0 and w[r.MARGIN_2, slot] >= 0.0)
    if general is not None:
        onward = goes_on(w[r.OPPOSING, slot], started[2], w[r.X1S, slot], ended[2], w[r.X1, slot], h)
        eventful = eventful or not onward
    if eventful or w[r.LIMIT_1, slot] < 0.0:
        w[r.WORK, slot] -= w[r.WORK_STEP, slot]
        one_step(given, result, w, system, lane, slot, record, i, h, log, count, linear, general)
    else:
        raise_peaks(result, lane, started, ended, h)
    q1, q2, v1, v2 = w[r.Q1, slot], w[r.Q2, slot], w[r.V1, slot], w[r.V2, slot]
    if not (q1 == q1 and q2 == q2):
        result[lane, acc.FAILED] = 1.0
        return (i + 1) * h
    fallen_1, fallen_2 = abs(q1) >= HALF_TURN, abs(q1 + q2) >= HALF_TURN
    known = result[lane, acc.OVERTURNED_2] == result[lane, acc.OVERTURNED_2]
    if not known:
        body, over = 0, (i + 1) * h
        if fallen_1 or fallen_2:
            body = 1 if fallen_1 else 2
            f = fraction(started[0], q1) if fallen_1 else fraction(started[0] + started[1], q1 + q2)
            over = (i + f) * h
        elif not shaken and result[lane, r.R_CLOSED] == 0.0:
            a, g = w[r.OFFSET, slot], w[r.GRAVITY, slot]
            body = overturned(given, lane, result[lane, r.R_SIDE_1], result[lane, r.R_SIDE_2], q1, q2, v1, v2, a, g)
        if body > 0:
            result[lane, acc.OVERTURNED_2] = over
            if body == 1:
                result[lane, acc.OVERTURNED_1] = over
            note(log, count, lane, over, r.LOG_OVERTURNED, float(body))
            if not fall or fallen_1 or fallen_2:
                return over
            finish(given, result, kept, w, lane, slot, over)
            for column in range(result.shape[1]):
                kept[slot, column] = result[lane, column]
    elif fallen_1 or fallen_2:
        return (i + 1) * h
    return math.nan
