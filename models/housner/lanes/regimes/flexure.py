"""A wall that bends while it rocks or stands, one lane; equations in `models.housner.reference.flexure`.

All over M: m, f, k the mode's mass, force and moment integrals. U, U1 hold its amplitude eta and eta'. The
rigid block's theta'' brings in gravity, the ground and all couples; the mode adds its own terms.
"""

from __future__ import annotations

import math
from typing import Any

from models.housner.cantilever import STRUCTURAL_DAMPING
from models.housner.declaration import MOST_IMPACTS_PER_STEP
from models.housner.lanes import rows as r
from models.housner.lanes.equation import acceleration
from models.housner.lanes.impact import pivot, restitution
from models.housner.lanes.step import come_down, inputs, lift_off, raise_peak, stand_on
from models.lanes.arrays import Counts, Table
from models.lanes.compiler import called
from models.lanes.events import note, turning_point


@called
def bend(
    given: Table, result: Table, w: Table, lane: int, slot: int, record: Table, i: int, h: float,
    log: Table, count: Counts, general: Any, linear: Any,
) -> None:  # fmt: skip
    """Advance a lane over step i, in full contact or rocking."""
    w[r.TH, slot], w[r.OM, slot] = w[r.TH0, slot], w[r.OM0, slot]
    f, rounds = 0.0, 0
    while f < 1.0:
        rounds += 1
        if rounds > MOST_IMPACTS_PER_STEP:
            result[lane, r.R_STATUS], result[lane, r.R_MODE] = r.NOT_CONVERGED, r.RINGING
            for row in (r.TH, r.OM, r.U, r.U1):
                w[row, slot] = 0.0
            break
        f = piece(given, result, w, lane, slot, record, i, f, h, log, count, general, linear)


@called
def relax(given: Table, w: Table, lane: int, slot: int, record: Table, i: int, general: Any, linear: Any) -> None:
    """The mode starts where it would stay under the rigid block's motion."""
    theta, omega = w[r.TH, slot], w[r.OM, slot]
    a, g, p, q = inputs(w, slot, record, i, 0.0)
    second, _, _, _ = acceleration(w, slot, theta, omega, a, g, p, q, general, linear)
    m, k, force = given[lane, r.Q_MODAL_MASS], given[lane, r.Q_MODAL_MOMENT], given[lane, r.Q_MODAL_FORCE]
    b = w[r.SIDE, slot] * pivot(given, w, lane, slot, w[r.SIDE, slot])
    push = force * (g * math.sin(theta) - (a - g * p) * math.cos(theta)) - k * (second + q) - b * force * omega * omega
    w[r.U, slot] = push / (m * given[lane, r.Q_FREQUENCY] ** 2)


@called
def rates(
    given: Table, w: Table, lane: int, slot: int, up: bool, theta: float, omega: float, eta: float, speed: float,
    a: float, g: float, p: float, q: float, general: Any, linear: Any,
) -> tuple[float, float, float, float, float]:  # fmt: skip
    """theta'', eta'', the power lost in couples and in bending over M; for the reactions X_theta, Z_theta (m).

    theta is held where not ``up``.
    """
    m, k, force = given[lane, r.Q_MODAL_MASS], given[lane, r.Q_MODAL_MOMENT], given[lane, r.Q_MODAL_FORCE]
    natural = given[lane, r.Q_FREQUENCY]
    sine, cosine = math.sin(theta), math.cos(theta)
    base = a - g * p
    loss = 2.0 * STRUCTURAL_DAMPING * natural * speed
    push = force * (g * sine - base * cosine) - m * (loss + natural * natural * eta) - k * q
    if not up:
        return 0.0, push / m, m * loss * speed, 0.0, 0.0
    second, x, z, power = acceleration(w, slot, theta, omega, a, g, p, q, general, linear)
    bf = w[r.SIDE, slot] * pivot(given, w, lane, slot, w[r.SIDE, slot]) * force
    rigid = w[r.IM, slot] + x * x + z * z
    inertia = rigid - 2.0 * bf * eta + m * eta * eta
    push += omega * omega * (m * eta - bf)
    moment = rigid * second + force * eta * (g * cosine + base * sine) - 2.0 * omega * speed * (m * eta - bf)
    alpha = (moment - k / m * push) / (inertia - k * k / m)
    return alpha, (push - k * alpha) / m, power + m * loss * speed, x, z


