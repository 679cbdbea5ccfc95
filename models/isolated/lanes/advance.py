"""The lane kernel of a chain on bearings: batches of W lanes, sample by sample through the record.

The loop over the W lanes has no branches and becomes vector code. A lane that has come to rest is put on record
and goes on idly until its batch is done.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from models.isolated.declaration import CALM
from models.isolated.lanes import rows as r
from models.isolated.lanes.rows import W
from models.isolated.lanes.step import step_all
from models.lanes.compiler import called, compiled

Table = Any


@called
def start(
    slot: int, lane: int, s: Table, x: Table, p: Table, y: Table, transition: Table, g: Table, link: Table, mass: Table,
    scalars: Table, memory: Table, numbers: Table, states: Table, transitions: Table, gains: Table, links: Table,
    masses: Table,
) -> None:  # fmt: skip
    """Put a lane in a slot."""
    for k in range(s.shape[0]):
        s[k, slot] = scalars[lane, k]
    for k in range(x.shape[0]):
        x[k, slot] = memory[lane, k]
    for k in range(p.shape[0]):
        p[k, slot] = numbers[lane, k]
    for row in range(y.shape[0]):
        y[row, slot] = states[lane, row]
        for k in range(4):
            g[row, k, slot] = gains[lane, row, k]
        for column in range(y.shape[0]):
            transition[row, column, slot] = transitions[lane, row, column]
    for j in range(link.shape[1]):
        for k in range(3):
            link[k, j, slot] = links[lane, k, j]
        for k in range(2):
            mass[k, j, slot] = masses[lane, k, j]


@called
def finish(slot: int, lane: int, result: Table, s: Table, x: Table, y: Table) -> None:
    """Put a lane on record."""
    rows = y.shape[0]
    failed = 0.0
    for row in range(rows):
        result[lane, r.N_RESULT + row] = y[row, slot]
        if not abs(y[row, slot]) < math.inf:
            failed = 1.0
    for k in range(x.shape[0]):
        result[lane, r.N_RESULT + rows + k] = x[k, slot]
    result[lane, r.R_PEAK_U] = s[r.PEAK_U, slot]
    result[lane, r.R_PEAK_ACCELERATION] = s[r.PEAK_ACCELERATION, slot]
    result[lane, r.R_PEAK_DRIFT] = s[r.PEAK_DRIFT, slot]
    result[lane, r.R_WORK] = s[r.WORK, slot]
    result[lane, r.R_FAILED] = failed


@compiled
def advance(
    record: Table, time_step: float, shaken: int, per: int, first: Table, last: Table, period: Table, scalars: Table,
    memory: Table, numbers: Table, states: Table, transitions: Table, gains: Table, links: Table, masses: Table,
    result: Table, trace: Table, may_rest: bool, size: Any, laws: Any,
) -> int:  # fmt: skip
    """Run every lane from sample ``first`` to ``last``; returns the number of lane-steps computed.

    ``record`` (samples,): a every ``time_step`` (s), linear between; the shaking ends at sample ``shaken``, where a
    may jump to zero. ``per`` steps a sample. ``period`` (n,): samples in a lane's first period. The
    other tables hold a line a lane: see `models.isolated.lanes.run`. ``trace`` (n, m, rows) takes y
    and the bearings' force at every sample if m > 0. ``may_rest``: a lane ends when it has come to rest.
    """
    n, levels = states.shape[0], len(size)
    rows = 2 * levels
    s, x, p = np.zeros((r.N_SCALAR, W)), np.zeros((r.N_MEMORY, W)), np.zeros((r.N_LAW, W))
    y, new = np.zeros((rows, W)), np.zeros((rows, W))
    transition, g = np.zeros((rows, rows, W)), np.zeros((rows, 4, W))
    link, mass = np.zeros((3, levels, W)), np.zeros((2, levels, W))
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
            start(
                slot, lane, s, x, p, y, transition, g, link, mass,
                scalars, memory, numbers, states, transitions, gains, links, masses,
            )  # fmt: skip
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
                    finish(slot, lane, result, s, x, y)
                    of[slot] = -1
                    running -= 1
            if running == 0:
                break
            for _ in range(per):
                step_all(s, x, p, y, new, transition, g, link, mass, size, laws)
            steps += running * per
            sample += 1
    return steps
