"""One step of one lane with its events: onset, impact, opening, rest. Rare, so written plainly.

Inside the step the inputs are linear in the fraction f of the step (0..1).
"""

from __future__ import annotations

from typing import Any

from models.lanes.arrays import Counts, Table
from models.lanes.compiler import called, inlined
from models.lanes.events import note
from models.stacked import account as acc
from models.stacked.declaration import MOST_EVENTS_PER_STEP
from models.stacked.lanes import rows as r
from models.stacked.lanes.bookkeeping import configure, raise_peaks
from models.stacked.lanes.choice import held
from models.stacked.lanes.closing import close
from models.stacked.lanes.corners import line, motion
from models.stacked.lanes.friction import respond, rub, sign, stopped, turn, turns_by
from models.stacked.lanes.locate import base, closing, inputs, look, onset, opening, part

AHEAD = 1e-6
"""Fraction of a step by which the choice at a threshold looks ahead."""


@inlined
def demand(w: Table, slot: int, demands: tuple[float, float]) -> None:
    """Keep the largest friction demands."""
    w[r.DEMAND_1, slot] = max(w[r.DEMAND_1, slot], demands[0])
    w[r.DEMAND_2, slot] = max(w[r.DEMAND_2, slot], demands[1])


@inlined
def settle(
    given: Table, result: Table, w: Table, system: Table, lane: int, slot: int, record: Table, i: int, f: float,
    q1: float, q2: float, v1: float, v2: float, time: float, moving: bool, linear: Any, general: Any,
) -> None:  # fmt: skip
    """What closed joints and friction do under the forces of fraction ``f``; sets the configuration."""
    s1, s2 = result[lane, r.R_SIDE_1], result[lane, r.R_SIDE_2]
    if s1 == 0.0 or s2 == 0.0 or stopped(w, slot, s1, v1):
        a, g, turning = inputs(w, slot, record, i, f, general)
        n1, n2, way = respond(given, w, system, lane, slot, s1, s2, q1, q2, v1, v2, a, g, turning, moving, linear)
        configure(given, result, w, lane, slot, n1, n2, time)
        if general is not None:
            rub(given, w, lane, slot, n1, way)


@inlined
def opened(
    given: Table, result: Table, w: Table, system: Table, lane: int, slot: int, joint: int, record: Table, i: int,
    f: float, state: tuple[float, float, float, float], time: float, log: Table, count: Counts, linear: Any,
    general: Any,
) -> None:  # fmt: skip
    """A closed joint opens without impact, about the corner that its residual moment shows; or friction lets go."""
    a, g, turning = inputs(w, slot, record, i, f, general)
    s1, s2 = result[lane, r.R_SIDE_1], result[lane, r.R_SIDE_2]
    motion(system, given, lane, s1, state[0], state[1], state[2], state[3], a, g, turning, linear)
    way = sign(w[r.OPPOSING, slot])
    base = s1
    if general is not None:
        if stopped(w, slot, s1, state[2]):
            base = way
    x1, x2 = held(system, base, s2)
    k = line(base, s2)
    if joint == 0:
        to = 1.0 if system[k, 3] - system[k, 1] * x2 > 0.0 else -1.0
        if s1 == 0.0:
            configure(given, result, w, lane, slot, to, s2, time)
            note(log, count, lane, time, r.LOG_CHANGE, 1.0)
        if general is not None:
            rub(given, w, lane, slot, result[lane, r.R_SIDE_1], to)
    else:
        to = 1.0 if system[k, 4] - system[k, 1] * x1 > 0.0 else -1.0
        configure(given, result, w, lane, slot, s1, to, time)
        note(log, count, lane, time, r.LOG_CHANGE, 2.0)
        if general is not None:
            rub(given, w, lane, slot, s1, way)


