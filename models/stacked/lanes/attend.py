"""The life of one lane: its start, what a flagged step needs, its end."""

from __future__ import annotations

import math
from typing import Any

from models.lanes.compiler import called, inlined
from models.lanes.events import note
from models.stacked.account import (
    END_1,
    END_2,
    FAILED,
    FRICTION_BASE,
    FRICTION_TOP,
    LOST_BASE,
    ONSET_BASE,
    ONSET_TOP,
    OVERTURNED_1,
    OVERTURNED_2,
    PEAK_1,
    PEAK_2,
)  # fmt: skip
from models.stacked.lanes.bookkeeping import raise_peaks, spend, stand, visit
from models.stacked.lanes.equation import acceleration
from models.stacked.lanes.events import one_step
from models.stacked.lanes.locate import inputs
from models.stacked.lanes.overturning import overturned
from models.stacked.lanes.rows import (
    A0,
    DEMAND_1,
    DEMAND_2,
    G0,
    GRAVITY,
    LIMIT_1,
    LIMIT_2,
    LOG_OVERTURNED,
    MARGIN_1,
    MARGIN_2,
    OFFSET,
    P_GRAVITY,
    P_M1,
    P_M2,
    P_OFFSET,
    P_Q1,
    P_Q2,
    P_SCALE,
    P_STAND_1,
    P_STAND_2,
    P_V1,
    P_V2,
    P_VSCALE,
    Q1,
    Q1S,
    Q2,
    Q2S,
    R_CLOSED,
    R_SIDE_1,
    R_SIDE_2,
    R_SINCE,
    SCALE,
    V1,
    V1S,
    V2,
    V2S,
    VSCALE,
    WORK,
    WORK_STEP,
    X1,
    X2,
    W,
)  # fmt: skip

Table = Any
HALF_TURN = 0.5 * math.pi


@inlined
def sign(q: float, v: float) -> float:
    """Side of a joint in a given state: that of its opening, else of its rate; 0 in contact."""
    first = q if q != 0.0 else v
    return 1.0 if first > 0.0 else -1.0 if first < 0.0 else 0.0


@called
def start(given: Table, result: Table, w: Table, lane: int, slot: int, time: float) -> None:
    """Put a lane in a slot, in its initial state."""
    w[SCALE * W + slot] = given[lane, P_SCALE]
    w[OFFSET * W + slot] = given[lane, P_OFFSET]
    w[GRAVITY * W + slot] = given[lane, P_GRAVITY]
    w[VSCALE * W + slot] = given[lane, P_VSCALE]
    w[DEMAND_1 * W + slot], w[DEMAND_2 * W + slot] = 0.0, 0.0
    w[WORK * W + slot], w[WORK_STEP * W + slot] = 0.0, 0.0
    q1, q2, v1, v2 = given[lane, P_Q1], given[lane, P_Q2], given[lane, P_V1], given[lane, P_V2]
    w[Q1 * W + slot], w[Q2 * W + slot], w[V1 * W + slot], w[V2 * W + slot] = q1, q2, v1, v2
    for column in range(result.shape[1]):
        result[lane, column] = 0.0
    for column in (ONSET_BASE, ONSET_TOP, OVERTURNED_1, OVERTURNED_2):
        result[lane, column] = math.nan
    result[lane, PEAK_1], result[lane, PEAK_2] = abs(q1), abs(q1 + q2)
    s1, s2 = sign(q1, v1), sign(q2, v2)
    result[lane, R_SIDE_1], result[lane, R_SIDE_2], result[lane, R_SINCE] = s1, s2, time
    result[lane, R_CLOSED] = 1.0 if s1 == 0.0 and s2 == 0.0 else 0.0
    stand(given, w, lane, slot, s1, s2)
    visit(result, lane)


@inlined
def load(w: Table, slot: int, record: Table, i: int, linear: Any) -> None:
    """Inputs and accelerations at the start of step i."""
    a, g = inputs(w, slot, record, i, 0.0)
    w[A0 * W + slot], w[G0 * W + slot] = a, g
    w[X1 * W + slot], w[X2 * W + slot] = acceleration(
        w, slot, w[Q1 * W + slot], w[Q2 * W + slot], w[V1 * W + slot], w[V2 * W + slot], a, g, linear
    )


