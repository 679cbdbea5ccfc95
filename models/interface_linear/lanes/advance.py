"""The lane kernel: one wall after the other, in exact steps of its configurations from switch to switch."""

from __future__ import annotations

import math

import numpy as np

from models.interface.declaration import CALM
from models.interface.lanes import rows as kept
from models.interface_linear.equation import FULL, HALF_LEFT, HALF_RIGHT, STATES
from models.interface_linear.lanes import rows as r
from models.interface_linear.lanes.gather import gather, look, stored
from models.interface_linear.lanes.locate import first_crossing, may_cross
from models.interface_linear.lanes.propagate import COLUMNS, ORDER, along, build, read, series, step
from models.interface_linear.lanes.switch import successor
from models.interface_linear.lanes.work import Work
from models.lanes.arrays import Counts, Record, Table, Tables
from models.lanes.compiler import called, compiled, inlined
from models.lanes.events import note

HALF_TURN = 0.5 * math.pi
NEVER = 1e300
ROUNDING = 1e-20
"""Share of the weight times the static compression below which kinetic energy is rounding."""
MOST_SWITCHES = 10_000
"""Switches within one sample of the record beyond which a lane is given up."""
GOES_ON, FALLEN, LOST = range(3)


@called
def enter(system: Table, work: Work, c: int, levels: int, unit: float) -> None:
    """Have the propagators of a configuration at hand."""
    if not work.built[c]:
        build(work.propagators, system, c, levels, unit, work.powers, work.sums)
        work.built[c] = True


@called
def switch(given: Table, lane: int, system: Table, work: Work, tables: Tables, event: int, time: float) -> None:
    """The joint of watched value ``event`` changes its state: energies, uplift, closing."""
    place, x, gathered, log, count = work.place, work.x, work.gathered, tables.log, tables.length
    joint = event // 2
    old = place[0]
    was = old // STATES if joint == 0 else old % STATES
    before = stored(given, lane, joint, was, x)
    place[0] = successor(given, lane, system, old, event, x)
    state = place[0] // STATES if joint == 0 else place[0] % STATES
    gathered[r.LOST_B + joint] += before - stored(given, lane, joint, state, x)
    if was == FULL:
        gathered[r.ONSET_B + joint] = min(gathered[r.ONSET_B + joint], time)
        note(log, count, lane, time, kept.LOG_UPLIFT, joint + 1.0)
    elif state == FULL:
        gathered[r.CLOSED_B + joint] += 1.0
        note(log, count, lane, time, kept.LOG_CLOSING, joint + 1.0)


@inlined
def cross(
    given: Table, lane: int, system: Table, work: Work, tables: Tables, begin: float, per: int, step_length: float,
    levels: int,
) -> tuple[int, int]:  # fmt: skip
    """One sample of the record from ``begin`` (s) on, in ``per`` equal steps, switches included; how, and how many.

    A step in which a watched value may become positive is taken as two halves, down to the smallest, where the Taylor
    series tells when.
    """
    place, gathered, x, to, before, after = work.place, work.gathered, work.x, work.to, work.before, work.after
    whole = 1 << levels
    unit = step_length / whole
    for part in range(per):
        time = begin + part * step_length
        position, within = 0, 0.0
        while position < whole:
            c = place[0]
            event = -1
            if within == 0.0:
                level = place[1]
                while position & ((1 << (levels - level)) - 1) != 0:
                    level += 1
                units = 1 << (levels - level)
                length = unit * units
                step(work.propagators, c, level, x, length, to)
                read(system, c, to, after)
                if may_cross(before, after, length):
                    if level < levels:
                        place[1] = level + 1
                        continue
                    units = 0
                else:
                    place[1] = max(level - 1, 0)
            else:
                units = 0
            if units == 0:
                series(system, c, x, unit, work.motion, work.watched)
                share, event = first_crossing(work.watched, 1.0 - within)
                length = share * unit
                along(work.motion, share, x, length, to)
                read(system, c, to, after)
                within += share
                units = 1 if event < 0 or within >= 1.0 else 0
            gather(gathered, given, lane, c, x, before, to, after, length)
            t1, t2 = abs(x[0]), abs(x[1])
            for row in range(r.N_STATE):
                x[row] = to[row]
            for row in range(r.N_READING):
                before[row] = after[row]
            if not (abs(x[0]) < HALF_TURN and abs(x[1]) < HALF_TURN):
                if x[0] != x[0] or x[1] != x[1]:
                    return LOST, part + 1
                body = 0 if abs(x[0]) >= HALF_TURN else 1
                old = t1 if body == 0 else t2
                place[3] = body
                gathered[r.WINDOW] = time + position * unit + length * (HALF_TURN - old) / (abs(x[body]) - old)
                return FALLEN, part + 1
            if event >= 0:
                switch(given, lane, system, work, tables, event, time + (position + within) * unit)
                enter(system, work, place[0], levels, unit)
                read(system, place[0], x, before)
                look(gathered, given, lane, place[0], x, before)
                place[1] = levels
                place[2] += 1
                if place[2] > MOST_SWITCHES:
                    return LOST, part + 1
            if units > 0:
                position, within = position + units, 0.0
    return GOES_ON, per


