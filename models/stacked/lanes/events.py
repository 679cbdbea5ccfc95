"""One step of one lane with its events: onset, impact, opening, rest. Rare, so written plainly.

Inside the step the inputs are linear in the fraction f of the step (0..1).
"""

from __future__ import annotations

from typing import Any

from models.lanes.compiler import called, inlined
from models.lanes.events import note
from models.stacked.account import FAILED
from models.stacked.declaration import MOST_EVENTS_PER_STEP
from models.stacked.lanes.bookkeeping import configure, raise_peaks
from models.stacked.lanes.choice import choose, held
from models.stacked.lanes.closing import close
from models.stacked.lanes.corners import line, motion
from models.stacked.lanes.locate import closing, inputs, look, onset, opening, part
from models.stacked.lanes.rows import (
    A0,
    DEMAND_1,
    DEMAND_2,
    FREE_1,
    FREE_2,
    G0,
    LIMIT_1,
    LOG_CHANGE,
    LOG_ONSET,
    MARGIN_1,
    MARGIN_2,
    Q1,
    Q1S,
    Q2,
    Q2S,
    R_CLOSED,
    R_SIDE_1,
    R_SIDE_2,
    V1,
    V1S,
    V2,
    V2S,
    WORK,
    WORK_STEP,
    X1,
    X1S,
    X2,
    X2S,
    W,
)  # fmt: skip

Table = Any
AHEAD = 1e-6
"""Fraction of a step by which the choice at a threshold looks ahead."""


@inlined
def demand(w: Table, slot: int, demands: tuple[float, float]) -> None:
    """Keep the largest friction demands."""
    w[DEMAND_1 * W + slot] = max(w[DEMAND_1 * W + slot], demands[0])
    w[DEMAND_2 * W + slot] = max(w[DEMAND_2 * W + slot], demands[1])


@inlined
def settle(
    given: Table, result: Table, w: Table, system: Table, lane: int, slot: int, record: Table, i: int, f: float,
    q1: float, q2: float, v1: float, v2: float, time: float, moving: bool, linear: Any,
) -> None:  # fmt: skip
    """What the closed joints do under the forces of fraction ``f``; sets the configuration."""
    s1, s2 = result[lane, R_SIDE_1], result[lane, R_SIDE_2]
    if s1 == 0.0 or s2 == 0.0:
        a, g = inputs(w, slot, record, i, f)
        motion(system, given, lane, q1, q2, v1, v2, a, g, linear)
        n1, n2 = choose(system, s1, s2, moving)
        configure(given, result, w, lane, slot, n1, n2, time)


@inlined
def opened(
    given: Table, result: Table, w: Table, system: Table, lane: int, slot: int, joint: int, record: Table, i: int,
    f: float, state: tuple[float, float, float, float], time: float, linear: Any,
) -> None:  # fmt: skip
    """A closed joint opens without impact, about the corner that its residual moment shows."""
    a, g = inputs(w, slot, record, i, f)
    motion(system, given, lane, state[0], state[1], state[2], state[3], a, g, linear)
    s1, s2 = result[lane, R_SIDE_1], result[lane, R_SIDE_2]
    x1, x2 = held(system, s1, s2)
    k = line(s1, s2)
    if joint == 0:
        left = system[k, 3] - system[k, 1] * x2
        configure(given, result, w, lane, slot, 1.0 if left > 0.0 else -1.0, s2, time)
    else:
        left = system[k, 4] - system[k, 1] * x1
        configure(given, result, w, lane, slot, s1, 1.0 if left > 0.0 else -1.0, time)


