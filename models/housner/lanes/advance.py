"""The lane kernel of one block: W lanes under way, each at its own step of the record.

A lane that ends makes room for the next one; a lane at rest jumps to its next onset. The loop over
the W lanes has no branches and becomes vector code; lanes in which something happens during a step
are redone one by one from the start of that step (`models.housner.lanes.events`).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from models.housner.lanes import rows as r
from models.housner.lanes.equation import acceleration, rk4
from models.housner.lanes.events import one_step
from models.housner.lanes.onset import next_onset
from models.housner.lanes.regimes.flexure import relax
from models.housner.lanes.regimes.flight import shift
from models.housner.lanes.step import hermite_root, inputs, raise_peak, stand_on, start_at
from models.lanes.arrays import Counts, Record, Table, Tables
from models.lanes.compiler import called, compiled, inlined
from models.lanes.events import note, turning_point

HALF_TURN = 0.5 * math.pi


@inlined
def step_all(w: Table, h: float, general: Any, linear: Any) -> int:
    """One step of all W lanes without events; returns how many need attention."""
    flagged = 0
    for lane in range(r.W):
        theta, omega = w[r.TH, lane], w[r.OM, lane]
        scale = w[r.SCALE, lane]
        a0, g0 = w[r.A0, lane], w[r.G0, lane]
        a1 = scale * w[r.RA, lane] + w[r.OFFSET, lane]
        g1 = w[r.GRAVITY, lane] + w[r.VSCALE, lane] * w[r.RV, lane]
        p0, p1, q0, q1 = 0.0, 0.0, 0.0, 0.0
        if general is not None:
            p0, q0 = w[r.P0, lane], w[r.PP0, lane]
            p1, q1 = w[r.PITCH, lane] * w[r.RP, lane], w[r.PITCH, lane] * w[r.RPP, lane]
        begun = w[r.START, lane]
        step = h - h * begun
        th1, om1, demand, work = rk4(w, lane, theta, omega, step, a0, a1, g0, g1, p0, p1, q0, q1, general, linear)
        w[r.START0, lane] = begun
        w[r.START, lane] = 0.0
        w[r.TH0, lane] = theta
        w[r.OM0, lane] = omega
        w[r.TH, lane] = th1
        w[r.OM, lane] = om1
        w[r.A0, lane] = a1
        w[r.G0, lane] = g1
        # a lane that does not rock carries a limit of -1
        w[r.DEMAND, lane] = max(w[r.DEMAND, lane], demand if w[r.LIMIT, lane] > 0.0 else 0.0)
        if general is not None:
            w[r.P0, lane], w[r.PP0, lane] = p1, q1
            w[r.WORK, lane] += work
            w[r.WORK_STEP, lane] = work
        goes_on = (omega * om1 >= 0.0) | (abs(th1) + step * abs(om1) < w[r.TURN, lane])
        steady = (abs(th1) < w[r.LIMIT, lane]) & (w[r.SIDE, lane] * th1 >= 0.0) & goes_on
        w[r.FLAG, lane] = 0.0 if steady else 1.0
        flagged += 0 if steady else 1
    return flagged


@inlined
def load_inputs(w: Table, slot: int, record: Table, i: int) -> None:
    """The inputs at the start of step i, for a lane that has jumped."""
    start_at(w, slot, record, i, 0.0)
    w[r.ROUNDS, slot] = 0.0


@called
def start(given: Table, result: Table, w: Table, lane: int, slot: int, time: float, linear: Any) -> None:
    """Put a lane in a slot, in its initial state."""
    w[r.SCALE, slot] = given[lane, r.Q_SCALE]
    w[r.OFFSET, slot] = given[lane, r.Q_OFFSET]
    w[r.GRAVITY, slot] = given[lane, r.Q_GRAVITY]
    w[r.VSCALE, slot] = given[lane, r.Q_VSCALE]
    w[r.RHO, slot] = given[lane, r.Q_RHO]
    w[r.CRUSH, slot] = given[lane, r.Q_CRUSH]
    w[r.JOINT, slot] = given[lane, r.Q_JOINT]
    w[r.K, slot] = given[lane, r.Q_K] / given[lane, r.Q_MASS]
    w[r.GAP, slot] = given[lane, r.Q_GAP]
    w[r.VISCOUS, slot] = given[lane, r.Q_VISCOUS]
    w[r.COULOMB, slot] = given[lane, r.Q_COULOMB] / given[lane, r.Q_MASS]
    w[r.QUADRATIC, slot] = given[lane, r.Q_QUADRATIC]
    w[r.PITCH, slot] = given[lane, r.Q_PITCH] * given[lane, r.Q_SCALE]
    w[r.DEMAND, slot], w[r.WORK, slot], w[r.WORK_STEP, slot] = 0.0, 0.0, 0.0
    for k in range(given.shape[1] - r.N_GIVEN):
        w[r.TABLE + k, slot] = given[lane, r.N_GIVEN + k]
    theta, omega = given[lane, r.Q_THETA], given[lane, r.Q_OMEGA]
    w[r.TH, slot], w[r.OM, slot] = theta, omega
    w[r.PEAK, slot] = max(given[lane, r.Q_PEAK], abs(theta))
    stops = given[lane, r.Q_COULOMB] > 0.0 or given.shape[1] > r.N_GIVEN
    w[r.STOPS, slot] = 1.0 if stops else 0.0
    every_swing = given[lane, r.Q_EXPONENT] != 0.0 or stops
    w[r.TURN, slot] = -1.0 if every_swing else w[r.PEAK, slot]
    side = 1.0 if theta > 0.0 or (theta == 0.0 and omega >= 0.0) else -1.0
    stand_on(given, w, lane, slot, side, linear)
    w[r.DIRECTION, slot] = -side if omega * side < 0.0 else side
    for row in range(result.shape[1]):
        result[lane, row] = 0.0
    result[lane, r.R_PEAK] = w[r.PEAK, slot]
    result[lane, r.R_SWING] = max(given[lane, r.Q_SWING], abs(theta))
    result[lane, r.R_IMPACTS] = given[lane, r.Q_IMPACTS]
    result[lane, r.R_ONSET], result[lane, r.R_OVERTURNED_AT], result[lane, r.R_UP_SINCE] = math.nan, math.nan, math.nan
    for row in (r.U, r.U1, r.Z, r.Z1):
        w[row, slot] = 0.0
    if theta == 0.0 and omega == 0.0:
        result[lane, r.R_MODE] = r.RINGING if given[lane, r.Q_FREQUENCY] < math.inf else r.DOWN
    else:
        result[lane, r.R_UP_SINCE] = time
        holds = stops and not given[lane, r.Q_FREQUENCY] < math.inf
        result[lane, r.R_MODE] = r.HELD if omega == 0.0 and holds else r.UP


@inlined
def watch(given: Table, result: Table, w: Table, lane: int, slot: int, shaken: bool) -> None:
    """Set the rotation beyond which the lane needs attention (always, unless it rocks as a rigid block that sticks)."""
    special = given[lane, r.Q_FRICTION] < math.inf or given[lane, r.Q_FREQUENCY] < math.inf
    if result[lane, r.R_MODE] != r.UP or special:
        w[r.LIMIT, slot] = -1.0
    else:
        w[r.LIMIT, slot] = HALF_TURN if shaken else min(HALF_TURN, given[lane, r.Q_ALPHA])


@called
def finish(given: Table, result: Table, w: Table, lane: int, slot: int, time: float) -> None:
    """Close the account of a lane that ends at ``time``."""
    since = result[lane, r.R_UP_SINCE]
    if since == since:
        result[lane, r.R_UPLIFT] += time - since
    theta = w[r.TH, slot]
    result[lane, r.R_ROTATION] = theta
    result[lane, r.R_PEAK] = max(result[lane, r.R_PEAK], abs(theta))
    result[lane, r.R_SWING] = max(result[lane, r.R_SWING], abs(theta))
    result[lane, r.R_DEMAND] = w[r.DEMAND, slot]
    result[lane, r.R_DISSIPATED] += given[lane, r.Q_MASS] * w[r.WORK, slot]
    result[lane, r.R_IMPACTS] -= given[lane, r.Q_IMPACTS]
    at = result[lane, r.R_OVERTURNED_AT]
    if at == at:
        result[lane, r.R_PEAK] = HALF_TURN
        result[lane, r.R_ROTATION] = HALF_TURN if theta > 0.0 else -HALF_TURN
        result[lane, r.R_STATUS] = r.OVERTURNED
    elif not theta == theta:
        result[lane, r.R_STATUS] = r.NOT_CONVERGED
    elif result[lane, r.R_STATUS] != r.NOT_CONVERGED:
        moved = result[lane, r.R_ONSET] == result[lane, r.R_ONSET] or result[lane, r.R_PEAK] > 0.0
        result[lane, r.R_STATUS] = r.ROCKING if moved else r.REST


@inlined
def attend(
    given: Table, result: Table, w: Table, lane: int, slot: int, record: Table, i: int, h: float, shaken: bool,
    fall: bool, log: Table, count: Counts, general: Any, linear: Any,
) -> bool:  # fmt: skip
    """What a flagged lane needs after step i; True when it ends (overturned, or not a number)."""
    begun = w[r.START0, slot]
    theta, omega = w[r.TH0, slot], w[r.OM0, slot]
    th1, om1 = w[r.TH, slot], w[r.OM, slot]
    known = result[lane, r.R_OVERTURNED_AT]
    # a limit of -1: the step of the vector loop does not count
    stepped = w[r.LIMIT, slot] > 0.0 and result[lane, r.R_MODE] == r.UP
    turned_only = stepped and w[r.SIDE, slot] * th1 >= 0.0 and abs(th1) < HALF_TURN
    if turned_only and (omega * om1 >= 0.0 or w[r.STOPS, slot] == 0.0):
        if omega * om1 < 0.0:
            raise_peak(result, w, lane, slot, turning_point(theta, omega, th1, om1, (1.0 - begun) * h))
    elif not abs(th1) < HALF_TURN and stepped and abs(theta) > 1.0:
        # through pi/2 (a step never crosses zero from beyond 1 rad)
        side = 1.0 if th1 > 0.0 else -1.0
        f = hermite_root(theta - side * HALF_TURN, omega, th1 - side * HALF_TURN, om1, (1.0 - begun) * h)
        if not known == known:
            result[lane, r.R_OVERTURNED_AT] = (i + begun + (1.0 - begun) * min(1.0, max(0.0, f))) * h
    else:
        w[r.WORK, slot] -= w[r.WORK_STEP, slot]
        one_step(given, result, w, lane, slot, record, i, h, log, count, general, linear)
        before, theta = abs(theta), abs(w[r.TH, slot])
        if theta >= HALF_TURN and not known == known:
            result[lane, r.R_OVERTURNED_AT] = (i + (HALF_TURN - before) / (theta - before)) * h
    theta, omega = w[r.TH, slot], w[r.OM, slot]
    rocks = result[lane, r.R_MODE] == r.UP
    if rocks and not shaken and abs(theta) >= given[lane, r.Q_ALPHA] and omega * theta > 0.0:
        a, g, p, q = inputs(w, slot, record, i, 1.0)
        accel, _, _, _ = acceleration(w, slot, theta, omega, a, g, p, q, general, linear)
        if accel * theta > 0.0 and not known == known:
            result[lane, r.R_OVERTURNED_AT] = (i + 1) * h
    over = result[lane, r.R_OVERTURNED_AT]
    if over == over:
        if not known == known:
            note(log, count, lane, over, r.LOG_OVERTURNED, 1.0)
        return not fall or abs(theta) >= HALF_TURN
    return not theta == theta


@inlined
def keep(given: Table, result: Table, w: Table, trace: Any, lane: int, slot: int, k: int, general: Any) -> None:
    """Let the trace take the state of a lane as its sample ``k``, if it asks for so many."""
    if k < trace.shape[1]:
        trace[lane, k, 0] = w[r.TH, slot]
        trace[lane, k, 1] = w[r.OM, slot]
        if general is not None:
            trace[lane, k, 2] = shift(given, result, w, lane, slot)


@compiled
def advance(
    record: Record, first: Counts, last: Counts, given: Table, tables: Tables, every: int, fall: bool,
    general: Any, linear: Any,
) -> int:  # fmt: skip
    """Run every lane from step ``first`` to ``last`` (n,); returns the number of lane-steps computed.

    Channels of ``record``: a, a_z (m s-2), psi (rad) and psi'' (rad s-2) per unit of pitch, the flag of shaking.
    ``given`` (n, N_GIVEN): constants. ``tables.trace`` (n, m, 3) takes theta (rad), theta' (rad s-1) and the shift
    of the mass centre (m) every ``every`` steps (0: never).
    ``fall``: go on to pi/2 after overturning is certain (histories), instead of ending the lane.
    """
    samples, chunk, h, shaken_steps, _ = record
    result, trace, log, count = tables
    n = given.shape[0]
    w = np.zeros((r.N_WORK, r.W))
    at = np.zeros(r.W, np.int64)
    bound = np.zeros(r.W, np.int64)
    due = np.full(r.W, -1)  # the step at which the trace takes the lane's next state
    of = np.full(r.W, -1)
    waiting, active, steps = 0, 0, 0
    for slot in range(r.W):
        w[r.LIMIT, slot] = 1.0
    while True:
        # --- fill empty slots, settle lanes at a boundary
        active = 0
        for slot in range(r.W):
            lane = of[slot]
            if lane >= 0 and at[slot] < bound[slot] and result[lane, r.R_MODE] == r.UP:
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
                    if general is not None:
                        if given[lane, r.Q_FREQUENCY] < math.inf and result[lane, r.R_MODE] == r.UP:
                            relax(given, w, lane, slot, samples, at[slot], general, linear)
                    if every > 0:
                        keep(given, result, w, trace, lane, slot, 0, general)
                        due[slot] = at[slot] + every
                if result[lane, r.R_MODE] == r.DOWN:
                    at[slot] = next_onset(given, w, lane, slot, samples, at[slot], last[lane], chunk, linear)
                    while every > 0 and due[slot] <= at[slot]:
                        keep(given, result, w, trace, lane, slot, (due[slot] - first[lane]) // every, general)
                        due[slot] += every
                if at[slot] >= last[lane]:
                    finish(given, result, w, lane, slot, at[slot] * h)
                    lane = -1
                    continue
                load_inputs(w, slot, samples, at[slot])
                shaken = at[slot] < shaken_steps
                watch(given, result, w, lane, slot, shaken)
                bound[slot] = min(shaken_steps, last[lane]) if shaken else last[lane]
                break
            of[slot] = lane
            if lane < 0:
                w[r.TH, slot], w[r.OM, slot], w[r.SIDE, slot] = 0.0, 0.0, 1.0
                w[r.LIMIT, slot] = 1.0
                w[r.SCALE, slot], w[r.OFFSET, slot], w[r.A0, slot] = 0.0, 0.0, 0.0
                w[r.CB, slot], w[r.CH, slot], w[r.B, slot], w[r.K, slot] = (
                    0.0,
                    0.0,
                    0.0,
                    0.0,
                )
                w[r.START, slot], w[r.TURN, slot] = 0.0, 0.0
                w[r.STOPS, slot], w[r.COULOMB, slot] = 0.0, 0.0
                w[r.PITCH, slot], w[r.IM, slot] = 0.0, 1.0
                at[slot] = 0
            else:
                active += 1
        if active == 0:
            return steps
        # --- common steps until the first boundary, or until a lane has to be settled
        common = 1 << 62
        for slot in range(r.W):
            if of[slot] >= 0:
                common = min(common, bound[slot] - at[slot])
        settle = False
        for _ in range(common):
            for slot in range(r.W):
                # unsigned: no code for negative indices
                i = np.uint64(at[slot] + 1)
                w[r.RA, slot] = samples[0, i]
                w[r.RV, slot] = samples[1, i]
                if general is not None:
                    w[r.RP, slot] = samples[2, i]
                    w[r.RPP, slot] = samples[3, i]
                at[slot] += 1
            flagged = step_all(w, h, general, linear)
            steps += active
            if flagged > 0:
                for slot in range(r.W):
                    if w[r.FLAG, slot] != 0.0 and of[slot] >= 0:
                        lane = of[slot]
                        i = at[slot] - 1
                        over = attend(
                            given, result, w, lane, slot, samples, i, h, i < shaken_steps, fall, log, count,
                            general, linear,
                        )  # fmt: skip
                        if over:
                            finish(given, result, w, lane, slot, result[lane, r.R_OVERTURNED_AT])
                            of[slot] = -1
                            settle = True
                        elif w[r.START, slot] > 0.0:
                            # an impact inside the step: the rest of it is the lane's next step
                            at[slot] = i
                        elif result[lane, r.R_MODE] == r.DOWN:
                            settle = True
                        elif result[lane, r.R_MODE] != r.UP or w[r.LIMIT, slot] < 0.0:
                            watch(given, result, w, lane, slot, i + 1 < shaken_steps)
            if every > 0:
                for slot in range(r.W):
                    if at[slot] == due[slot] and of[slot] >= 0:
                        k = (due[slot] - first[of[slot]]) // every
                        keep(given, result, w, trace, of[slot], slot, k, general)
                        due[slot] += every
            if settle:
                break