@inlined
def first_state(given: Table, lane: int, joint: int, x: Table) -> int:
    """Full or half contact of a joint as the state at the start has it."""
    turn = x[1] - x[0] if joint == 1 else x[0]
    if given[lane, r.RUBBER_B + joint] == 0.0 or x[2 + joint] + given[lane, r.B_B + joint] * abs(turn) <= 0.0:
        return FULL
    return HALF_RIGHT if turn >= 0.0 else HALF_LEFT


@inlined
def fresh(most_levels: int) -> Work:
    """Room for one wall after the other."""
    return Work(
        np.zeros(4, np.int64), np.zeros(r.N_STATE), np.zeros(r.N_STATE), np.zeros(r.N_READING), np.zeros(r.N_READING),
        np.zeros(r.N_GATHERED), np.zeros((STATES * STATES, most_levels + 1, COLUMNS, 8)),
        np.zeros(STATES * STATES, np.bool_), np.zeros((ORDER + 1, 8)), np.zeros((4, ORDER + 1)),
        np.zeros((COLUMNS, 8)), np.zeros((COLUMNS, 8)),
    )  # fmt: skip


@inlined
def begin(given: Table, lane: int, work: Work) -> None:
    """A lane at its start, nothing gathered, no propagator at hand."""
    x, gathered = work.x, work.gathered
    work.built[:], gathered[:] = False, 0.0
    gathered[r.ONSET_B : r.ONSET_T + 1], gathered[r.SHARE_B : r.SHARE_T + 1] = NEVER, 1.0
    gathered[r.ACROSS_B : r.ACROSS_T + 1] = 1.0
    for row in range(8):
        x[row] = given[lane, r.START + row]


@inlined
def drive(given: Table, lane: int, samples: Table, time_step: float, shaken: int, i: int, x: Table) -> None:
    """The inputs and their slopes from sample i of the record on."""
    if i < shaken:
        x[r.A] = given[lane, r.OFFSET] + given[lane, r.SCALE] * samples[0, i]
        x[r.G] = given[lane, r.GRAVITY] + given[lane, r.VSCALE] * samples[1, i]
        x[r.A_SLOPE] = given[lane, r.SCALE] * (samples[0, i + 1] - samples[0, i]) / time_step
        x[r.G_SLOPE] = given[lane, r.VSCALE] * (samples[1, i + 1] - samples[1, i]) / time_step
    else:
        # beyond the record's last sample the base is at rest: it may jump there
        x[r.A], x[r.G] = given[lane, r.OFFSET], given[lane, r.GRAVITY]
        x[r.A_SLOPE], x[r.G_SLOPE] = 0.0, 0.0


