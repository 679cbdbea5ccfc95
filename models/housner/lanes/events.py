"""One step of one lane with its events: onset, impact, rest. Rare, so written plainly.

Inside the step the inputs are linear in the fraction f of the step (0..1).
"""

from __future__ import annotations

import math
from typing import Any

from models.housner.declaration import MOST_IMPACTS_PER_STEP
from models.housner.lanes.equation import acceleration, friction_demand, rk4
from models.housner.lanes.impact import kinetic_energy, pivot, restitution
from models.housner.lanes.rows import (
    CB,
    CH,
    COULOMB,
    DEMAND,
    DIRECTION,
    DOWN,
    GRAVITY,
    HELD,
    IM,
    JOINT,
    LAMBDA,
    LIMIT,
    LOG_IMPACT,
    LOG_ONSET,
    LOG_REST,
    NOT_CONVERGED,
    OFFSET,
    OM,
    OM0,
    PEAK,
    PITCH,
    Q_HEIGHT,
    Q_INERTIA,
    Q_LEFT,
    Q_MASS,
    Q_REST,
    Q_RIGHT,
    R_DISSIPATED,
    R_ENERGY,
    R_IMPACTS,
    R_MODE,
    R_ONSET,
    R_PEAK,
    R_STATUS,
    R_SWING,
    R_UP_SINCE,
    R_UPLIFT,
    SCALE,
    SIDE,
    TH,
    TH0,
    UP,
    VSCALE,
    WORK,
    WORK_STEP,
    B,
    H,
    W,
)  # fmt: skip
from models.lanes.compiler import called, inlined

Table = Any
NONE = 2.0
"""A fraction of the step that never comes."""


@inlined
def note(log: Table, count: Table, lane: int, time: float, kind: float) -> None:
    """Write an event in the log of this lane, as long as there is room."""
    if log.shape[1] > 0:
        if count[lane] < log.shape[1]:
            log[lane, count[lane], 0] = time
            log[lane, count[lane], 1] = kind
        count[lane] += 1


@inlined
def stand_on(given: Table, w: Table, lane: int, slot: int, side: float, linear: Any) -> None:
    """Set the coefficients of the side on which the block now stands."""
    half = given[lane, Q_RIGHT] if side > 0.0 else given[lane, Q_LEFT]
    height, mass, inertia = given[lane, Q_HEIGHT], given[lane, Q_MASS], given[lane, Q_INERTIA]
    corner = inertia + mass * (height * height + half * half)
    w[SIDE * W + slot] = side
    w[B * W + slot] = half
    w[H * W + slot] = height
    w[IM * W + slot] = inertia / mass
    w[LAMBDA * W + slot] = corner / mass
    if linear is not None:
        ch = mass * math.sqrt(height * height + half * half) / corner
        w[CB * W + slot] = side * math.atan(half / height) * ch
        w[CH * W + slot] = ch
    else:
        w[CB * W + slot] = side * mass * half / corner
        w[CH * W + slot] = mass * height / corner


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
    scale, pitch = w[SCALE * W + slot], w[PITCH * W + slot]
    return (
        scale * a + w[OFFSET * W + slot],
        w[GRAVITY * W + slot] + w[VSCALE * W + slot] * v,
        pitch * p,
        pitch * q,
    )


@inlined
def excess(
    given: Table, w: Table, lane: int, slot: int, side: float,
    a: float, g: float, psi: float, psi2: float, linear: Any,
) -> float:  # fmt: skip
    """Moment over M that lifts the block at rest onto ``side``: positive means it starts to rock."""
    h = given[lane, Q_HEIGHT]
    b = pivot(given, w, lane, slot, side)
    inertia = given[lane, Q_INERTIA] / given[lane, Q_MASS]
    push = -side * ((a - g * psi) * h + (inertia + h * h) * psi2)
    if w[JOINT * W + slot] >= 0.0:
        return float(push - w[COULOMB * W + slot])
    if linear is not None:
        return float(push - g * h * math.atan(b / h))
    return float(push - g * b - w[COULOMB * W + slot])


@called
def onset(
    given: Table, w: Table, lane: int, slot: int, record: Table, i: int, f: float, linear: Any
) -> tuple[float, float]:
    """First fraction >= f of step i at which the block leaves rest, and the side; (NONE, 0) if it stays."""
    a0, g0, p0, q0 = inputs(w, slot, record, i, f)
    a1, g1, p1, q1 = inputs(w, slot, record, i, 1.0)
    first, which = NONE, 0.0
    for side in (1.0, -1.0):
        m0 = excess(given, w, lane, slot, side, a0, g0, p0, q0, linear)
        m1 = excess(given, w, lane, slot, side, a1, g1, p1, q1, linear)
        at = NONE
        if m0 > 0.0:
            at = f
        elif m1 > 0.0:
            at = f + (1.0 - f) * (-m0) / (m1 - m0)
        if at < first:
            first, which = at, side
    return first, which


