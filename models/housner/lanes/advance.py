"""The lane kernel of one block: W lanes under way, each at its own step of the record.

A lane that ends makes room for the next one; a lane at rest jumps to its next onset. The loop over
the W lanes has no branches and becomes vector code; lanes in which something happens during a step
are redone one by one from the start of that step (`models.housner.lanes.events`).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from models.housner.lanes.equation import acceleration, rk4
from models.housner.lanes.events import (
    hermite_root,
    inputs,
    next_onset,
    note,
    one_step,
    raise_peak,
    stand_on,
    turning_point,
)
from models.housner.lanes.rows import (
    A0,
    CB,
    CH,
    COULOMB,
    CRUSH,
    DEMAND,
    DIRECTION,
    DOWN,
    FLAG,
    G0,
    GAP,
    GRAVITY,
    HELD,
    IM,
    JOINT,
    LIMIT,
    LOG_OVERTURNED,
    N_WORK,
    NOT_CONVERGED,
    OFFSET,
    OM,
    OM0,
    OVERTURNED,
    P0,
    PEAK,
    PITCH,
    PP0,
    Q_ALPHA,
    Q_COULOMB,
    Q_CRUSH,
    Q_GAP,
    Q_GRAVITY,
    Q_IMPACTS,
    Q_JOINT,
    Q_K,
    Q_MASS,
    Q_OFFSET,
    Q_OMEGA,
    Q_PEAK,
    Q_PITCH,
    Q_QUADRATIC,
    Q_RHO,
    Q_SCALE,
    Q_THETA,
    Q_VISCOUS,
    Q_VSCALE,
    QUADRATIC,
    R_DEMAND,
    R_DISSIPATED,
    R_IMPACTS,
    R_MODE,
    R_ONSET,
    R_OVERTURNED_AT,
    R_PEAK,
    R_ROTATION,
    R_STATUS,
    R_SWING,
    R_UP_SINCE,
    R_UPLIFT,
    RA,
    REST,
    RHO,
    ROCKING,
    RP,
    RPP,
    RV,
    SCALE,
    SIDE,
    TH,
    TH0,
    UP,
    VISCOUS,
    VSCALE,
    WORK,
    WORK_STEP,
    B,
    K,
    W,
)  # fmt: skip
from models.lanes.compiler import called, compiled, inlined

Table = Any
HALF_TURN = 0.5 * math.pi


@inlined
def step_all(w: Table, h: float, general: Any, linear: Any) -> int:
    """One step of all W lanes without events; returns how many need attention."""
    flagged = 0
    for lane in range(W):
        theta, omega = w[TH * W + lane], w[OM * W + lane]
        scale = w[SCALE * W + lane]
        a0, g0 = w[A0 * W + lane], w[G0 * W + lane]
        a1 = scale * w[RA * W + lane] + w[OFFSET * W + lane]
        g1 = w[GRAVITY * W + lane] + w[VSCALE * W + lane] * w[RV * W + lane]
        p0, p1, q0, q1 = 0.0, 0.0, 0.0, 0.0
        if general is not None:
            p0, q0 = w[P0 * W + lane], w[PP0 * W + lane]
            p1, q1 = w[PITCH * W + lane] * w[RP * W + lane], w[PITCH * W + lane] * w[RPP * W + lane]
        th1, om1, demand, work = rk4(w, lane, theta, omega, h, a0, a1, g0, g1, p0, p1, q0, q1, general, linear)
        w[TH0 * W + lane] = theta
        w[OM0 * W + lane] = omega
        w[TH * W + lane] = th1
        w[OM * W + lane] = om1
        w[A0 * W + lane] = a1
        w[G0 * W + lane] = g1
        # a lane that does not rock carries a limit of -1
        w[DEMAND * W + lane] = max(w[DEMAND * W + lane], demand if w[LIMIT * W + lane] > 0.0 else 0.0)
        if general is not None:
            w[P0 * W + lane], w[PP0 * W + lane] = p1, q1
            w[WORK * W + lane] += work
            w[WORK_STEP * W + lane] = work
        steady = (abs(th1) < w[LIMIT * W + lane]) & (w[SIDE * W + lane] * th1 >= 0.0) & (omega * om1 >= 0.0)
        w[FLAG * W + lane] = 0.0 if steady else 1.0
        flagged += 0 if steady else 1
    return flagged


@inlined
def load_inputs(w: Table, slot: int, record: Table, i: int) -> None:
    """The inputs at the start of step i, for a lane that has jumped."""
    a, g, p, q = inputs(w, slot, record, i, 0.0)
    w[A0 * W + slot], w[G0 * W + slot] = a, g
    w[P0 * W + slot], w[PP0 * W + slot] = p, q


@called
def start(given: Table, result: Table, w: Table, lane: int, slot: int, time: float, linear: Any) -> None:
    """Put a lane in a slot, in its initial state."""
    w[SCALE * W + slot] = given[lane, Q_SCALE]
    w[OFFSET * W + slot] = given[lane, Q_OFFSET]
    w[GRAVITY * W + slot] = given[lane, Q_GRAVITY]
    w[VSCALE * W + slot] = given[lane, Q_VSCALE]
    w[RHO * W + slot] = given[lane, Q_RHO]
    w[CRUSH * W + slot] = given[lane, Q_CRUSH]
    w[JOINT * W + slot] = given[lane, Q_JOINT]
    w[K * W + slot] = given[lane, Q_K] / given[lane, Q_MASS]
    w[GAP * W + slot] = given[lane, Q_GAP]
    w[VISCOUS * W + slot] = given[lane, Q_VISCOUS]
    w[COULOMB * W + slot] = given[lane, Q_COULOMB] / given[lane, Q_MASS]
    w[QUADRATIC * W + slot] = given[lane, Q_QUADRATIC]
    w[PITCH * W + slot] = given[lane, Q_PITCH] * given[lane, Q_SCALE]
    w[DEMAND * W + slot], w[WORK * W + slot], w[WORK_STEP * W + slot] = 0.0, 0.0, 0.0
    theta, omega = given[lane, Q_THETA], given[lane, Q_OMEGA]
    w[TH * W + slot], w[OM * W + slot] = theta, omega
    w[PEAK * W + slot] = max(given[lane, Q_PEAK], abs(theta))
    side = 1.0 if theta > 0.0 or (theta == 0.0 and omega >= 0.0) else -1.0
    stand_on(given, w, lane, slot, side, linear)
    w[DIRECTION * W + slot] = -side if omega * side < 0.0 else side
    for row in range(result.shape[1]):
        result[lane, row] = 0.0
    result[lane, R_PEAK] = w[PEAK * W + slot]
    result[lane, R_SWING] = abs(theta)
    result[lane, R_IMPACTS] = given[lane, Q_IMPACTS]
    result[lane, R_ONSET], result[lane, R_OVERTURNED_AT], result[lane, R_UP_SINCE] = math.nan, math.nan, math.nan
    if theta == 0.0 and omega == 0.0:
        result[lane, R_MODE] = DOWN
    else:
        result[lane, R_UP_SINCE] = time
        result[lane, R_MODE] = HELD if omega == 0.0 and given[lane, Q_COULOMB] > 0.0 else UP


@inlined
def watch(given: Table, result: Table, w: Table, lane: int, slot: int, shaken: bool) -> None:
    """Set the rotation beyond which the lane needs attention (always, unless it rocks)."""
    if result[lane, R_MODE] != UP:
        w[LIMIT * W + slot] = -1.0
    else:
        w[LIMIT * W + slot] = HALF_TURN if shaken else min(HALF_TURN, given[lane, Q_ALPHA])


@called
def finish(given: Table, result: Table, w: Table, lane: int, slot: int, time: float) -> None:
    """Close the account of a lane that ends at ``time``."""
    since = result[lane, R_UP_SINCE]
    if since == since:
        result[lane, R_UPLIFT] += time - since
    theta = w[TH * W + slot]
    result[lane, R_ROTATION] = theta
    result[lane, R_PEAK] = max(result[lane, R_PEAK], abs(theta))
    result[lane, R_DEMAND] = w[DEMAND * W + slot]
    result[lane, R_DISSIPATED] += given[lane, Q_MASS] * w[WORK * W + slot]
    result[lane, R_IMPACTS] -= given[lane, Q_IMPACTS]
    at = result[lane, R_OVERTURNED_AT]
    if at == at:
        result[lane, R_PEAK] = HALF_TURN
        result[lane, R_ROTATION] = HALF_TURN if theta > 0.0 else -HALF_TURN
        result[lane, R_STATUS] = OVERTURNED
    elif not theta == theta:
        result[lane, R_STATUS] = NOT_CONVERGED
    elif result[lane, R_STATUS] != NOT_CONVERGED:
        moved = result[lane, R_ONSET] == result[lane, R_ONSET] or result[lane, R_PEAK] > 0.0
        result[lane, R_STATUS] = ROCKING if moved else REST


@inlined
def attend(
    given: Table, result: Table, w: Table, lane: int, slot: int, record: Table, i: int, h: float, shaken: bool,
    fall: bool, log: Table, count: Table, general: Any, linear: Any,
) -> bool:  # fmt: skip
    """What a flagged lane needs after step i; True when it ends (overturned, or not a number)."""
    theta, omega = w[TH0 * W + slot], w[OM0 * W + slot]
    th1, om1 = w[TH * W + slot], w[OM * W + slot]
    known = result[lane, R_OVERTURNED_AT]
    turned_only = result[lane, R_MODE] == UP and w[SIDE * W + slot] * th1 >= 0.0 and abs(th1) < HALF_TURN
    if turned_only and (omega * om1 >= 0.0 or w[COULOMB * W + slot] == 0.0):
        if omega * om1 < 0.0:
            raise_peak(result, w, lane, slot, turning_point(theta, omega, th1, om1, h))
    elif not abs(th1) < HALF_TURN and result[lane, R_MODE] == UP and abs(theta) > 1.0:
        # through pi/2 (a step never crosses zero from beyond 1 rad)
        side = 1.0 if th1 > 0.0 else -1.0
        f = hermite_root(theta - side * HALF_TURN, omega, th1 - side * HALF_TURN, om1, h)
        if not known == known:
            result[lane, R_OVERTURNED_AT] = (i + min(1.0, max(0.0, f))) * h
    else:
        w[WORK * W + slot] -= w[WORK_STEP * W + slot]
        one_step(given, result, w, lane, slot, record, i, h, log, count, general, linear)
    theta, omega = w[TH * W + slot], w[OM * W + slot]
    if not shaken and abs(theta) >= given[lane, Q_ALPHA] and omega * theta > 0.0:
        a, g, p, q = inputs(w, slot, record, i, 1.0)
        accel, _, _, _ = acceleration(w, slot, theta, omega, a, g, p, q, general, linear)
        if accel * theta > 0.0 and not known == known:
            result[lane, R_OVERTURNED_AT] = (i + 1) * h
    over = result[lane, R_OVERTURNED_AT]
    if over == over:
        if not known == known:
            note(log, count, lane, over, LOG_OVERTURNED)
        return not fall or abs(theta) >= HALF_TURN
    return not theta == theta


@compiled
def advance(
    record: Table, chunk: Table, h: float, shaken_steps: int, first: Table, last: Table,
    given: Table, result: Table, every: int, trace: Table, log: Table, count: Table, fall: bool,
    general: Any, linear: Any,
) -> int:  # fmt: skip
    """Run every lane from step ``first`` to ``last``; returns the number of lane-steps computed.

    ``record`` (5, n): a, a_z, psi, psi'' at the ends of the steps of length ``h``, and 1 for the steps
    of the shaking, which ends at ``shaken_steps``. ``trace`` (n, m, 2) takes theta and theta' every ``every`` steps (0: never).
    ``fall``: go on to pi/2 after overturning is certain (histories), instead of ending the lane.
    """
    n = given.shape[0]
    w = np.zeros(N_WORK * W)
    at = np.zeros(W, np.int64)
    bound = np.zeros(W, np.int64)
    of = np.full(W, -1)
    waiting, active, steps = 0, 0, 0
    for slot in range(W):
        w[LIMIT * W + slot] = 1.0
    while True:
        # --- fill empty slots, settle lanes at a boundary
        active = 0
        for slot in range(W):
            lane = of[slot]
            if lane >= 0 and at[slot] < bound[slot] and result[lane, R_MODE] == UP:
                active += 1
                continue
            while True:
                if lane < 0:
                    if waiting == n:
                        break
                    lane = waiting
                    waiting += 1
                    at[slot] = first[lane]
                    start(given, result, w, lane, slot, first[lane] * h, linear)
                    bound[slot] = at[slot]
                if at[slot] == bound[slot]:
                    if every > 0 and (at[slot] - first[lane]) % every == 0:
                        k = (at[slot] - first[lane]) // every
                        if k < trace.shape[1]:
                            trace[lane, k, 0] = w[TH * W + slot]
                            trace[lane, k, 1] = w[OM * W + slot]
                if result[lane, R_MODE] == DOWN:
                    at[slot] = next_onset(given, w, lane, slot, record, at[slot], last[lane], chunk, linear)
                if at[slot] >= last[lane]:
                    finish(given, result, w, lane, slot, at[slot] * h)
                    lane = -1
                    continue
                load_inputs(w, slot, record, at[slot])
                shaken = at[slot] < shaken_steps
                watch(given, result, w, lane, slot, shaken)
                bound[slot] = min(shaken_steps, last[lane]) if shaken else last[lane]
                if every > 0:
                    bound[slot] = min(bound[slot], at[slot] + every - (at[slot] - first[lane]) % every)
                break
            of[slot] = lane
            if lane < 0:
                w[TH * W + slot], w[OM * W + slot], w[SIDE * W + slot] = 0.0, 0.0, 1.0
                w[LIMIT * W + slot] = 1.0
                w[SCALE * W + slot], w[OFFSET * W + slot], w[A0 * W + slot] = 0.0, 0.0, 0.0
                w[CB * W + slot], w[CH * W + slot], w[B * W + slot], w[K * W + slot] = 0.0, 0.0, 0.0, 0.0
                w[COULOMB * W + slot], w[PITCH * W + slot], w[IM * W + slot] = 0.0, 0.0, 1.0
                at[slot] = 0
            else:
                active += 1
        if active == 0:
            return steps
        # --- common steps until the first boundary, or until a lane has to be settled
        common = 1 << 62
        for slot in range(W):
            if of[slot] >= 0:
                common = min(common, bound[slot] - at[slot])
        settle = False
        for _ in range(common):
            for slot in range(W):
                # unsigned: no code for negative indices
                i = np.uint64(at[slot] + 1)
                w[RA * W + slot] = record[0, i]
                w[RV * W + slot] = record[1, i]
                if general is not None:
                    w[RP * W + slot] = record[2, i]
                    w[RPP * W + slot] = record[3, i]
                at[slot] += 1
            flagged = step_all(w, h, general, linear)
            steps += active
            if flagged > 0:
                for slot in range(W):
                    if w[FLAG * W + slot] != 0.0 and of[slot] >= 0:
                        lane = of[slot]
                        i = at[slot] - 1
                        over = attend(
                            given, result, w, lane, slot, record, i, h, i < shaken_steps, fall, log, count,
                            general, linear,
                        )  # fmt: skip
                        if over:
                            finish(given, result, w, lane, slot, result[lane, R_OVERTURNED_AT])
                            of[slot] = -1
                            settle = True
                        elif result[lane, R_MODE] != UP:
                            settle = True
                        elif w[LIMIT * W + slot] < 0.0:
                            watch(given, result, w, lane, slot, i + 1 < shaken_steps)
            if settle:
                break
