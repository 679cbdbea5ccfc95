"""The lane kernel of two stacked blocks: W lanes under way, each at its own step of the record.

A lane that ends makes room for the next one; a lane at rest jumps to its next onset. The loop over
the W lanes has no branches and becomes vector code; lanes in which something happens during a step
are redone one by one from the start of that step (`models.stacked.lanes.events`).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from models.lanes.arrays import Counts, Record, Table, Tables
from models.lanes.compiler import compiled, inlined
from models.stacked.lanes import rows as r
from models.stacked.lanes.attend import attend, finish, load, start, watch
from models.stacked.lanes.equation import contact, rk4
from models.stacked.lanes.friction import goes_on
from models.stacked.lanes.locate import next_onset


@inlined
def step_all(w: Table, h: float, linear: Any, general: Any) -> int:
    """One step of all W lanes without events; returns how many need attention."""
    flagged = 0
    for lane in range(r.W):
        q1, q2, v1, v2 = w[r.Q1, lane], w[r.Q2, lane], w[r.V1, lane], w[r.V2, lane]
        a0, g0 = w[r.A0, lane], w[r.G0, lane]
        a1 = w[r.SCALE, lane] * w[r.RA, lane] + w[r.OFFSET, lane]
        g1 = w[r.GRAVITY, lane] + w[r.VSCALE, lane] * w[r.RV, lane]
        x1s, x2s = w[r.X1, lane], w[r.X2, lane]
        pitch, turning1, pushed = None, None, a1
        if general is not None:
            psi0, turning0 = w[r.PSI0, lane], w[r.TURNING0, lane]
            psi1, turning1 = w[r.PITCH, lane] * w[r.RP, lane], w[r.PITCH, lane] * w[r.RPP, lane]
            pushed = a1 - g1 * psi1
            w[r.PSI0, lane], w[r.TURNING0, lane] = psi1, turning1
            pitch = psi0, psi1, turning0, turning1
        p1, p2, u1, u2, work = rk4(w, lane, q1, q2, v1, v2, x1s, x2s, h, a0, a1, g0, g1, pitch, linear)
        x1, x2, m1, m2, d1, d2 = contact(w, lane, p1, p2, u1, u2, pushed, g1, turning1, linear)
        w[r.Q1S, lane], w[r.Q2S, lane] = q1, q2
        w[r.V1S, lane], w[r.V2S, lane] = v1, v2
        w[r.X1S, lane], w[r.X2S, lane] = x1s, x2s
        w[r.Q1, lane], w[r.Q2, lane] = p1, p2
        w[r.V1, lane], w[r.V2, lane] = u1, u2
        w[r.X1, lane], w[r.X2, lane] = x1, x2
        w[r.A0, lane], w[r.G0, lane] = a1, g1
        w[r.WORK, lane] += work
        w[r.WORK_STEP, lane] = work
        w[r.MARGIN_1, lane], w[r.MARGIN_2, lane] = m1, m2
        onward = True
        if general is not None:
            onward = goes_on(w[r.OPPOSING, lane], v1, x1s, u1, x1, h)
        # written so that a number that is none asks for attention
        calm = (m1 >= 0.0) & (m2 >= 0.0) & onward & (w[r.LIMIT_1, lane] > 0.0)
        w[r.DEMAND_1, lane] = max(w[r.DEMAND_1, lane], d1 if calm else 0.0)
        w[r.DEMAND_2, lane] = max(w[r.DEMAND_2, lane], d2 if calm else 0.0)
        within = (abs(p1) < w[r.LIMIT_1, lane]) & (abs(p1 + p2) < w[r.LIMIT_2, lane])
        steady = calm & within & (v1 * u1 >= 0.0) & ((v1 + v2) * (u1 + u2) >= 0.0)
        w[r.FLAG, lane] = 0.0 if steady else 1.0
        flagged += 0 if steady else 1
    return flagged


@inlined
def vacate(w: Table, slot: int) -> None:
    """An empty slot steps through zeros without asking for attention."""
    for row in range(r.N_WORK):
        w[row, slot] = 0.0
    w[r.J1, slot], w[r.J2, slot], w[r.GRAVITY, slot] = 1.0, 1.0, 1.0
    w[r.FREE_1, slot], w[r.FREE_2, slot] = 1.0, 1.0
    w[r.LIMIT_1, slot], w[r.LIMIT_2, slot] = 1.0, 1.0


@compiled
def advance(
    record: Record, first: Counts, last: Counts, given: Table, tables: Tables, every: int, fall: bool, linear: Any,
    general: Any,
) -> int:  # fmt: skip
    """Run every lane from step ``first`` to ``last`` (n,); returns the number of lane-steps computed.

    Channels of ``record``: a, a_z (m s-2), psi (rad), psi'' (rad s-2) per unit of pitch, the flag of shaking.
    ``given`` (n, N_GIVEN): constants.
    ``tables.trace`` (n, m, 4) takes theta_1, r (rad) and their rates (rad s-1) every ``every`` steps (0: never).
    ``fall``: go on to pi/2 after overturning is certain (histories), instead of ending the lane.
    """
    samples, chunk, h, shaken_steps, _ = record
    result, trace, log, count = tables
    n = given.shape[0]
    w = np.zeros((r.N_WORK, r.W))
    system = np.zeros((4, 5))
    kept = np.zeros((r.W, result.shape[1]))
    at = np.zeros(r.W, np.int64)
    bound = np.zeros(r.W, np.int64)
    of = np.full(r.W, -1)
    waiting, steps = 0, 0
    while True:
        # --- fill empty slots, settle lanes at a boundary
        active = 0
        for slot in range(r.W):
            lane = of[slot]
            if lane >= 0 and at[slot] < bound[slot] and result[lane, r.R_CLOSED] == 0.0:
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
                        trace[lane, k, 0], trace[lane, k, 1] = w[r.Q1, slot], w[r.Q2, slot]
                        trace[lane, k, 2], trace[lane, k, 3] = w[r.V1, slot], w[r.V2, slot]
                if result[lane, r.R_CLOSED] != 0.0:
                    at[slot] = next_onset(given, w, lane, slot, samples, at[slot], last[lane], chunk, general)
                    jumped = True
                if at[slot] >= last[lane]:
                    finish(given, result, kept, w, lane, slot, at[slot] * h)
                    lane = -1
                    continue
                shaken = at[slot] < shaken_steps
                load(w, slot, samples, at[slot], linear, general)
                watch(given, w, lane, slot, shaken)
                if jumped or at[slot] == shaken_steps:
                    # the ground may jump here: the closed joints must answer
                    w[r.LIMIT_1, slot] = -1.0
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
            flagged = step_all(w, h, linear, general)
            steps += active
            if flagged > 0:
                for slot in range(r.W):
                    if w[r.FLAG, slot] != 0.0 and of[slot] >= 0:
                        lane = of[slot]
                        i = at[slot] - 1
                        shaken = i + 1 < shaken_steps
                        over = attend(
                            given, result, kept, w, system, lane, slot, samples, i, h, shaken, fall, log, count,
                            linear, general,
                        )  # fmt: skip
                        if not math.isnan(over):
                            finish(given, result, kept, w, lane, slot, over)
                            of[slot] = -1
                            settle = True
                        elif result[lane, r.R_CLOSED] != 0.0:
                            settle = True
                        elif w[r.LIMIT_1, slot] < 0.0:
                            watch(given, w, lane, slot, shaken)
            if settle:
                break
