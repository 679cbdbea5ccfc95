"""What happens to a lane now and then: it starts, the record ends under it, it is logged, it ends."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from models.interface.lanes import rows as r
from models.interface.lanes.along import N_WORK_LAWS
from models.interface.lanes.effects import begin as effects
from models.interface.lanes.effects.rows import N_TABLE, TM, TOP_OFFSET
from models.interface.lanes.fibres import fibres_at_end, fibres_at_start
from models.interface.lanes.rows import (
    A1,
    ACROSS_B,
    ACROSS_T,
    ALONG_B,
    ALONG_T,
    B1,
    BT,
    CLOCK,
    CLOSED_B,
    CLOSED_T,
    GRAVITY,
    GROWTH_A,
    H1,
    H2,
    HEIGHT,
    KB,
    KINETIC,
    LIFT_B,
    LIFT_T,
    LOGGED,
    M1,
    M2,
    N_CONSTANTS,
    N_WORK,
    ONSET_B,
    ONSET_T,
    PEAK_1,
    PEAK_2,
    Q_STATE,
    Q_STEPS,
    RA,
    RV,
    SCALE,
    SHARE_B,
    SHARE_T,
    STEP,
    T1,
    T2,
    TOE_1,
    UP_B,
    UP_T,
    V1,
    V2,
    WINDOW,
    WORK_B,
    WORK_T,
    Z1,
    Z2,
    W,
)  # fmt: skip
from models.interface.lanes.step import AM, BETA, GAMMA, step_one
from models.lanes.arrays import Table
from models.lanes.compiler import called, inlined

HALF_TURN = 1.5707963267948966
NEVER = 1e300


@called
def table_for(laws: Any, more: Any) -> Table:
    """The table (rows, W) of the lanes under way, with rows for rubber laws and effects where there are any."""
    if more is not None:
        return np.zeros((N_TABLE, W))
    return np.zeros((N_WORK if laws is None else N_WORK_LAWS, W))


@called
def set_step(w: Table, slot: int, h: float) -> None:
    """What the step rule makes of a lane's constants and its step of h seconds."""
    w[STEP, slot] = h
    w[r.HALF, slot], w[r.NEAR, slot], w[r.FAR, slot] = 0.5 * h * h, BETA * h * h, GAMMA * h
    for body in range(2):
        w[r.N1 + body, slot] = (1.0 - AM) * w[M1 + (r.M2 - r.M1) * body, slot]
    for joint in range(2):
        k, c = w[KB + joint, slot], w[r.CB + joint, slot]
        w[r.STIFF_B + joint, slot] = h * (GAMMA * c + BETA * h * k)


@called
def consistent(w: Table, slot: int, a: float, v: float, mixed: Any, laws: Any, more: Any) -> None:
    """Give a lane the acceleration of its state under the record's values a and v, nothing else."""
    if more is not None:
        effects.settle(w.reshape(w.size), more, slot, a, v, laws)
        return
    kept = np.empty(N_WORK)
    for row in range(N_WORK):
        kept[row] = w[row, slot]
    w[RA, slot], w[RV, slot] = a, v
    for row in range(A1, A1 + 4):
        w[row, slot] = 0.0
    # a step of no length from no acceleration: (1 - am) M d = Q - n
    set_step(w, slot, 0.0)
    step_one(w.reshape(w.size), slot, mixed, laws)
    for row in range(A1, A1 + 4):
        kept[row] = (1.0 - AM) * w[row, slot]
    kept[r.POWER_B], kept[r.POWER_T] = w[r.POWER_B, slot], w[r.POWER_T, slot]
    for row in (LIFT_B, LIFT_T, r.EDGE_B, r.EDGE_T, ALONG_B, ALONG_T, ACROSS_B, ACROSS_T):
        kept[row] = w[row, slot]
    for row in range(N_WORK):
        w[row, slot] = kept[row]


