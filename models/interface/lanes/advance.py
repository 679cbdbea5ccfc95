"""The lane kernel of a wall between two layers: W lanes under way, each at its own step of the record.

The loop over the W lanes has no branches and becomes vector code; a lane that ends makes room for
the next one. Boundaries (a sample to be written, the end of the record, of a window in which the lane
may have come to rest) are settled lane by lane.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from models.interface.declaration import CALM
from models.interface.lanes.effects.begin import load_pitch, pitch_on, vacate
from models.interface.lanes.effects.rows import X1
from models.interface.lanes.effects.step import predict, step, strips_of_fibres
from models.interface.lanes.fibres import fibres_all, sided_fibres
from models.interface.lanes.rows import (
    CLOCK,
    FLAG,
    GROWTH_A,
    GROWTH_V,
    LIFT_B,
    LIFT_T,
    LOG_CLOSING,
    LOG_OVERTURNED,
    LOG_REST,
    LOG_UPLIFT,
    Q_PERIOD,
    Q_STEPS,
    RA,
    RV,
    STEP,
    T1,
    T2,
    W,
)
from models.interface.lanes.settle import HALF_TURN, at_rest, consistent, empty, finish, load, start, table_for
from models.interface.lanes.step import step_all
from models.lanes.arrays import Counts, Record, Table, Tables
from models.lanes.compiler import called, compiled
from models.lanes.events import note


@called
def note_joints(log: Table, count: Counts, was: Table, w: Table, lane: int, slot: int) -> None:
    """Write the uplifts and closings of the step just done; ``was`` (2, W) holds the heights before it."""
    for joint in range(2):
        before, now = was[joint, slot], w[LIFT_B + joint, slot]
        if (before > 0.0) != (now > 0.0):
            at = (w[CLOCK, slot] - now / (now - before)) * w[STEP, slot]
            note(log, count, lane, at, LOG_UPLIFT if now > 0.0 else LOG_CLOSING, joint + 1.0)


@compiled
def advance(
    record: Record, first: Counts, last: Counts, given: Table, tables: Tables, sampled: bool, mixed: Any, laws: Any,
    rubber: Any, more: Any,
) -> int:  # fmt: skip
    """Run every lane from sample ``first`` to ``last``; returns the number of lane-steps computed.

    The record is linear between its samples, and each lane takes its own number of steps per sample. The trace
    (n, m, 8) takes q and q' at every sample if ``sampled``, else a lane ends when it has come to rest; the log takes
    uplifts, closings, rest and overturning. ``mixed``, ``laws``: see `step`;
    ``rubber``: the `Rubber` of `models.interface.lanes.fibres` if there are laws. ``more``: None or the `More` of
    walls with effects, whose other coordinates the trace (n, m, 16) holds after the plain ones.
    """
    samples, time_step, shaken = record.samples, record.step, record.shaken
    result, trace, log, count = tables.result, tables.trace, tables.log, tables.length
    n = given.shape[0]
    w = table_for(laws, more)
    # the same by place: with constant places loops over the lanes become vector code
    flat = w.reshape(w.size)
    was = np.zeros((2, W))
    at, bound, of = np.zeros(W, np.int64), np.zeros(W, np.int64), np.full(W, -1)
    sub, per, window = np.zeros(W, np.int64), np.ones(W, np.int64), np.zeros(W, np.int64)
    waiting, steps = 0, 0
    logged = log.shape[1] > 0
    for slot in range(W):
        empty(w, slot)
        if more is not None:
            vacate(flat, slot)
    while True:
        # --- settle lanes at their boundaries, fill empty slots
        active = 0
        for slot in range(W):
            lane = of[slot]
            while True:
                if lane < 0:
                    at[slot], sub[slot] = 0, 0
                    if waiting == n:
                        break
                    lane = waiting
                    waiting += 1
                    at[slot], bound[slot], window[slot] = first[lane], first[lane], -1
                    per[slot] = int(given[lane, Q_STEPS])
                    start(given, result, w, lane, slot, samples, at[slot], time_step, logged, mixed, laws, rubber, more)
                if at[slot] < bound[slot]:
                    break
                i = at[slot]
                if sampled and i - first[lane] < trace.shape[1]:
                    for k in range(8):
                        trace[lane, i - first[lane], k] = w[T1 + k, slot]
                        if more is not None:
                            trace[lane, i - first[lane], 8 + k] = flat[X1 + k * W + slot]
                if i == shaken and i > first[lane]:
                    if more is not None:
                        load_pitch(flat, more, slot, samples, i, shaken, 1.0)
                    consistent(w, slot, 0.0, 0.0, mixed, laws, more)
                ended = i >= last[lane]
                if i >= shaken and i >= window[slot]:
                    if at_rest(w, slot, CALM) and window[slot] >= 0:
                        if logged:
                            note(log, count, lane, i * time_step, LOG_REST, 1.0)
                        ended = ended or not sampled
                    window[slot] = i + 1 + int(given[lane, Q_PERIOD] / time_step)
                if ended:
                    finish(result, w, lane, slot, False, laws, rubber, more)
                    lane = -1
                    empty(w, slot)
                    if more is not None:
                        vacate(flat, slot)
                    continue
                bound[slot] = min(last[lane], shaken if i < shaken else window[slot])
                if sampled:
                    bound[slot] = i + 1
                load(w, slot, samples, i, shaken, float(per[slot]))
                if more is not None:
                    load_pitch(flat, more, slot, samples, i, shaken, float(per[slot]))
                break
            of[slot] = lane
            active += 1 if lane >= 0 else 0
        if active == 0:
            return steps
        # --- common steps until the first boundary, or until a lane has to be settled
        common = 1 << 62
        for slot in range(W):
            if of[slot] >= 0:
                common = min(common, (bound[slot] - at[slot]) * per[slot] - sub[slot])
        settle = False
        for _ in range(common):
            for slot in range(W):
                sub[slot] += 1
                w[RA, slot] += w[GROWTH_A, slot]
                w[RV, slot] += w[GROWTH_V, slot]
            for slot in range(W):
                if sub[slot] == per[slot]:
                    sub[slot] = 0
                    at[slot] += 1
            if logged:
                for slot in range(W):
                    was[0, slot], was[1, slot] = w[LIFT_B, slot], w[LIFT_T, slot]
            if more is None:
                if laws is not None:
                    fibres_all(flat, rubber.base, rubber.top)
                flagged = step_all(flat, mixed, laws)
            else:
                pitch_on(flat, more)
                predict(flat, more)
                if laws is not None:
                    strips_of_fibres(flat)
                    sided_fibres(flat, rubber.base, rubber.top)
                flagged = step(flat, more, laws)
            steps += active
            if flagged > 0:
                for slot in range(W):
                    lane = of[slot]
                    if w[FLAG, slot] == 0.0 or lane < 0:
                        continue
                    if logged:
                        note_joints(log, count, was, w, lane, slot)
                    if not (abs(w[T1, slot]) < HALF_TURN and abs(w[T2, slot]) < HALF_TURN):
                        if logged:
                            body = 1.0 if abs(w[T1, slot]) >= HALF_TURN else 2.0
                            note(log, count, lane, w[CLOCK, slot] * w[STEP, slot], LOG_OVERTURNED, body)
                        finish(result, w, lane, slot, True, laws, rubber, more)
                        of[slot] = -1
                        empty(w, slot)
                        if more is not None:
                            vacate(flat, slot)
                        settle = True
            # --- lanes that have come to a sample take up its growth, whatever becomes of the others
            for slot in range(W):
                if sub[slot] == 0 and of[slot] >= 0 and at[slot] < bound[slot]:
                    load(w, slot, samples, at[slot], shaken, float(per[slot]))
                    if more is not None:
                        load_pitch(flat, more, slot, samples, at[slot], shaken, float(per[slot]))
            if settle:
                break
