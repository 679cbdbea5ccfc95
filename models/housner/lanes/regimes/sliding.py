"""A block that slides on its base while it rocks or stands, one lane.

With the slip u of the contact, X and Z of `models.housner.lanes.equation`, E = a - G psi + h psi'' and all over M:

    stuck      H = E + X theta'' + Z theta'^2,  N = G + Z theta'' - (X - rho) theta'^2,  while |H| <= mu N
    slipping   J theta'' + X u'' = moments,  u'' + X theta'' + Z theta'^2 + E = -mu N sign(u')
    flat       u'' = -E - mu G sign(u')

Where the equations of slip have no solution (Painleve) the corner jams: it sticks.
"""

from __future__ import annotations

import math
from typing import Any

from models.housner.declaration import MOST_IMPACTS_PER_STEP
from models.housner.lanes import rows as r
from models.housner.lanes.equation import acceleration
from models.housner.lanes.onset import excess, onset, slip_onset
from models.housner.lanes.regimes.slip_impact import JAM, land
from models.housner.lanes.step import inputs, lift_off, part, raise_peak, released
from models.lanes.arrays import Counts, Table
from models.lanes.compiler import called, inlined
from models.lanes.events import turning_point

CROSSING, REVERSAL, DEMAND, TURNING = 0, 1, 2, 3


@called
def slide(
    given: Table, result: Table, w: Table, lane: int, slot: int, record: Table, i: int, h: float,
    log: Table, count: Counts, general: Any, linear: Any,
) -> None:  # fmt: skip
    """Advance a lane over step i, stuck or slipping, rocking or flat."""
    w[r.TH, slot], w[r.OM, slot] = w[r.TH0, slot], w[r.OM0, slot]
    f, rounds = 0.0, 0
    while f < 1.0:
        rounds += 1
        if rounds > MOST_IMPACTS_PER_STEP:
            result[lane, r.R_STATUS], result[lane, r.R_MODE] = r.NOT_CONVERGED, r.DOWN
            w[r.TH, slot], w[r.OM, slot], w[r.U1, slot] = 0.0, 0.0, 0.0
            break
        if result[lane, r.R_MODE] == r.HELD:
            if not released(w, slot, w[r.TH, slot], record, i, f, general, linear):
                break
            result[lane, r.R_MODE] = r.UP
        if result[lane, r.R_MODE] == r.UP:
            f = rock(given, result, w, lane, slot, record, i, f, h, log, count, general, linear)
        else:
            f = stand(given, result, w, lane, slot, record, i, f, h, log, count, linear)


@called
def stand(
    given: Table, result: Table, w: Table, lane: int, slot: int, record: Table, i: int, f: float, h: float,
    log: Table, count: Counts, linear: Any,
) -> float:  # fmt: skip
    """Full contact, from the fraction f of step i until it ends or something changes; returns the fraction."""
    v, mu, height = w[r.U1, slot], given[lane, r.Q_FRICTION], given[lane, r.Q_HEIGHT]
    way = 1.0 if v > 0.0 else -1.0
    if v == 0.0:
        result[lane, r.R_MODE] = r.DOWN
        slip, way = slip_onset(given, w, lane, slot, record, i, f)
        lift, side = onset(given, w, lane, slot, record, i, f, linear)
        if slip >= 1.0 and lift >= 1.0:
            return 1.0
        if lift < slip:
            lift_off(given, result, w, lane, slot, side, (i + lift) * h, log, count, linear)
            return lift
        f = slip
    a0, g0, p0, q0 = inputs(w, slot, record, i, f)
    a1, g1, p1, q1 = inputs(w, slot, record, i, 1.0)
    j0 = -(a0 - g0 * p0 + height * q0) - way * mu * g0
    j1 = -(a1 - g1 * p1 + height * q1) - way * mu * g1
    for side in (1.0, -1.0):
        if excess(given, w, lane, slot, side, a0 + j0, g0, p0, q0, linear) > 0.0:
            # friction tips the block that slides
            lift_off(given, result, w, lane, slot, side, (i + f) * h, log, count, linear)
            return f
    result[lane, r.R_MODE] = r.SLIDING
    whole = (1.0 - f) * h
    bend = (j1 - j0) / whole
    time = min(whole, stop(v, j0, bend, way))
    v1 = v + time * (j0 + 0.5 * time * bend)
    middle = v + 0.5 * time * (j0 + 0.25 * time * bend)
    g_end = g0 + (g1 - g0) * time / whole
    w[r.WORK, slot] += mu * time / 6.0 * way * (g0 * v + 2.0 * (g0 + g_end) * middle + g_end * v1)
    w[r.U, slot] += time * (v + time * (j0 / 2.0 + time * bend / 6.0))
    if time < whole:
        w[r.U1, slot], result[lane, r.R_MODE] = 0.0, r.DOWN
        return f + time / h
    w[r.U1, slot] = v1
    return 1.0


