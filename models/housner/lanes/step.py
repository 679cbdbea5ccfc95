"""Pieces of a step of one lane: the inputs inside it, the state after a part of it, where an event lies.

Inside the step the inputs are linear in the fraction f of the step (0..1).
"""

from __future__ import annotations

import math
from typing import Any

from models.housner.lanes import rows as r
from models.housner.lanes.equation import acceleration, friction_demand, rk4
from models.lanes.arrays import Counts, Table
from models.lanes.compiler import called, inlined
from models.lanes.events import note


@inlined
def stand_on(given: Table, w: Table, lane: int, slot: int, side: float, linear: Any) -> None:
    """Set the coefficients of the side on which the block now stands."""
    half = given[lane, r.Q_RIGHT] if side > 0.0 else given[lane, r.Q_LEFT]
    height, mass, inertia = given[lane, r.Q_HEIGHT], given[lane, r.Q_MASS], given[lane, r.Q_INERTIA]
    corner = inertia + mass * (height * height + half * half)
    w[r.SIDE, slot] = side
    w[r.B, slot] = half
    w[r.H, slot] = height
    w[r.IM, slot] = inertia / mass
    w[r.LAMBDA, slot] = corner / mass
    if linear is not None:
        ch = mass * math.sqrt(height * height + half * half) / corner
        w[r.CB, slot] = side * math.atan(half / height) * ch
        w[r.CH, slot] = ch
    else:
        w[r.CB, slot] = side * mass * half / corner
        w[r.CH, slot] = mass * height / corner


@inlined
def inputs(w: Table, slot: int, record: Table, i: int, f: float) -> tuple[float, float, float, float]:
    """a, G, psi, psi'' at the fraction f of step i."""
    # the record may jump to zero at its end: no part of its last sample acts in the step after it
    live = record[4, i]
    first, second = live * (1.0 - f), live * f
    a = first * record[0, i] + second * record[0, i + 1]
    v = first * record[1, i] + second * record[1, i + 1]
    p = first * record[2, i] + second * record[2, i + 1]
    q = first * record[3, i] + second * record[3, i + 1]
    scale, pitch = w[r.SCALE, slot], w[r.PITCH, slot]
    return (
        scale * a + w[r.OFFSET, slot],
        w[r.GRAVITY, slot] + w[r.VSCALE, slot] * v,
        pitch * p,
        pitch * q,
    )


@called
def part(
    w: Table, slot: int, theta: float, omega: float, record: Table, i: int, f: float, share: float, h: float,
    general: Any, linear: Any,
) -> tuple[float, float, float]:  # fmt: skip
    """theta, theta' and the work in couples after ``share`` of step i from its fraction f."""
    a0, g0, p0, q0 = inputs(w, slot, record, i, f)
    a1, g1, p1, q1 = inputs(w, slot, record, i, f + share)
    th1, om1, demand, work = rk4(w, slot, theta, omega, share * h, a0, a1, g0, g1, p0, p1, q0, q1, general, linear)
    w[r.DEMAND, slot] = max(w[r.DEMAND, slot], demand)
    return th1, om1, work


@inlined
def hermite_root(theta: float, omega: float, th1: float, om1: float, step: float) -> float:
    """Fraction of the step at which the cubic through both ends passes zero (th1 beyond it)."""
    c = 3.0 * (th1 - theta) - step * (2.0 * omega + om1)
    d = 2.0 * (theta - th1) + step * (omega + om1)
    f = 1.0
    for _ in range(4):
        value = theta + f * (step * omega + f * (c + f * d))
        slope = step * omega + f * (2.0 * c + 3.0 * d * f)
        if slope * th1 <= 0.0:
            break
        f -= value / slope
    return f


@inlined
def crossing(
    w: Table, slot: int, theta: float, omega: float, th1: float, om1: float, record: Table, i: int, f: float,
    rest: float, h: float, general: Any, linear: Any,
) -> tuple[float, float, float]:  # fmt: skip
    """Share of the step until theta = 0, theta' and work there: Newton within a bracket on the step itself.

    It stops where the last correction is under 1e-7 of the step and applies it to both: the error
    left is of its square.
    """
    side = w[r.SIDE, slot]
    low, high, work = 0.0, rest, 0.0
    share = rest * hermite_root(theta, omega, th1, om1, rest * h)
    if not low < share < high:
        share = 0.5 * rest
    for _ in range(60):
        th1, om1, work = part(w, slot, theta, omega, record, i, f, share, h, general, linear)
        if side * th1 < 0.0:
            high = share
        else:
            low = share
        inward = side * om1 < 0.0
        if inward and abs(th1) <= 1e-7 * abs(om1) * h:
            more = -th1 / (om1 * h)
            return share + more, om1 + (om1 - omega) * more / share, work
        if high - low <= 1e-15:
            break
        trial = share - th1 / (om1 * h) if inward else -1.0
        share = trial if low < trial < high else 0.5 * (low + high)
    return share, om1, work