@called
def next_onset(
    given: Table, w: Table, lane: int, slot: int, record: Table, i: int, last: int, chunk: Table, linear: Any
) -> int:
    """First step from i on in which the resting block is lifted, ``last`` if there is none.

    ``chunk`` (4, n) holds the extremes of the record over 64 steps: |a|, -a_z, |psi|, |psi''|.
    """
    h = given[lane, Q_HEIGHT]
    b = min(pivot(given, w, lane, slot, 1.0), pivot(given, w, lane, slot, -1.0))
    if linear is not None:
        b = h * math.atan(b / h)
    if w[JOINT * W + slot] >= 0.0:
        b = 0.0
    inertia = given[lane, Q_INERTIA] / given[lane, Q_MASS] + h * h
    scale, pitch = abs(w[SCALE * W + slot]), abs(w[PITCH * W + slot])
    while i < last:
        if i % 64 == 0 and i + 64 <= last:
            c = i // 64
            low = w[GRAVITY * W + slot] - abs(w[VSCALE * W + slot]) * chunk[1, c]
            high = w[GRAVITY * W + slot] + abs(w[VSCALE * W + slot]) * chunk[1, c]
            push = (scale * chunk[0, c] + abs(w[OFFSET * W + slot]) + high * pitch * chunk[2, c]) * h
            if push + inertia * pitch * chunk[3, c] < low * b:
                i += 64
                continue
        f, _ = onset(given, w, lane, slot, record, i, 0.0, linear)
        if f < NONE:
            return i
        i += 1
    return last


@inlined
def turning_point(theta: float, omega: float, theta1: float, omega1: float, step: float) -> float:
    """|theta| where the cubic through both ends of the step turns (two Newton steps from the secant)."""
    c = 3.0 * (theta1 - theta) - step * (2.0 * omega + omega1)
    d = 2.0 * (theta - theta1) + step * (omega + omega1)
    f = omega / (omega - omega1)
    for _ in range(2):
        curve = 2.0 * c + 6.0 * d * f
        if curve != 0.0:
            f -= (step * omega + f * (2.0 * c + 3.0 * d * f)) / curve
    f = min(1.0, max(0.0, f))
    return abs(theta + f * (step * omega + f * (c + f * d)))


@inlined
def raise_peak(result: Table, w: Table, lane: int, slot: int, size: float) -> None:
    """Keep the largest rotation of the run and of this swing."""
    result[lane, R_SWING] = max(result[lane, R_SWING], size)
    if size > result[lane, R_PEAK]:
        result[lane, R_PEAK] = size
        w[PEAK * W + slot] = size


@inlined
def land(
    given: Table, result: Table, w: Table, lane: int, slot: int, omega: float, time: float,
    log: Table, count: Table, linear: Any,
) -> float:  # fmt: skip
    """An impact at theta = 0 with velocity ``omega``: change of pivot, loss; returns the velocity after."""
    side = w[SIDE * W + slot]
    e = restitution(given, result, w, lane, slot, side, omega)
    before = kinetic_energy(given, w, lane, slot, side, omega)
    after = e * omega
    left = kinetic_energy(given, w, lane, slot, -side, after)
    result[lane, R_DISSIPATED] += before - left
    result[lane, R_IMPACTS] += 1.0
    note(log, count, lane, time, LOG_IMPACT)
    stand_on(given, w, lane, slot, -side, linear)
    calm = abs(after) < given[lane, Q_REST]
    if w[JOINT * W + slot] >= 0.0:
        result[lane, R_ENERGY] = max(result[lane, R_ENERGY], before)
        calm = left < 1e-6 * result[lane, R_ENERGY]
    if calm:
        result[lane, R_MODE] = DOWN
    result[lane, R_SWING] = 0.0
    return float(after)


@inlined
def demand_at_landing(
    w: Table, slot: int, omega: float, record: Table, i: int, f: float, general: Any, linear: Any
) -> None:
    """The friction demand just before an impact, where it jumps."""
    a, g, p, q = inputs(w, slot, record, i, f)
    accel, x, z, _ = acceleration(w, slot, 0.0, omega, a, g, p, q, general, linear)
    felt = a - g * p + w[H * W + slot] * q
    demand = friction_demand(w, slot, accel, omega, x, z, felt, g, general)
    w[DEMAND * W + slot] = max(w[DEMAND * W + slot], demand)