@inlined
def stop(v: float, j0: float, bend: float, way: float) -> float:
    """First time > 0 at which the slip velocity v + j0 t + bend t^2/2, of sign ``way``, is zero."""
    v, j0, bend = way * v, way * j0, way * bend
    if v <= 0.0:
        return -2.0 * j0 / bend if bend < 0.0 else math.inf
    root = j0 * j0 - 2.0 * bend * v
    if root < 0.0:
        return math.inf
    time = 2.0 * v / (-j0 + math.sqrt(root)) if -j0 + math.sqrt(root) != 0.0 else math.inf
    return time if time > 0.0 else math.inf


@called
def reactions(
    w: Table, slot: int, theta: float, omega: float, a: float, g: float, p: float, q: float,
    general: Any, linear: Any,
) -> tuple[float, float, float]:  # fmt: skip
    """H/M and N/M (not under 0) of a stuck corner, and the inertia of slip without friction."""
    accel, x, z, _ = acceleration(w, slot, theta, omega, a, g, p, q, general, linear)
    across = a - g * p + w[r.H, slot] * q + x * accel + z * omega * omega
    up = g + z * accel - (x - w[r.RHO, slot]) * omega * omega
    return across, max(up, 0.0), w[r.IM, slot] + z * z


@called
def slip_rates(
    w: Table, slot: int, theta: float, omega: float, way: float, mu: float, a: float, g: float, p: float, q: float,
    general: Any, linear: Any,
) -> tuple[float, float, float, float]:  # fmt: skip
    """theta'', u'', mu N/M and the power lost in couples over M of a slipping corner."""
    accel, x, z, power = acceleration(w, slot, theta, omega, a, g, p, q, general, linear)
    jm = w[r.IM, slot] + x * x + z * z
    base = a - g * p + w[r.H, slot] * q + z * omega * omega
    lift = g - (x - w[r.RHO, slot]) * omega * omega
    second = (jm * accel + x * base + mu * way * x * lift) / (jm - x * x - mu * way * x * z)
    friction = mu * (lift + z * second)
    if friction < 0.0:
        # no friction where the corner would have to be held down
        second, friction = (jm * accel + x * base) / (jm - x * x), 0.0
    return second, -(base + x * second) - way * friction, friction, power


@called
def move(
    w: Table, slot: int, record: Table, i: int, f: float, share: float, h: float, way: float, mu: float,
    general: Any, linear: Any,
) -> tuple[float, float, float, float, float]:  # fmt: skip
    """theta, theta', u, u' and the work lost over M after ``share`` of step i from its fraction f."""
    theta, omega, u, v = w[r.TH, slot], w[r.OM, slot], w[r.U, slot], w[r.U1, slot]
    if way == 0.0:
        th1, om1, work = part(w, slot, theta, omega, record, i, f, share, h, general, linear)
        return th1, om1, u, v, work
    step = share * h
    half = 0.5 * step
    a0, g0, p0, q0 = inputs(w, slot, record, i, f)
    a2, g2, p2, q2 = inputs(w, slot, record, i, f + 0.5 * share)
    a4, g4, p4, q4 = inputs(w, slot, record, i, f + share)
    k1, l1, n1, e1 = slip_rates(w, slot, theta, omega, way, mu, a0, g0, p0, q0, general, linear)
    o2, v2 = omega + half * k1, v + half * l1
    k2, l2, n2, e2 = slip_rates(w, slot, theta + half * omega, o2, way, mu, a2, g2, p2, q2, general, linear)
    o3, v3 = omega + half * k2, v + half * l2
    k3, l3, n3, e3 = slip_rates(w, slot, theta + half * o2, o3, way, mu, a2, g2, p2, q2, general, linear)
    o4, v4 = omega + step * k3, v + step * l3
    k4, l4, n4, e4 = slip_rates(w, slot, theta + step * o3, o4, way, mu, a4, g4, p4, q4, general, linear)
    sixth = step / 6.0
    work = e1 + 2.0 * (e2 + e3) + e4 + way * (n1 * v + 2.0 * (n2 * v2 + n3 * v3) + n4 * v4)
    return (
        theta + sixth * (omega + 2.0 * (o2 + o3) + o4),
        omega + sixth * (k1 + 2.0 * (k2 + k3) + k4),
        u + sixth * (v + 2.0 * (v2 + v3) + v4),
        v + sixth * (l1 + 2.0 * (l2 + l3) + l4),
        sixth * work,
    )