@called
def start(
    given: Table, result: Table, w: Table, lane: int, slot: int, record: Table, sample: int, time_step: float,
    logged: bool, mixed: Any, laws: Any, rubber: Any, more: Any,
) -> None:  # fmt: skip
    """Put a lane in a slot, in its initial state, at ``sample`` of the record."""
    for row in range(N_WORK):
        w[row, slot] = 0.0
    for k in range(N_CONSTANTS):
        w[SCALE + k, slot] = given[lane, k]
    for k in range(8):
        w[T1 + k, slot] = given[lane, Q_STATE + k]
    w[ONSET_B, slot], w[ONSET_T, slot] = NEVER, NEVER
    w[SHARE_B, slot], w[SHARE_T, slot] = 2.0 * w[B1, slot], 2.0 * w[BT, slot]
    w[ALONG_B, slot], w[ALONG_T, slot] = 0.0, 0.0
    w[ACROSS_B, slot], w[ACROSS_T, slot] = 1.0, 1.0
    n = given[lane, Q_STEPS]
    set_step(w, slot, time_step / n)
    w[CLOCK, slot] = sample * n
    upper = w[T1, slot]
    if more is not None:
        effects.put(w.reshape(w.size), more, lane, slot)
        effects.load_pitch(w.reshape(w.size), more, slot, record, sample, record.shape[1], 1.0)
        upper = w[TM // W, slot]
    if laws is not None:
        fibres_at_start(w.reshape(w.size), rubber, lane, slot, more, upper)
    consistent(w, slot, record[0, sample], record[1, sample], mixed, laws, more)
    w[PEAK_1, slot], w[PEAK_2, slot] = abs(w[T1, slot]), abs(w[T2, slot])
    w[ONSET_B, slot] = sample * n if w[LIFT_B, slot] > 0.0 else NEVER
    w[ONSET_T, slot] = sample * n if w[LIFT_T, slot] > 0.0 else NEVER
    w[LOGGED, slot] = 1.0 if logged else 0.0
    for k in range(result.shape[1]):
        result[lane, k] = 0.0
    result[lane, r.R_OVER_1], result[lane, r.R_OVER_2] = math.nan, math.nan


@called
def empty(w: Table, slot: int) -> None:
    """A slot without a lane: a light body at rest on soft layers, without gravity."""
    for row in range(N_WORK):
        w[row, slot] = 0.0
    for row in (r.M1, r.I1, r.M2, r.I2, r.B1, r.BT, r.KB, r.KT, r.FREE_B, r.FREE_T):
        w[row, slot] = 1.0
    w[Z1, slot], w[Z2, slot] = -1.0, -1.0
    w[GRAVITY, slot] = 0.0
    set_step(w, slot, 0.0)


@inlined
def ratio(along: float, across: float) -> float:
    return along / across if across > 0.0 else NEVER


@called
def topple(result: Table, w: Table, lane: int, slot: int, time: float, beside: float) -> None:
    """At the end of the run: a body whose centre is past its toe and moves outwards counts as overturned.

    ``beside``: of the block's mass centre (m) to +x.
    """
    t1, t2, v1, v2 = w[T1, slot], w[T2, slot], w[V1, slot], w[V2, slot]
    m1, m2, h1, h2 = w[M1, slot], w[M2, slot], w[H1, slot], w[H2, slot]
    toe_t, bt, b1 = w[r.TOE_T, slot], w[BT, slot], w[B1, slot]
    turn = t2 - t1
    if w[r.FREE_B, slot] > 0.0:
        side = 1.0 if t1 >= 0.0 else -1.0
        height = w[HEIGHT, slot] + w[Z2, slot]
        x1 = side * w[TOE_1, slot] * (1.0 - math.cos(t1))
        xr = math.copysign(toe_t, turn) * (1.0 - math.cos(turn))
        xr_d = math.copysign(toe_t, turn) * math.sin(turn)
        first = x1 + h1 * math.sin(t1)
        second = x1 + xr * math.cos(t1) + height * math.sin(t1) + h2 * math.sin(t2) + beside * math.cos(t2)
        x1_d = side * w[TOE_1, slot] * math.sin(t1)
        rate_1 = (x1_d + h1 * math.cos(t1)) * v1
        rate_2 = (x1_d + (height - xr_d) * math.cos(t1) - xr * math.sin(t1)) * v1
        rate_2 += (xr_d * math.cos(t1) + h2 * math.cos(t2) - beside * math.sin(t2)) * v2 + math.sin(t1) * w[
            V1 + 3, slot
        ]
        toe = b1 if w[TOE_1, slot] > 0.0 else b1 * math.cos(t1)
        if side * (m1 * first + m2 * second) > (m1 + m2) * toe and side * (m1 * rate_1 + m2 * rate_2) > 0.0:
            result[lane, r.R_OVER_1], result[lane, r.R_OVER_2] = time, time
    if w[r.FREE_T, slot] > 0.0 and not result[lane, r.R_OVER_2] == result[lane, r.R_OVER_2]:
        side = 1.0 if turn >= 0.0 else -1.0
        if side * (h2 * math.sin(t2) + beside * math.cos(t2)) > bt * math.cos(t2) and side * (v2 - v1) > 0.0:
            result[lane, r.R_OVER_2] = time


@called
def finish(result: Table, w: Table, lane: int, slot: int, fell: bool, laws: Any, rubber: Any, more: Any) -> None:
    """Close the account of a lane that ends now; ``fell``: a body has reached pi/2."""
    h = w[STEP, slot]
    time = h * w[CLOCK, slot]
    t1, t2 = w[T1, slot], w[T2, slot]
    if t1 != t1 or t2 != t2:
        result[lane, r.R_FAILED] = 1.0
    elif fell:
        if abs(t1) >= HALF_TURN:
            result[lane, r.R_OVER_1] = time
        result[lane, r.R_OVER_2] = time
    else:
        topple(result, w, lane, slot, time, 0.0 if more is None else w[TOP_OFFSET // W, slot])
    result[lane, r.R_PEAK_1], result[lane, r.R_PEAK_2] = w[PEAK_1, slot], w[PEAK_2, slot]
    result[lane, r.R_UP_B], result[lane, r.R_UP_T] = h * w[UP_B, slot], h * w[UP_T, slot]
    result[lane, r.R_ONSET_B], result[lane, r.R_ONSET_T] = h * w[ONSET_B, slot], h * w[ONSET_T, slot]
    result[lane, r.R_SHARE_B] = 0.5 * w[SHARE_B, slot] / w[B1, slot]
    result[lane, r.R_SHARE_T] = 0.5 * w[SHARE_T, slot] / w[BT, slot]
    result[lane, r.R_CLOSED_B], result[lane, r.R_CLOSED_T] = w[CLOSED_B, slot], w[CLOSED_T, slot]
    result[lane, r.R_LOST_B] = -0.5 * h * w[WORK_B, slot]
    result[lane, r.R_LOST_T] = -0.5 * h * w[WORK_T, slot]
    result[lane, r.R_EDGE_B], result[lane, r.R_EDGE_T] = w[r.EDGE_B, slot], w[r.EDGE_T, slot]
    result[lane, r.R_FRICTION_B] = ratio(w[ALONG_B, slot], w[ACROSS_B, slot])
    result[lane, r.R_FRICTION_T] = ratio(w[ALONG_T, slot], w[ACROSS_T, slot])
    result[lane, r.R_END_1], result[lane, r.R_END_2] = t1, t2
    result[lane, r.R_END_Z1], result[lane, r.R_END_Z2] = w[Z1, slot], w[Z2, slot]
    if laws is not None:
        fibres_at_end(w.reshape(w.size), rubber, lane, slot)
    if more is not None:
        effects.put_on_record(w.reshape(w.size), more, lane, slot)


@inlined
def at_rest(w: Table, slot: int, calm: float) -> bool:
    """Whether the kinetic energy stayed under its share ``calm`` of the peak; begins the next window."""
    w[KINETIC, slot] = max(w[KINETIC, slot], w[WINDOW, slot])
    still = w[WINDOW, slot] <= calm * w[KINETIC, slot]
    w[WINDOW, slot] = 0.0
    return bool(still)


@inlined
def load(w: Table, slot: int, record: Table, sample: int, shaken: int, n: float) -> None:
    """The record's values at ``sample`` and their growth over each of the n steps that follow."""
    for row in range(2):
        # beyond the record's last sample the base is at rest: it may jump there
        value = record[row, sample] if sample < shaken else 0.0
        growth = (record[row, sample + 1] - record[row, sample]) / n if sample < shaken else 0.0
        w[RA + row, slot], w[GROWTH_A + row, slot] = value, growth