@called
def move(
    given: Table, w: Table, lane: int, slot: int, up: bool, start: tuple[float, float, float, float, float],
    record: Table, i: int, f: float, share: float, h: float, general: Any, linear: Any,
) -> tuple[float, float, float, float, float]:  # fmt: skip
    """theta, theta', eta, eta' and the work lost over M after ``share`` of step i from its fraction f.

    ``start``: the `rates` there.
    """
    theta, omega = w[r.TH, slot], w[r.OM, slot]
    eta, speed = w[r.U, slot], w[r.U1, slot]
    step = share * h
    th, om, et, sp = theta, omega, eta, speed
    d_th, d_om, d_et, d_sp, work = 0.0, 0.0, 0.0, 0.0, 0.0
    for stage in range(4):
        alpha, beta, power, _, _ = start
        if stage > 0:
            a, g, p, q = inputs(w, slot, record, i, f + (1.0 if stage == 3 else 0.5) * share)
            alpha, beta, power, _, _ = rates(given, w, lane, slot, up, th, om, et, sp, a, g, p, q, general, linear)
        weight = step / 6.0 if stage == 0 or stage == 3 else step / 3.0
        d_th, d_om = d_th + weight * om, d_om + weight * alpha
        d_et, d_sp = d_et + weight * sp, d_sp + weight * beta
        work += weight * power
        ahead = step if stage == 2 else 0.5 * step
        th, om, et, sp = theta + ahead * om, omega + ahead * alpha, eta + ahead * sp, speed + ahead * beta
    return theta + d_th, omega + d_om, eta + d_et, speed + d_sp, work


@called
def note_demand(
    given: Table, w: Table, lane: int, slot: int, start: tuple[float, float, float, float, float],
    a: float, g: float, p: float, q: float,
) -> None:  # fmt: skip
    """The friction demand |H|/N at the corner, the bending wall's inertia included, where the `rates` are ``start``."""
    theta, omega = w[r.TH, slot], w[r.OM, slot]
    eta, speed = w[r.U, slot], w[r.U1, slot]
    alpha, beta, _, x, z = start
    force, sine, cosine = given[lane, r.Q_MODAL_FORCE], math.sin(theta), math.cos(theta)
    across, along = beta - eta * omega * omega, 2.0 * speed * omega + eta * alpha
    right = a - g * p + w[r.H, slot] * q + x * alpha + z * omega * omega
    right += force * (across * cosine - along * sine)
    up = g + z * alpha - (x - w[r.RHO, slot]) * omega * omega - force * (across * sine + along * cosine)
    demand = abs(right) / up if up > 0.0 else 1e300
    w[r.DEMAND, slot] = max(w[r.DEMAND, slot], demand)


@called
def lifting(
    given: Table, w: Table, lane: int, slot: int, side: float, eta: float, beta: float,
    a: float, g: float, p: float, q: float,
) -> float:  # fmt: skip
    """Moment over M, the bending wall's included, that lifts the base onto ``side``: positive means uplift.

    ``beta``: eta'' of the wall that stands.
    """
    h = given[lane, r.Q_HEIGHT]
    own = given[lane, r.Q_INERTIA] / given[lane, r.Q_MASS] + h * h
    moment = given[lane, r.Q_MODAL_MOMENT] * beta + (a - g * p) * h + own * q - g * given[lane, r.Q_MODAL_FORCE] * eta
    return float(-side * moment - g * pivot(given, w, lane, slot, side) - w[r.COULOMB, slot])