@inlined
def watch(given: Table, w: Table, lane: int, slot: int, shaken: bool) -> None:
    """Set the rotations beyond which the lane needs attention."""
    w[LIMIT_1 * W + slot] = HALF_TURN if shaken else given[lane, P_STAND_1]
    w[LIMIT_2 * W + slot] = HALF_TURN if shaken else given[lane, P_STAND_2]


@called
def finish(given: Table, result: Table, kept: Table, w: Table, lane: int, slot: int, time: float) -> None:
    """Close the account of a lane at ``time``; one that overturned before has closed it then."""
    over = result[lane, OVERTURNED_2]
    if over == over and over < time:
        for column in range(result.shape[1]):
            result[lane, column] = kept[slot, column]
        return
    spend(result, lane, time)
    result[lane, END_1], result[lane, END_2] = w[Q1 * W + slot], w[Q1 * W + slot] + w[Q2 * W + slot]
    result[lane, FRICTION_BASE], result[lane, FRICTION_TOP] = w[DEMAND_1 * W + slot], w[DEMAND_2 * W + slot]
    result[lane, LOST_BASE] += (given[lane, P_M1] + given[lane, P_M2]) * w[WORK * W + slot]


@inlined
def fraction(q_start: float, q_end: float) -> float:
    """Fraction of the step at which |q| passes pi/2."""
    if abs(q_end) == abs(q_start):
        return 1.0
    return min(1.0, max(0.0, (HALF_TURN - abs(q_start)) / (abs(q_end) - abs(q_start))))


@called
def attend(
    given: Table, result: Table, kept: Table, w: Table, system: Table, lane: int, slot: int, record: Table, i: int,
    h: float, shaken: bool, fall: bool, log: Table, count: Table, linear: Any,
) -> float:  # fmt: skip
    """What a flagged lane needs after step i; the time at which it ends, nan when it goes on."""
    started = (w[Q1S * W + slot], w[Q2S * W + slot], w[V1S * W + slot], w[V2S * W + slot])
    ended = (w[Q1 * W + slot], w[Q2 * W + slot], w[V1 * W + slot], w[V2 * W + slot])
    eventful = not (w[MARGIN_1 * W + slot] >= 0.0 and w[MARGIN_2 * W + slot] >= 0.0)
    if eventful or w[LIMIT_1 * W + slot] < 0.0:
        w[WORK * W + slot] -= w[WORK_STEP * W + slot]
        one_step(given, result, w, system, lane, slot, record, i, h, log, count, linear)
    else:
        raise_peaks(result, lane, started, ended, h)
    q1, q2, v1, v2 = w[Q1 * W + slot], w[Q2 * W + slot], w[V1 * W + slot], w[V2 * W + slot]
    if not (q1 == q1 and q2 == q2):
        result[lane, FAILED] = 1.0
        return (i + 1) * h
    fallen_1, fallen_2 = abs(q1) >= HALF_TURN, abs(q1 + q2) >= HALF_TURN
    known = result[lane, OVERTURNED_2] == result[lane, OVERTURNED_2]
    if not known:
        body, over = 0, (i + 1) * h
        if fallen_1 or fallen_2:
            body = 1 if fallen_1 else 2
            f = fraction(started[0], q1) if fallen_1 else fraction(started[0] + started[1], q1 + q2)
            over = (i + f) * h
        elif not shaken and result[lane, R_CLOSED] == 0.0:
            a, g = w[OFFSET * W + slot], w[GRAVITY * W + slot]
            body = overturned(given, lane, result[lane, R_SIDE_1], result[lane, R_SIDE_2], q1, q2, v1, v2, a, g)
        if body > 0:
            result[lane, OVERTURNED_2] = over
            if body == 1:
                result[lane, OVERTURNED_1] = over
            note(log, count, lane, over, LOG_OVERTURNED, float(body))
            if not fall or fallen_1 or fallen_2:
                return over
            finish(given, result, kept, w, lane, slot, over)
            for column in range(result.shape[1]):
                kept[slot, column] = result[lane, column]
    elif fallen_1 or fallen_2:
        return (i + 1) * h
    return math.nan