@called
def one_step(
    given: Table, result: Table, w: Table, system: Table, lane: int, slot: int, record: Table, i: int, h: float,
    log: Table, count: Table, linear: Any,
) -> None:  # fmt: skip
    """Advance a lane over step i from its state at the start of the step, whatever happens in it."""
    q1, q2 = w[Q1S * W + slot], w[Q2S * W + slot]
    v1, v2 = w[V1S * W + slot], w[V2S * W + slot]
    f, rounds, joint = 0.0, 0, 0
    x = (0.0, 0.0)
    known = w[LIMIT_1 * W + slot] > 0.0
    if not known and result[lane, R_CLOSED] == 0.0:
        # the ground has jumped: the closed joints answer before the step
        settle(given, result, w, system, lane, slot, record, i, 0.0, q1, q2, v1, v2, i * h, False, linear)
    while f < 1.0:
        rounds += 1
        if rounds > MOST_EVENTS_PER_STEP:
            result[lane, FAILED] = 1.0
            configure(given, result, w, lane, slot, 0.0, 0.0, (i + f) * h)
            q1, q2, v1, v2 = 0.0, 0.0, 0.0, 0.0
            break
        if result[lane, R_CLOSED] != 0.0:
            at = onset(given, w, lane, slot, record, i, f)
            if at >= 1.0:
                break
            f = at
            settle(
                given, result, w, system, lane, slot, record, i, min(1.0, f + AHEAD), 0.0, 0.0, 0.0, 0.0,
                (i + f) * h, True, linear,
            )  # fmt: skip
            note(log, count, lane, (i + f) * h, LOG_ONSET, 1.0 if result[lane, R_SIDE_1] != 0.0 else 2.0)
        share = 1.0 - f
        state = (q1, q2, v1, v2)
        if known and rounds == 1:
            second, started = (w[X1S * W + slot], w[X2S * W + slot]), (0.0, 0.0)
            end = (w[Q1 * W + slot], w[Q2 * W + slot], w[V1 * W + slot], w[V2 * W + slot])
            x, margins = (w[X1 * W + slot], w[X2 * W + slot]), (w[MARGIN_1 * W + slot], w[MARGIN_2 * W + slot])
            demands, work = (0.0, 0.0), w[WORK_STEP * W + slot]
        else:
            second, started, demands = look(w, slot, state, record, i, f, linear)
            demand(w, slot, demands)
            end, x, margins, demands, work = part(w, slot, state, second, record, i, f, share, h, linear)
        joint = -1
        for k in range(2):
            if margins[k] < 0.0:
                joint = k
                if (w[FREE_1 * W + slot] if k == 0 else w[FREE_2 * W + slot]) > 0.0:
                    share, end, x, margins, demands, work = closing(
                        w, slot, k, state, second, end, x, record, i, f, share, h, linear
                    )
                else:
                    if known and rounds == 1:
                        _, started, _ = look(w, slot, state, record, i, f, linear)
                    share, end, x, margins, demands, work = opening(
                        w, slot, k, state, second, started[k], margins[k], record, i, f, share, h, linear
                    )
        raise_peaks(result, lane, state, end, share * h)
        demand(w, slot, demands)
        w[WORK * W + slot] += work
        q1, q2, v1, v2 = end
        if joint < 0:
            break
        f += share
        time = (i + f) * h
        side = result[lane, R_SIDE_1] if joint == 0 else result[lane, R_SIDE_2]
        if side == 0.0:
            opened(given, result, w, system, lane, slot, joint, record, i, f, end, time, linear)
            note(log, count, lane, time, LOG_CHANGE, joint + 1.0)
            continue
        if joint == 0:
            q1 = 0.0
        else:
            q2 = 0.0
        a, g = inputs(w, slot, record, i, f)
        v1, v2 = close(
            given, result, w, system, lane, slot, joint, q1, q2, v1, v2, a, g, time, log, count, linear
        )  # fmt: skip
    w[Q1 * W + slot], w[Q2 * W + slot], w[V1 * W + slot], w[V2 * W + slot] = q1, q2, v1, v2
    w[A0 * W + slot], w[G0 * W + slot] = inputs(w, slot, record, i, 1.0)
    if joint >= 0:
        x, _, _ = look(w, slot, (q1, q2, v1, v2), record, i, 1.0, linear)
    w[X1 * W + slot], w[X2 * W + slot] = x