@called
def close(result: Table, given: Table, gathered: Table, lane: int, x: Table, time: float, how: int, body: int) -> None:
    """Write the account of a lane that ends at ``time`` (s)."""
    over_1, over_2 = math.nan, math.nan
    if how == FALLEN:
        over_1, over_2 = gathered[r.WINDOW] if body == 0 else math.nan, gathered[r.WINDOW]
    elif how == GOES_ON:
        # a body whose mass centre is past its toe and moves outwards counts as overturned
        m1, m2, h1, h2 = given[lane, r.M1], given[lane, r.M2], given[lane, r.H1], given[lane, r.H2]
        first, second = m1 * h1 + m2 * given[lane, r.LEVER], m2 * h2
        side = 1.0 if x[0] >= 0.0 else -1.0
        past = side * (first * x[0] + second * x[1]) > (m1 + m2) * given[lane, r.B_B]
        if given[lane, r.RUBBER_B] > 0.0 and past and side * (first * x[4] + second * x[5]) > 0.0:
            over_1, over_2 = time, time
        side = 1.0 if x[1] >= x[0] else -1.0
        past = side * h2 * x[1] > given[lane, r.B_T]
        if given[lane, r.RUBBER_T] > 0.0 and over_2 != over_2 and past and side * (x[5] - x[4]) > 0.0:
            over_2 = time
    result[lane, kept.R_OVER_1], result[lane, kept.R_OVER_2] = over_1, over_2
    result[lane, kept.R_FAILED] = 1.0 if how == LOST else 0.0
    for end in range(2):
        result[lane, kept.R_PEAK_1 + end] = gathered[r.PEAK_1 + end]
        result[lane, kept.R_UP_B + end] = gathered[r.UP_B + end]
        result[lane, kept.R_ONSET_B + end] = gathered[r.ONSET_B + end]
        result[lane, kept.R_SHARE_B + end] = gathered[r.SHARE_B + end]
        result[lane, kept.R_CLOSED_B + end] = gathered[r.CLOSED_B + end]
        result[lane, kept.R_LOST_B + end] = gathered[r.LOST_B + end]
        along, across = gathered[r.ALONG_B + end], gathered[r.ACROSS_B + end]
        result[lane, kept.R_FRICTION_B + end] = along / across if across > 0.0 else NEVER
        result[lane, kept.R_END_1 + end], result[lane, kept.R_END_Z1 + end] = x[end], x[2 + end]
        result[lane, kept.R_EDGE_B + end] = gathered[r.EDGE_B + end]


@compiled
def advance(
    record: Record, first: Counts, last: Counts, given: Table, systems: Table, most_levels: int, tables: Tables,
    sampled: bool,
) -> int:  # fmt: skip
    """Run every lane from sample ``first`` to ``last``; returns the number of whole steps taken.

    The record is linear between its samples. ``systems`` (n, 25, 10, N_ROWS): `equation.systems`, transposed. The
    trace (n, m, 8) takes q and q' at every sample if ``sampled``, else a lane ends when it has come to rest; the
    log takes uplifts, closings, rest and overturning.
    """
    samples, time_step, shaken = record.samples, record.step, record.shaken
    result, trace, log, count = tables.result, tables.trace, tables.log, tables.length
    work = fresh(most_levels)
    place, x, gathered = work.place, work.x, work.gathered
    steps = 0
    for lane in range(given.shape[0]):
        system = systems[lane]
        per, levels = int(given[lane, r.STEPS]), int(given[lane, r.LEVELS])
        length = time_step / per
        unit = length / (1 << levels)
        begin(given, lane, work)
        gathered[r.PEAK_1], gathered[r.PEAK_2] = abs(x[0]), abs(x[1])
        base, top = first_state(given, lane, 0, x), first_state(given, lane, 1, x)
        place[0], place[1], place[3] = STATES * base + top, levels, 0
        enter(system, work, place[0], levels, unit)
        i, window, how = first[lane], -1, GOES_ON
        noise = (
            ROUNDING * (given[lane, r.M1] + given[lane, r.M2]) * given[lane, r.GRAVITY] * given[lane, r.COMPRESSION_B]
        )
        for joint in range(2):
            if (base, top)[joint] != FULL:
                gathered[r.ONSET_B + joint] = i * time_step
        while True:
            shaking = i < shaken
            drive(given, lane, samples, time_step, shaken, i, x)
            read(system, place[0], x, work.before)
            if i == first[lane]:
                look(gathered, given, lane, place[0], x, work.before)
            if sampled and i - first[lane] < trace.shape[1]:
                for k in range(8):
                    trace[lane, i - first[lane], k] = x[k]
            ended = i >= last[lane]
            if not shaking and i >= window:
                if gathered[r.WINDOW] <= CALM * gathered[r.KINETIC] + noise and window >= 0:
                    note(log, count, lane, i * time_step, kept.LOG_REST, 1.0)
                    ended = ended or not sampled
                gathered[r.WINDOW] = 0.0
                window = i + 1 + int(given[lane, r.PERIOD] / time_step)
            if ended:
                break
            place[2] = 0
            how, done = cross(given, lane, system, work, tables, i * time_step, per, length, levels)
            steps += done
            if how != GOES_ON:
                break
            i += 1
        if how == FALLEN:
            note(log, count, lane, gathered[r.WINDOW], kept.LOG_OVERTURNED, place[3] + 1.0)
        close(result, given, gathered, lane, x, i * time_step, how, place[3])
    return steps