@called
def one_step(
    given: Table, result: Table, w: Table, lane: int, slot: int, record: Table, i: int, h: float,
    log: Table, count: Table, general: Any, linear: Any,
) -> None:  # fmt: skip
    """Advance a lane over step i from theta0, theta0' in ``work``, whatever happens in it."""
    theta, omega = w[TH0 * W + slot], w[OM0 * W + slot]
    f, rounds = 0.0, 0
    while f < 1.0:
        rounds += 1
        if rounds > MOST_IMPACTS_PER_STEP:
            result[lane, R_STATUS] = NOT_CONVERGED
            result[lane, R_MODE] = DOWN
            theta, omega = 0.0, 0.0
            break
        if result[lane, R_MODE] == DOWN:
            theta = 0.0
            at, side = onset(given, w, lane, slot, record, i, f, linear)
            if at == f and omega != 0.0:
                # a slow landing while the ground pushes on: the block keeps rocking
                side = w[SIDE * W + slot]
            else:
                result[lane, R_DISSIPATED] += kinetic_energy(given, w, lane, slot, w[SIDE * W + slot], omega)
                omega = 0.0
            since = result[lane, R_UP_SINCE]
            if at > f and since == since:
                result[lane, R_UPLIFT] += (i + f) * h - since
                result[lane, R_UP_SINCE] = math.nan
                note(log, count, lane, (i + f) * h, LOG_REST)
            if at >= 1.0:
                break
            f = at
            result[lane, R_MODE] = UP
            stand_on(given, w, lane, slot, side, linear)
            w[DIRECTION * W + slot] = side
            if not result[lane, R_UP_SINCE] == result[lane, R_UP_SINCE]:
                result[lane, R_UP_SINCE] = (i + f) * h
                note(log, count, lane, (i + f) * h, LOG_ONSET)
                if not result[lane, R_ONSET] == result[lane, R_ONSET]:
                    result[lane, R_ONSET] = (i + f) * h
        if result[lane, R_MODE] == HELD:
            if not released(w, slot, theta, record, i, f, general, linear):
                break
            result[lane, R_MODE] = UP
        if omega != 0.0:
            w[DIRECTION * W + slot] = 1.0 if omega > 0.0 else -1.0
        rest = 1.0 - f
        if rounds == 1 and f == 0.0 and w[LIMIT * W + slot] > 0.0:
            th1, om1, work = w[TH * W + slot], w[OM * W + slot], w[WORK_STEP * W + slot]
        else:
            th1, om1, work = part(w, slot, theta, omega, record, i, f, rest, h, general, linear)
        if w[SIDE * W + slot] * th1 < 0.0:
            rest, om1, work = crossing(
                w, slot, theta, omega, th1, om1, record, i, f, rest, h, general, linear
            )  # fmt: skip
            if omega * om1 < 0.0:
                raise_peak(result, w, lane, slot, turning_point(theta, omega, 0.0, om1, rest * h))
            f += rest
            w[WORK * W + slot] += work
            theta = 0.0
            demand_at_landing(w, slot, om1, record, i, f, general, linear)
            omega = land(given, result, w, lane, slot, om1, (i + f) * h, log, count, linear)
            continue
        if omega * om1 < 0.0:
            if w[COULOMB * W + slot] > 0.0:
                rest, th1, work = turning(w, slot, theta, omega, record, i, f, rest, h, general, linear)
                om1 = 0.0
                w[DIRECTION * W + slot] = -w[DIRECTION * W + slot]
                result[lane, R_MODE] = HELD
                raise_peak(result, w, lane, slot, abs(th1))
            else:
                raise_peak(result, w, lane, slot, turning_point(theta, omega, th1, om1, rest * h))
        w[WORK * W + slot] += work
        theta, omega, f = th1, om1, f + rest
    w[TH * W + slot], w[OM * W + slot] = theta, omega


@inlined
def part(
    w: Table, slot: int, theta: float, omega: float, record: Table, i: int, f: float, share: float, h: float,
    general: Any, linear: Any,
) -> tuple[float, float, float]:  # fmt: skip
    """theta, theta' and the work in couples after ``share`` of step i from its fraction f."""
    a0, g0, p0, q0 = inputs(w, slot, record, i, f)
    a1, g1, p1, q1 = inputs(w, slot, record, i, f + share)
    th1, om1, demand, work = rk4(
        w, slot, theta, omega, share * h, a0, a1, g0, g1, p0, p1, q0, q1, general, linear
    )
    w[DEMAND * W + slot] = max(w[DEMAND * W + slot], demand)
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


@called
def crossing(
    w: Table, slot: int, theta: float, omega: float, th1: float, om1: float, record: Table, i: int, f: float,
    rest: float, h: float, general: Any, linear: Any,
) -> tuple[float, float, float]:  # fmt: skip
    """Share of the step until theta = 0, theta' and work there: Newton within a bracket on the step itself.

    It stops where the last correction is under 1e-7 of the step and applies it to both: the error
    left is of its square.
    """
    side = w[SIDE * W + slot]
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
def released(
    w: Table, slot: int, theta: float, record: Table, i: int, f: float, general: Any, linear: Any
) -> bool:
    """Whether the other moments overcome the Coulomb couple that holds the block; sets its direction."""
    a, g, p, q = inputs(w, slot, record, i, f)
    for direction in (1.0, -1.0):
        w[DIRECTION * W + slot] = direction
        accel, _, _, _ = acceleration(w, slot, theta, 0.0, a, g, p, q, general, linear)
        if accel * direction > 0.0:
            return True
    return False