@called
def margin(
    w: Table, slot: int, kind: int, theta: float, omega: float, v: float, way: float, mu: float,
    record: Table, i: int, f: float, general: Any, linear: Any,
) -> float:  # fmt: skip
    """What is positive before an event of this kind and negative after it."""
    if kind == CROSSING:
        return float(w[r.SIDE, slot] * theta)
    if kind == REVERSAL:
        return way * v
    if kind == TURNING:
        return float(w[r.OM, slot] * omega)
    a, g, p, q = inputs(w, slot, record, i, f)
    across, up, _ = reactions(w, slot, theta, omega, a, g, p, q, general, linear)
    return mu * up - abs(across)


@called
def locate(
    w: Table, slot: int, kind: int, record: Table, i: int, f: float, rest: float, h: float, way: float, mu: float,
    after: float, general: Any, linear: Any,
) -> float:  # fmt: skip
    """Share of the step, just behind the event, by secants and bisection; ``after`` is the margin at ``rest``."""
    low, high = 0.0, rest
    before = margin(
        w, slot, kind, w[r.TH, slot], w[r.OM, slot], w[r.U1, slot], way, mu, record, i, f,
        general, linear,
    )  # fmt: skip
    for k in range(100):
        if high - low <= 1e-14:
            break
        trial = 0.5 * (low + high)
        if before > 0.0 and k % 3 < 2:
            trial = low + (high - low) * before / (before - after)
            # a little beyond the secant's root, so that both ends close in
            trial = min(max(trial + (1e-3 if k % 3 else -1e-3) * (high - low), low), high)
        th1, om1, _, v1, _ = move(w, slot, record, i, f, trial, h, way, mu, general, linear)
        value = margin(w, slot, kind, th1, om1, v1, way, mu, record, i, f + trial, general, linear)
        if value > 0.0:
            low, before = trial, value
        else:
            high, after = trial, value
    return high


@called
def rock(
    given: Table, result: Table, w: Table, lane: int, slot: int, record: Table, i: int, f: float, h: float,
    log: Table, count: Counts, general: Any, linear: Any,
) -> float:  # fmt: skip
    """Rocking, from the fraction f of step i until it ends or something changes; returns the fraction."""
    mu = given[lane, r.Q_FRICTION]
    theta, omega = w[r.TH, slot], w[r.OM, slot]
    if omega != 0.0:
        w[r.DIRECTION, slot] = 1.0 if omega > 0.0 else -1.0
    a, g, p, q = inputs(w, slot, record, i, f)
    across, up, free = reactions(w, slot, theta, omega, a, g, p, q, general, linear)
    v = w[r.U1, slot]
    way = 0.0
    if v != 0.0:
        way = 1.0 if v > 0.0 else -1.0
    elif abs(across) > mu * up:
        way = -1.0 if across > 0.0 else 1.0
    if way != 0.0:
        _, x, z, _ = acceleration(w, slot, theta, omega, a, g, p, q, general, linear)
        if free - mu * way * x * z < JAM * free:
            way = 0.0
            if v != 0.0:
                jm = free + x * x
                result[lane, r.R_DISSIPATED] += 0.5 * given[lane, r.Q_MASS] * v * v * free / jm
                omega += x * v / jm
                w[r.OM, slot], w[r.U1, slot] = omega, 0.0
        else:
            w[r.DEMAND, slot] = max(w[r.DEMAND, slot], mu)
    jammed = way == 0.0 and abs(across) > mu * up
    rest, what = 1.0 - f, -1
    th1, om1, u1, v1, work = move(w, slot, record, i, f, rest, h, way, mu, general, linear)
    for kind in (CROSSING, REVERSAL, DEMAND, TURNING):
        if (kind == REVERSAL) != (way != 0.0) and kind in (REVERSAL, DEMAND):
            continue
        if (kind == DEMAND and jammed) or (kind == TURNING and w[r.COULOMB, slot] == 0.0):
            continue
        after = margin(w, slot, kind, th1, om1, v1, way, mu, record, i, f + rest, general, linear)
        if after < 0.0:
            rest = locate(w, slot, kind, record, i, f, rest, h, way, mu, after, general, linear)
            what = kind
            th1, om1, u1, v1, work = move(w, slot, record, i, f, rest, h, way, mu, general, linear)
    if omega * om1 < 0.0:
        raise_peak(result, w, lane, slot, turning_point(theta, omega, th1, om1, rest * h))
    f = 1.0 if what < 0 else f + rest
    w[r.WORK, slot] += work
    w[r.TH, slot], w[r.OM, slot] = th1, om1
    w[r.U, slot], w[r.U1, slot] = u1, 0.0 if what == REVERSAL else v1
    if what == CROSSING:
        w[r.TH, slot] = 0.0
        land(given, result, w, lane, slot, record, i, f, h, log, count, linear)
    elif what == TURNING:
        w[r.OM, slot] = 0.0
        w[r.DIRECTION, slot] = -w[r.DIRECTION, slot]
        result[lane, r.R_MODE] = r.HELD
    return f