@called
def one_step(
    given: Table, result: Table, w: Table, system: Table, lane: int, slot: int, record: Table, i: int, h: float,
    log: Table, count: Counts, linear: Any, general: Any,
) -> None:  # fmt: skip
    """Advance a lane over step i from its state at the start of the step, whatever happens in it."""
    q1, q2 = w[r.Q1S, slot], w[r.Q2S, slot]
    v1, v2 = w[r.V1S, slot], w[r.V2S, slot]
    f, rounds, joint = 0.0, 0, 0
    x = (0.0, 0.0)
    known = w[r.LIMIT_1, slot] > 0.0
    if not known and result[lane, r.R_CLOSED] == 0.0:
        # the ground has jumped: the closed joints answer before the step
        settle(given, result, w, system, lane, slot, record, i, 0.0, q1, q2, v1, v2, i * h, False, linear, general)
    while f < 1.0:
        rounds += 1
        if rounds > MOST_EVENTS_PER_STEP:
            result[lane, acc.FAILED] = 1.0
            configure(given, result, w, lane, slot, 0.0, 0.0, (i + f) * h)
            q1, q2, v1, v2 = 0.0, 0.0, 0.0, 0.0
            break
        if result[lane, r.R_CLOSED] != 0.0:
            at = onset(given, w, lane, slot, record, i, f, general)
            if at >= 1.0:
                break
            f = at
            settle(
                given, result, w, system, lane, slot, record, i, min(1.0, f + AHEAD), 0.0, 0.0, 0.0, 0.0,
                (i + f) * h, True, linear, general,
            )  # fmt: skip
            note(log, count, lane, (i + f) * h, r.LOG_ONSET, 1.0 if result[lane, r.R_SIDE_1] != 0.0 else 2.0)
        share = 1.0 - f
        state = (q1, q2, v1, v2)
        if known and rounds == 1:
            second, started = (w[r.X1S, slot], w[r.X2S, slot]), (0.0, 0.0)
            end = (w[r.Q1, slot], w[r.Q2, slot], w[r.V1, slot], w[r.V2, slot])
            x, margins = (w[r.X1, slot], w[r.X2, slot]), (w[r.MARGIN_1, slot], w[r.MARGIN_2, slot])
            demands, work = (0.0, 0.0), w[r.WORK_STEP, slot]
        else:
            second, started, demands = look(w, slot, state, record, i, f, linear, general)
            demand(w, slot, demands)
            end, x, margins, demands, work = part(w, slot, state, second, record, i, f, share, h, linear, general)
        joint = -1
        if general is not None:
            by = turns_by(w, slot, state, second, end, x, record, i, f, share, h, linear, general)
            if by > 0.0:
                # first: beyond its turning point the wall may come back over a joint that it has closed
                joint = 2
                share, end, x, margins, demands, work = turn(
                    w, slot, state, second, record, i, f, by, h, linear, general
                )  # fmt: skip
        for k in range(2):
            if margins[k] < 0.0:
                joint = k
                if (w[r.FREE_1, slot] if k == 0 else w[r.FREE_2, slot]) > 0.0:
                    share, end, x, margins, demands, work = closing(
                        w, slot, k, state, second, end, x, record, i, f, share, h, linear, general
                    )
                else:
                    if known and rounds == 1:
                        _, started, _ = look(w, slot, state, record, i, f, linear, general)
                    share, end, x, margins, demands, work = opening(
                        w, slot, k, state, second, started[k], margins[k], record, i, f, share, h, linear, general
                    )
        raise_peaks(result, lane, state, end, share * h)
        demand(w, slot, demands)
        w[r.WORK, slot] += work
        q1, q2, v1, v2 = end
        if joint < 0:
            break
        f += share
        time = (i + f) * h
        if joint == 2:
            # the wall has turned
            settle(
                given, result, w, system, lane, slot, record, i, f, q1, q2, v1, v2, time, False, linear, general
            )  # fmt: skip
            continue
        if (w[r.FREE_1, slot] if joint == 0 else w[r.FREE_2, slot]) == 0.0:
            opened(given, result, w, system, lane, slot, joint, record, i, f, end, time, log, count, linear, general)
            continue
        if joint == 0:
            q1 = 0.0
        else:
            q2 = 0.0
        a, g, turning = inputs(w, slot, record, i, f, general)
        v1, v2 = close(
            given, result, w, system, lane, slot, joint, q1, q2, v1, v2, a, g, turning, time, log, count, linear
        )  # fmt: skip
    w[r.Q1, slot], w[r.Q2, slot], w[r.V1, slot], w[r.V2, slot] = q1, q2, v1, v2
    w[r.A0, slot], w[r.G0, slot], psi, turning = base(w, slot, record, i, 1.0, general)
    if general is not None:
        w[r.PSI0, slot], w[r.TURNING0, slot] = psi, turning
    if joint >= 0:
        x, _, _ = look(w, slot, (q1, q2, v1, v2), record, i, 1.0, linear, general)
    w[r.X1, slot], w[r.X2, slot] = x
