"""The lane kernel of a wall between two layers: W lanes under way, each at its own step of the record.

The loop over the W lanes has no branches and becomes vector code; a lane that ends makes room for
the next one. Boundaries (a sample to be written, the end of the record, of a window in which the lane
may have come to rest) are settled lane by lane.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from models.interface.declaration import CALM
from models.interface.lanes.rows import (
    FLAG,
    LIFT_B,
    LIFT_T,
    LOG_CLOSING_B,
    LOG_OVER_1,
    LOG_OVER_2,
    LOG_REST,
    LOG_UPLIFT_B,
    N_WORK,
    Q_PERIOD,
    RA,
    RV,
    T1,
    T2,
    W,
)
from models.interface.lanes.settle import HALF_TURN, at_rest, consistent, empty, finish, start
from models.interface.lanes.step import step_all
from models.lanes.compiler import called, compiled

Table = Any


@called
def note(log: Table, count: Table, lane: int, time: float, kind: float) -> None:
    """Write an event in the log of this lane, as long as there is room."""
    if count[lane] < log.shape[1]:
        log[lane, count[lane], 0] = time
        log[lane, count[lane], 1] = kind
    count[lane] += 1


@called
def note_joints(log: Table, count: Table, was: Table, w: Table, lane: int, slot: int, i: int, h: float) -> None:
    """Write the joints' uplifts and closings of step i; ``was`` (2, W) holds the heights before it."""
    for joint in range(2):
        before, now = was[joint, slot], w[(LIFT_B + joint) * W + slot]
        if (before > 0.0) != (now > 0.0):
            at = (i + before / (before - now)) * h
            kind = LOG_UPLIFT_B if now > 0.0 else LOG_CLOSING_B
            note(log, count, lane, at, float(kind + joint))


@compiled
def advance(
    record: Table, h: float, shaken_steps: int, first: Table, last: Table, given: Table, result: Table,
    every: int, trace: Table, log: Table, count: Table, may_rest: bool,
    mixed: Any,
) -> int:  # fmt: skip
    """Run every lane from step ``first`` to ``last``; returns the number of lane-steps computed.

    ``record`` (2, n): a and a_z at the ends of the steps of length ``h`` (s), the shaking ends at
    ``shaken_steps``. ``trace`` (n, m, 8) takes q and q' every ``every`` steps (0: never). ``log``
    (n, k, 2) takes uplifts, closings, rest and overturning. ``may_rest``: a lane ends when it has
    come to rest.
    """
    n = given.shape[0]
    w = np.zeros(N_WORK * W)
    was = np.zeros((2, W))
    at, bound, of = np.zeros(W, np.int64), np.zeros(W, np.int64), np.full(W, -1)
    window = np.zeros(W, np.int64)
    waiting, steps = 0, 0
    logged = log.shape[1] > 0
    for slot in range(W):
        empty(w, slot)
    while True:
        active = 0
        for slot in range(W):
            lane = of[slot]
            while True:
                if lane < 0:
                    if waiting == n:
                        at[slot] = 0
                        break
                    lane = waiting
                    waiting += 1
                    i = first[lane]
                    at[slot], bound[slot], window[slot] = i, i, -1
                    live = 1.0 if i < shaken_steps else 0.0
                    start(given, result, w, lane, slot, i, live * record[0, i], live * record[1, i], logged, mixed)
                if at[slot] < bound[slot]:
                    break
                i = at[slot]
                if every > 0 and (i - first[lane]) % every == 0 and (i - first[lane]) // every < trace.shape[1]:
                    for k in range(8):
                        trace[lane, (i - first[lane]) // every, k] = w[(T1 + k) * W + slot]
                if i == shaken_steps and i > first[lane]:
                    # the record may jump to zero at its end
                    consistent(w, slot, 0.0, 0.0, mixed)
                ended = i >= last[lane]
                if i >= shaken_steps:
                    if i == window[slot] and at_rest(w, slot, CALM):
                        if logged:
                            note(log, count, lane, i * h, float(LOG_REST))
                        ended = ended or may_rest
                    if i >= window[slot]:
                        at_rest(w, slot, CALM)
                        window[slot] = i + max(1, int(given[lane, Q_PERIOD] / h))
                if ended:
                    finish(result, w, lane, slot, i * h, h, False)
                    lane = -1
                    empty(w, slot)
                    continue
                bound[slot] = min(last[lane], shaken_steps if i < shaken_steps else window[slot])
                if every > 0:
                    bound[slot] = min(bound[slot], i + every - (i - first[lane]) % every)
                break
            of[slot] = lane
            active += 1 if lane >= 0 else 0
        if active == 0:
            return steps
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
            if logged:
                for slot in range(W):
                    was[0, slot], was[1, slot] = w[LIFT_B * W + slot], w[LIFT_T * W + slot]
            flagged = step_all(w, h, mixed)
            steps += active
            if flagged > 0:
                for slot in range(W):
                    lane = of[slot]
                    if w[FLAG * W + slot] == 0.0 or lane < 0:
                        continue
                    if logged:
                        note_joints(log, count, was, w, lane, slot, at[slot] - 1, h)
                    if not (abs(w[T1 * W + slot]) < HALF_TURN and abs(w[T2 * W + slot]) < HALF_TURN):
                        over = abs(w[T1 * W + slot]) >= HALF_TURN
                        if logged:
                            note(log, count, lane, at[slot] * h, float(LOG_OVER_1 if over else LOG_OVER_2))
                        finish(result, w, lane, slot, at[slot] * h, h, True)
                        of[slot] = -1
                        empty(w, slot)
                        settle = True
            if settle:
                break
