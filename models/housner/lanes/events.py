"""One step of one lane with its events: onset, impact, rest. Rare, so written plainly."""

from __future__ import annotations

import math
from typing import Any

from models.housner.declaration import MOST_IMPACTS_PER_STEP
from models.housner.lanes import rows as r
from models.housner.lanes.impact import kinetic_energy, restitution
from models.housner.lanes.onset import onset
from models.housner.lanes.regimes.flexure import bend
from models.housner.lanes.regimes.flight import fly, take_off
from models.housner.lanes.regimes.sliding import slide
from models.housner.lanes.step import (
    come_down,
    crossing,
    demand_at_landing,
    lift_off,
    part,
    raise_peak,
    released,
    stand_on,
    start_at,
    turning,
)  # fmt: skip
from models.lanes.arrays import Counts, Table
from models.lanes.compiler import inlined
from models.lanes.events import note, turning_point


@inlined
def land(
    given: Table, result: Table, w: Table, lane: int, slot: int, omega: float, time: float,
    log: Table, count: Counts, linear: Any,
) -> float:  # fmt: skip
    """An impact at theta = 0 with velocity ``omega``: change of pivot, loss; returns the velocity after."""
    side = w[r.SIDE, slot]
    e = restitution(given, result, w, lane, slot, side, omega)
    before = kinetic_energy(given, w, lane, slot, side, omega)
    after = e * omega
    left = kinetic_energy(given, w, lane, slot, -side, after)
    result[lane, r.R_DISSIPATED] += before - left
    result[lane, r.R_IMPACTS] += 1.0
    note(log, count, lane, time, r.LOG_IMPACT, 1.0)
    stand_on(given, w, lane, slot, -side, linear)
    calm = abs(after) < given[lane, r.Q_REST]
    if w[r.JOINT, slot] >= 0.0:
        result[lane, r.R_ENERGY] = max(result[lane, r.R_ENERGY], before)
        calm = left < 1e-6 * result[lane, r.R_ENERGY]
    if calm:
        result[lane, r.R_MODE] = r.DOWN
    result[lane, r.R_SWING] = 0.0
    return float(after)


@inlined
def one_step(
    given: Table, result: Table, w: Table, lane: int, slot: int, record: Table, i: int, h: float,
    log: Table, count: Counts, general: Any, linear: Any,
) -> None:  # fmt: skip
    """Advance a lane over step i from theta0, theta0' in ``work``, whatever happens in it.

    After an impact it stops there: the rest of the step becomes the lane's next step in the vector loop.
    """
    if general is not None:
        if given[lane, r.Q_FREQUENCY] < math.inf:
            bend(given, result, w, lane, slot, record, i, h, log, count, general, linear)
            return
        if given[lane, r.Q_FRICTION] < math.inf:
            slide(given, result, w, lane, slot, record, i, h, log, count, general, linear)
            return
    theta, omega = w[r.TH0, slot], w[r.OM0, slot]
    f = w[r.START0, slot]
    stepped = w[r.LIMIT, slot] > 0.0
    w[r.ROUNDS, slot] = w[r.ROUNDS, slot] + 1.0 if f > 0.0 else 0.0
    while f < 1.0:
        if w[r.ROUNDS, slot] > MOST_IMPACTS_PER_STEP:
            result[lane, r.R_STATUS] = r.NOT_CONVERGED
            result[lane, r.R_MODE] = r.DOWN
            theta, omega = 0.0, 0.0
            break
        if result[lane, r.R_MODE] == r.DOWN:
            theta = 0.0
            at, side = onset(given, w, lane, slot, record, i, f, linear)
            if at == f and omega != 0.0:
                # a slow landing while the ground pushes on: the block keeps rocking
                side = w[r.SIDE, slot]
            else:
                result[lane, r.R_DISSIPATED] += kinetic_energy(given, w, lane, slot, w[r.SIDE, slot], omega)
                omega = 0.0
            if at > f:
                come_down(result, lane, (i + f) * h, log, count)
            if at >= 1.0:
                break
            f = at
            lift_off(given, result, w, lane, slot, side, (i + f) * h, log, count, linear)
        if general is not None:
            if result[lane, r.R_MODE] == r.FLIGHT:
                f, theta, omega = fly(given, result, w, lane, slot, theta, omega, record, i, f, h, linear)
                continue
        if result[lane, r.R_MODE] == r.HELD:
            if not released(w, slot, theta, record, i, f, general, linear):
                break
            result[lane, r.R_MODE] = r.UP
        if omega != 0.0:
            w[r.DIRECTION, slot] = 1.0 if omega > 0.0 else -1.0
        rest = 1.0 - f
        if stepped:
            stepped = False
            th1, om1, work = w[r.TH, slot], w[r.OM, slot], w[r.WORK_STEP, slot]
        else:
            th1, om1, work = part(w, slot, theta, omega, record, i, f, rest, h, general, linear)
        if w[r.SIDE, slot] * th1 < 0.0:
            rest, om1, work = crossing(
                w, slot, theta, omega, th1, om1, record, i, f, rest, h, general, linear
            )  # fmt: skip
            if omega * om1 < 0.0:
                raise_peak(result, w, lane, slot, turning_point(theta, omega, 0.0, om1, rest * h))
            f += rest
            w[r.WORK, slot] += work
            theta = 0.0
            demand_at_landing(w, slot, om1, record, i, f, general, linear)
            omega = land(given, result, w, lane, slot, om1, (i + f) * h, log, count, linear)
            if general is not None:
                if given[lane, r.Q_BOUNCE] > 0.0 and result[lane, r.R_MODE] == r.UP:
                    omega = take_off(given, result, w, lane, slot, om1, omega)
            if result[lane, r.R_MODE] == r.UP and f < 1.0 and w[r.LIMIT, slot] > 0.0:
                start_at(w, slot, record, i, f)
                break
            w[r.ROUNDS, slot] += 1.0
            continue
        if omega * om1 < 0.0:
            if w[r.STOPS, slot] > 0.0:
                rest, th1, work = turning(w, slot, theta, omega, record, i, f, rest, h, general, linear)
                om1 = 0.0
                w[r.DIRECTION, slot] = -w[r.DIRECTION, slot]
                result[lane, r.R_MODE] = r.HELD
                raise_peak(result, w, lane, slot, abs(th1))
            else:
                raise_peak(result, w, lane, slot, turning_point(theta, omega, th1, om1, rest * h))
        w[r.WORK, slot] += work
        theta, omega, f = th1, om1, f + rest
    w[r.TH, slot], w[r.OM, slot] = theta, omega
