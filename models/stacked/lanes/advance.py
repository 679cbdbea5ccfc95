"""The lane kernel of two stacked blocks: W lanes under way, each at its own step of the record.

A lane that ends makes room for the next one; a lane at rest jumps to its next onset. The loop over
the W lanes has no branches and becomes vector code; lanes in which something happens during a step
are redone one by one from the start of that step (`models.stacked.lanes.events`).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from models.lanes.compiler import compiled, inlined
from models.stacked.lanes.attend import attend, finish, load, start, watch
from models.stacked.lanes.equation import contact, rk4
from models.stacked.lanes.locate import next_onset
from models.stacked.lanes.rows import (
    A0,
    DEMAND_1,
    DEMAND_2,
    FLAG,
    FREE_1,
    FREE_2,
    G0,
    GRAVITY,
    J1,
    J2,
    LIMIT_1,
    LIMIT_2,
    MARGIN_1,
    MARGIN_2,
    N_WORK,
    OFFSET,
    Q1,
    Q1S,
    Q2,
    Q2S,
    R_CLOSED,
    RA,
    RV,
    SCALE,
    V1,
    V1S,
    V2,
    V2S,
    VSCALE,
    WORK,
    WORK_STEP,
    X1,
    X1S,
    X2,
    X2S,
    W,
)  # fmt: skip

Table = Any


@inlined
def step_all(w: Table, h: float, linear: Any) -> int:
    """One step of all W lanes without events; returns how many need attention."""
    flagged = 0
    for lane in range(W):
        q1, q2, v1, v2 = w[Q1 * W + lane], w[Q2 * W + lane], w[V1 * W + lane], w[V2 * W + lane]
        a0, g0 = w[A0 * W + lane], w[G0 * W + lane]
        a1 = w[SCALE * W + lane] * w[RA * W + lane] + w[OFFSET * W + lane]
        g1 = w[GRAVITY * W + lane] + w[VSCALE * W + lane] * w[RV * W + lane]
        x1s, x2s = w[X1 * W + lane], w[X2 * W + lane]
        p1, p2, u1, u2, work = rk4(w, lane, q1, q2, v1, v2, x1s, x2s, h, a0, a1, g0, g1, linear)
        x1, x2, m1, m2, d1, d2 = contact(w, lane, p1, p2, u1, u2, a1, g1, linear)
        w[Q1S * W + lane], w[Q2S * W + lane] = q1, q2
        w[V1S * W + lane], w[V2S * W + lane] = v1, v2
        w[X1S * W + lane], w[X2S * W + lane] = x1s, x2s
        w[Q1 * W + lane], w[Q2 * W + lane] = p1, p2
        w[V1 * W + lane], w[V2 * W + lane] = u1, u2
        w[X1 * W + lane], w[X2 * W + lane] = x1, x2
        w[A0 * W + lane], w[G0 * W + lane] = a1, g1
        w[WORK * W + lane] += work
        w[WORK_STEP * W + lane] = work
        w[MARGIN_1 * W + lane], w[MARGIN_2 * W + lane] = m1, m2
        # written so that a number that is none asks for attention
        calm = (m1 >= 0.0) & (m2 >= 0.0) & (w[LIMIT_1 * W + lane] > 0.0)
        w[DEMAND_1 * W + lane] = max(w[DEMAND_1 * W + lane], d1 if calm else 0.0)
        w[DEMAND_2 * W + lane] = max(w[DEMAND_2 * W + lane], d2 if calm else 0.0)
        within = (abs(p1) < w[LIMIT_1 * W + lane]) & (abs(p1 + p2) < w[LIMIT_2 * W + lane])
        steady = calm & within & (v1 * u1 >= 0.0) & ((v1 + v2) * (u1 + u2) >= 0.0)
        w[FLAG * W + lane] = 0.0 if steady else 1.0
        flagged += 0 if steady else 1
    return flagged


@inlined
def vacate(w: Table, slot: int) -> None:
    """An empty slot steps through zeros without asking for attention."""
    for row in range(N_WORK):
        w[row * W + slot] = 0.0
    w[J1 * W + slot], w[J2 * W + slot], w[GRAVITY * W + slot] = 1.0, 1.0, 1.0
    w[FREE_1 * W + slot], w[FREE_2 * W + slot] = 1.0, 1.0
    w[LIMIT_1 * W + slot], w[LIMIT_2 * W + slot] = 1.0, 1.0


@compiled
def advance(
    record: Table, chunk: Table, h: float, shaken_steps: int, first: Table, last: Table,
    given: Table, result: Table, every: int, trace: Table, log: Table, count: Table, fall: bool, linear: Any,
) -> int:  # fmt: skip
    """Run every lane from step ``first`` to ``last``; returns the number of lane-steps computed.

    ``record`` (3, n): a and a_z at the ends of the steps of length ``h``, and 1 for the steps of the
    shaking, which ends at ``shaken_steps``. ``trace`` (n, m, 4) takes theta_1, r and their rates every
    ``every`` steps (0: never). ``fall``: go on to pi/2 after overturning is certain (histories),
    instead of ending the lane.
    """
    n = given.shape[0]
    w = np.zeros(N_WORK * W)
    system = np.zeros((4, 5))
    kept = np.zeros((W, result.shape[1]))
    at = np.zeros(W, np.int64)
    bound = np.zeros(W, np.int64)
    of = np.full(W, -1)
    waiting, steps = 0, 0
    while True:
        # --- fill empty slots, settle lanes at a boundary
        active = 0
        for slot in range(W):
            lane = of[slot]
            if lane >= 0 and at[slot] < bound[slot] and result[lane, R_CLOSED] == 0.0:
                active += 1
                continue
            jumped = False
            while True:
                if lane < 0:
                    if waiting == n:
                        break
                    lane = waiting
                    waiting += 1
                    at[slot] = first[lane]
                    start(given, result, w, lane, slot, first[lane] * h)
                    bound[slot] = at[slot]
                    jumped = True
                if every > 0 and at[slot] == bound[slot] and (at[slot] - first[lane]) % every == 0:
                    k = (at[slot] - first[lane]) // every
                    if k < trace.shape[1]:
                        trace[lane, k, 0], trace[lane, k, 1] = w[Q1 * W + slot], w[Q2 * W + slot]
                        trace[lane, k, 2], trace[lane, k, 3] = w[V1 * W + slot], w[V2 * W + slot]
                if result[lane, R_CLOSED] != 0.0:
                    at[slot] = next_onset(given, w, lane, slot, record, at[slot], last[lane], chunk)
                    jumped = True
                if at[slot] >= last[lane]:
                    finish(given, result, kept, w, lane, slot, at[slot] * h)
                    lane = -1
                    continue
                shaken = at[slot] < shaken_steps
                load(w, slot, record, at[slot], linear)
                watch(given, w, lane, slot, shaken)
                if jumped or at[slot] == shaken_steps:
                    # the ground may jump here: the closed joints must answer
                    w[LIMIT_1 * W + slot] = -1.0
                bound[slot] = min(shaken_steps, last[lane]) if shaken else last[lane]
                if every > 0:
                    bound[slot] = min(bound[slot], at[slot] + every - (at[slot] - first[lane]) % every)
                break
            of[slot] = lane
            if lane < 0:
                vacate(w, slot)
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
                at[slot] += 1
            flagged = step_all(w, h, linear)
            steps += active
            if flagged > 0:
                for slot in range(W):
                    if w[FLAG * W + slot] != 0.0 and of[slot] >= 0:
                        lane = of[slot]
                        i = at[slot] - 1
                        shaken = i + 1 < shaken_steps
                        over = attend(
                            given, result, kept, w, system, lane, slot, record, i, h, shaken, fall, log, count, linear
                        )
                        if not math.isnan(over):
                            finish(given, result, kept, w, lane, slot, over)
                            of[slot] = -1
                            settle = True
                        elif result[lane, R_CLOSED] != 0.0:
                            settle = True
                        elif w[LIMIT_1 * W + slot] < 0.0:
                            watch(given, w, lane, slot, shaken)
            if settle:
                break