@called
def piece(
    given: Table, result: Table, w: Table, lane: int, slot: int, record: Table, i: int, f: float, h: float,
    log: Table, count: Counts, general: Any, linear: Any,
) -> float:  # fmt: skip
    """From the fraction f of step i until it ends, or to an uplift or impact; returns the fraction."""
    up = result[lane, r.R_MODE] == r.UP
    theta, omega = w[r.TH, slot], w[r.OM, slot]
    side = w[r.SIDE, slot]
    eta, speed = w[r.U, slot], w[r.U1, slot]
    a, g, p, q = inputs(w, slot, record, i, f)
    if up and omega != 0.0:
        w[r.DIRECTION, slot] = 1.0 if omega > 0.0 else -1.0
    start = rates(given, w, lane, slot, up, theta, omega, eta, speed, a, g, p, q, general, linear)
    if up:
        note_demand(given, w, lane, slot, start, a, g, p, q)
    else:
        for s in (1.0, -1.0):
            if lifting(given, w, lane, slot, s, eta, start[1], a, g, p, q) > 0.0:
                lift_off(given, result, w, lane, slot, s, (i + f) * h, log, count, linear)
                return f
    low, high, side_up = 0.0, 1.0 - f, 0.0
    th1, om1, eta1, speed1, work = move(given, w, lane, slot, up, start, record, i, f, high, h, general, linear)
    over = up and side * th1 < 0.0
    if not up:
        a, g, p, q = inputs(w, slot, record, i, 1.0)
        _, beta, _, _, _ = rates(given, w, lane, slot, False, 0.0, 0.0, eta1, speed1, a, g, p, q, general, linear)
        for s in (1.0, -1.0):
            if lifting(given, w, lane, slot, s, eta1, beta, a, g, p, q) > 0.0:
                side_up, over = s, True
    share = high
    if over:
        before, after, margin = 0.0, 0.0, 0.0
        for k in range(100):
            if high - low <= 1e-14:
                break
            share = 0.5 * (low + high)
            if before > 0.0 and after < 0.0 and k % 3 < 2:
                share = low + (high - low) * before / (before - after)
                share = min(max(share + (1e-3 if k % 3 else -1e-3) * (high - low), low), high)
            th1, om1, eta1, speed1, work = move(
                given, w, lane, slot, up, start, record, i, f, share, h, general, linear
            )
            if up:
                margin = side * th1
            else:
                a, g, p, q = inputs(w, slot, record, i, f + share)
                rest = rates(given, w, lane, slot, False, 0.0, 0.0, eta1, speed1, a, g, p, q, general, linear)
                margin = -lifting(given, w, lane, slot, side_up, eta1, rest[1], a, g, p, q)
            if margin > 0.0:
                low, before = share, margin
            else:
                high, after = share, margin
        share = high
        th1, om1, eta1, speed1, work = move(given, w, lane, slot, up, start, record, i, f, share, h, general, linear)
    if omega * om1 < 0.0:
        raise_peak(result, w, lane, slot, turning_point(theta, omega, th1, om1, share * h))
    w[r.TH, slot], w[r.OM, slot] = th1, om1
    w[r.U, slot], w[r.U1, slot] = eta1, speed1
    w[r.WORK, slot] += work
    if not over:
        return 1.0
    if up:
        w[r.TH, slot] = 0.0
        land(given, result, w, lane, slot, (i + f + share) * h, log, count, linear)
    else:
        lift_off(given, result, w, lane, slot, side_up, (i + f + share) * h, log, count, linear)
    return f + share


@called
def land(
    given: Table, result: Table, w: Table, lane: int, slot: int, time: float, log: Table, count: Counts, linear: Any
) -> None:
    """An impact at theta = 0: the law of `models.housner.reference.flexure`."""
    side, omega = w[r.SIDE, slot], w[r.OM, slot]
    eta, speed = w[r.U, slot], w[r.U1, slot]
    m, k, force = given[lane, r.Q_MODAL_MASS], given[lane, r.Q_MODAL_MOMENT], given[lane, r.Q_MODAL_FORCE]
    own = given[lane, r.Q_INERTIA] / given[lane, r.Q_MASS] + given[lane, r.Q_HEIGHT] ** 2
    old, new = pivot(given, w, lane, slot, side), pivot(given, w, lane, slot, -side)
    e = restitution(given, result, w, lane, slot, side, omega)
    bulge = m * eta * eta
    j_old = own + old * old - 2.0 * side * old * force * eta + bulge
    j_new = own + new * new + 2.0 * side * new * force * eta + bulge
    kept = e * (own + new * new) + force * eta * side * (new - old) + bulge
    share = k * k / m
    before = 0.5 * (j_old * omega + 2.0 * k * speed) * omega + 0.5 * m * speed * speed
    om1 = (kept - share) / (j_new - share) * omega
    speed1 = speed + k / m * (omega - om1)
    note(log, count, lane, time, r.LOG_IMPACT, 1.0)
    result[lane, r.R_IMPACTS] += 1.0
    result[lane, r.R_SWING] = 0.0
    stand_on(given, w, lane, slot, -side, linear)
    if kept <= share or abs(om1) < given[lane, r.Q_REST]:
        om1 = 0.0
        speed1 = speed + min(kept, share) / k * omega
        result[lane, r.R_MODE] = r.RINGING
        come_down(result, lane, time, log, count)
    w[r.OM, slot], w[r.U1, slot] = om1, speed1
    left = 0.5 * (j_new * om1 + 2.0 * k * speed1) * om1 + 0.5 * m * speed1 * speed1
    result[lane, r.R_DISSIPATED] += given[lane, r.Q_MASS] * (before - left)