@called
def turning(
    w: Table, slot: int, theta: float, omega: float, record: Table, i: int, f: float, rest: float, h: float,
    general: Any, linear: Any,
) -> tuple[float, float, float]:  # fmt: skip
    """Share of the step until theta' = 0, theta and work there, by bisection and secant."""
    low, high = 0.0, rest
    f_low, f_high = omega, -omega
    share, th1, work = rest, theta, 0.0
    for k in range(60):
        th1, om1, work = part(w, slot, theta, omega, record, i, f, share, h, general, linear)
        if om1 * omega > 0.0:
            low, f_low = share, om1
        else:
            high, f_high = share, om1
        if abs(om1) <= 1e-14 or high - low <= 1e-15:
            break
        trial = low - f_low * (high - low) / (f_high - f_low)
        share = trial if low < trial < high and k % 3 < 2 else 0.5 * (low + high)
    return share, th1, work


@called
def released(w: Table, slot: int, theta: float, record: Table, i: int, f: float, general: Any, linear: Any) -> bool:
    """Whether the other moments overcome the friction that holds the block; sets its direction."""
    a, g, p, q = inputs(w, slot, record, i, f)
    for direction in (1.0, -1.0):
        w[r.DIRECTION, slot] = direction
        accel, _, _, _ = acceleration(w, slot, theta, 0.0, a, g, p, q, general, linear)
        if accel * direction > 0.0:
            return True
    return False


@inlined
def start_at(w: Table, slot: int, record: Table, i: int, f: float) -> None:
    """Let the lane's next step begin at the fraction f of step i."""
    a, g, p, q = inputs(w, slot, record, i, f)
    w[r.A0, slot], w[r.G0, slot] = a, g
    w[r.P0, slot], w[r.PP0, slot] = p, q
    w[r.START, slot] = f


@inlined
def raise_peak(result: Table, w: Table, lane: int, slot: int, size: float) -> None:
    """Keep the largest rotation of the run and of this swing."""
    result[lane, r.R_SWING] = max(result[lane, r.R_SWING], size)
    if size > result[lane, r.R_PEAK]:
        result[lane, r.R_PEAK] = size
        w[r.PEAK, slot] = size
        if w[r.TURN, slot] >= 0.0:
            w[r.TURN, slot] = size


@inlined
def demand_at_landing(
    w: Table, slot: int, omega: float, record: Table, i: int, f: float, general: Any, linear: Any
) -> None:
    """The friction demand just before an impact, where it jumps."""
    a, g, p, q = inputs(w, slot, record, i, f)
    accel, x, z, _ = acceleration(w, slot, 0.0, omega, a, g, p, q, general, linear)
    base = a - g * p + w[r.H, slot] * q
    demand = friction_demand(w, slot, accel, omega, x, z, base, g, general)
    w[r.DEMAND, slot] = max(w[r.DEMAND, slot], demand)


@inlined
def lift_off(
    given: Table, result: Table, w: Table, lane: int, slot: int, side: float, time: float, log: Table, count: Counts,
    linear: Any,
) -> None:  # fmt: skip
    """The block at rest (or just landed) starts to rock on ``side``."""
    result[lane, r.R_MODE] = r.UP
    stand_on(given, w, lane, slot, side, linear)
    w[r.DIRECTION, slot] = side
    if not result[lane, r.R_UP_SINCE] == result[lane, r.R_UP_SINCE]:
        result[lane, r.R_UP_SINCE] = time
        note(log, count, lane, time, r.LOG_ONSET, 1.0)
        if not result[lane, r.R_ONSET] == result[lane, r.R_ONSET]:
            result[lane, r.R_ONSET] = time


@inlined
def come_down(result: Table, lane: int, time: float, log: Table, count: Counts) -> None:
    """The base is in full contact from ``time`` on: the account of a stretch of rocking."""
    since = result[lane, r.R_UP_SINCE]
    if since == since:
        result[lane, r.R_UPLIFT] += time - since
        result[lane, r.R_UP_SINCE] = math.nan
        note(log, count, lane, time, r.LOG_REST, 1.0)
