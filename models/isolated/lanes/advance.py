"""The lane kernel of a chain on bearings: batches of W lanes, sample by sample through the record.

The loop over the W lanes has no branches and becomes vector code. A lane that has come to rest is put on record
and goes on idly until its batch is done.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from models.isolated.declaration import CALM
from models.isolated.lanes import bearing
from models.isolated.lanes import rows as r
from models.isolated.lanes.rows import Table, W
from models.isolated.lanes.step import step_all
from models.isolated.lanes.tables import Given, Lent, Records
from models.lanes.compiler import called, compiled
from models.rubber import lanes as rubber


@called
def start(slot: int, lane: int, work: Lent, given: Given) -> None:
    """Put a lane in a slot."""
    for k in range(r.N_SCALAR):
        work.scalars[k, slot] = given.scalars[lane, k]
    for k in range(r.N_MEMORY):
        work.memory[k, slot] = given.memory[lane, k]
    for k in range(r.N_LAW):
        work.numbers[k, slot] = given.numbers[lane, k]
    work.spring[bearing.K + slot] = given.numbers[lane, r.K]
    work.spring[bearing.LAST + slot] = given.memory[lane, r.U]
    for k in range(rubber.N_HIDDEN):
        work.spring[bearing.HIDDEN + k * W + slot] = given.hidden[lane, k]
    for k in range(rubber.N_NUMBERS):
        work.spring[bearing.P_LAWS + k * W + slot] = given.rubber[lane, k]
    rows = work.state.shape[0]
    for row in range(rows):
        work.state[row, slot] = given.states[lane, row]
        for k in range(4):
            work.gains[row, k, slot] = given.gains[lane, row, k]
        for column in range(rows):
            work.transition[row, column, slot] = given.transitions[lane, row, column]
    for j in range(rows // 2):
        for k in range(3):
            work.links[k, j, slot] = given.links[lane, k, j]
        for k in range(2):
            work.masses[k, j, slot] = given.masses[lane, k, j]


@called
def finish(slot: int, lane: int, work: Lent, records: Records) -> None:
    """Put a lane on record."""
    result, s, y = records.result, work.scalars, work.state
    failed = 0.0
    for row in range(y.shape[0]):
        records.states[lane, row] = y[row, slot]
        if not abs(y[row, slot]) < math.inf:
            failed = 1.0
    for k in range(r.N_MEMORY):
        records.memory[lane, k] = work.memory[k, slot]
    for k in range(rubber.N_HIDDEN):
        records.hidden[lane, k] = work.spring[bearing.HIDDEN + k * W + slot]
    result[lane, r.R_PEAK_U] = s[r.PEAK_U, slot]
    result[lane, r.R_PEAK_ACCELERATION] = s[r.PEAK_ACCELERATION, slot]
    result[lane, r.R_PEAK_DRIFT] = s[r.PEAK_DRIFT, slot]
    result[lane, r.R_WORK] = s[r.WORK, slot]
    result[lane, r.R_FAILED] = failed


@compiled
def advance(
    record: Table, time_step: float, shaken: int, per: int, first: Table, last: Table, period: Table, given: Given,
    records: Records, may_rest: bool, size: Any, laws: Any,
) -> int:  # fmt: skip
    """Run every lane from sample ``first`` to ``last``; returns the number of lane-steps computed.

    ``record`` (samples,): a every ``time_step`` (s), linear between; the shaking ends at sample ``shaken``, where a
    may jump to zero. ``per`` steps a sample. ``period`` (n,): samples in a lane's first period. ``may_rest``: a lane
    ends when it has come to rest. ``size``, ``laws``: see `models.isolated.lanes.step`.
    """
    n, levels = given.states.shape[0], len(size)
    rows = 2 * levels
    work = Lent(
        np.zeros((r.N_SCALAR, W)), np.zeros((r.N_MEMORY, W)), np.zeros((r.N_LAW, W)),
        np.zeros((rows, W)), np.zeros((rows, rows, W)), np.zeros((rows, 4, W)), np.zeros((3, levels, W)),
        np.zeros((2, levels, W)), np.zeros((rows, W)), np.zeros(bearing.N_SPRING),
    )  # fmt: skip
    s, y, link = work.scalars, work.state, work.links
    result, trace = records.result, records.trace
    of, window = np.zeros(W, np.int64), np.zeros(W, np.int64)
    steps = 0
    for batch in range(0, n, W):
        running = 0
        for slot in range(W):
            # idle slots of the last batch repeat its first lane
            lane = batch + slot if batch + slot < n else batch
            of[slot] = lane if batch + slot < n else -1
            running += 1 if of[slot] >= 0 else 0
            window[slot] = -1
            start(slot, lane, work, given)
            if of[slot] >= 0:
                result[lane, r.R_REST] = math.nan
        sample = 0
        while True:
            for slot in range(W):
                lane = of[slot] if of[slot] >= 0 else batch
                i = first[lane] + sample
                value = record[i] if i < shaken else 0.0
                growth = (record[i + 1] - record[i]) / per if i < shaken else 0.0
                s[r.AT, slot], s[r.GROWTH, slot] = s[r.SCALE, slot] * value, s[r.SCALE, slot] * growth
                if of[slot] < 0:
                    continue
                if sample < trace.shape[1]:
                    for row in range(rows):
                        trace[lane, sample, row] = y[row, slot]
                    force = link[0, 0, slot] * y[0, slot] + link[1, 0, slot] * y[levels, slot]
                    trace[lane, sample, rows] = force + s[r.FORCE, slot]
                ended = i >= last[lane]
                if i >= shaken and i >= window[slot]:
                    if window[slot] >= 0 and s[r.WINDOW, slot] <= CALM * s[r.KINETIC, slot]:
                        if result[lane, r.R_REST] != result[lane, r.R_REST]:
                            result[lane, r.R_REST] = i * time_step
                        ended = ended or may_rest
                    s[r.WINDOW, slot] = 0.0
                    window[slot] = i + 1 + period[lane]
                if ended:
                    finish(slot, lane, work, records)
                    of[slot] = -1
                    running -= 1
            if running == 0:
                break
            for _ in range(per):
                step_all(work, size, laws)
            steps += running * per
            sample += 1
    return steps
