"""A block that bounces: free flight of the rigid body between contacts, one lane.

Seen from the base, with the mass centre at (x, z): x'' = -(a - G psi + h psi''), z'' = -G, theta'' = -psi'':
closed forms over a step. The lowest corner is that on the side of sign(theta); it lands when
z = Z(theta). Landing: the corner's normal velocity w < 0 turns into -c w without slip, with the angular
momentum about the corner kept. A rebound under c |w| = b REST_VELOCITY p alpha is left out: contact.
"""

from __future__ import annotations

import math
from typing import Any

from models.housner.lanes import rows as r
from models.housner.lanes.impact import pivot
from models.housner.lanes.step import inputs, raise_peak, stand_on
from models.lanes.arrays import Table
from models.lanes.compiler import called, inlined


@inlined
def corner(given: Table, w: Table, lane: int, slot: int, theta: float) -> tuple[float, float, float, float]:
    """Of the body on the corner of sign(theta): x - slip and z of its mass centre, and their slopes in theta."""
    side = 1.0 if theta >= 0.0 else -1.0
    b, rho = pivot(given, w, lane, slot, side), given[lane, r.Q_RHO]
    height = given[lane, r.Q_HEIGHT] - rho
    sine, cosine = math.sin(theta), math.cos(theta)
    return (
        side * b * (1.0 - cosine) + rho * theta + height * sine,
        rho + side * b * sine + height * cosine,
        rho + side * b * sine + height * cosine,
        side * b * cosine - height * sine,
    )


@called
def shift(given: Table, result: Table, w: Table, lane: int, slot: int) -> float:
    """Displacement of the mass centre beyond that of rocking on corners that stay where they are, in m."""
    if result[lane, r.R_MODE] == r.FLIGHT:
        x, _, _, _ = corner(given, w, lane, slot, w[r.TH, slot])
        return float(w[r.U, slot] - x)
    if given[lane, r.Q_FREQUENCY] < math.inf:
        return float(given[lane, r.Q_MODAL_FORCE] * w[r.U, slot] * math.cos(w[r.TH, slot]))
    return float(w[r.U, slot])


@inlined
def energy(given: Table, lane: int, omega: float, across: float, up: float) -> float:
    """Kinetic energy in J of the free body."""
    translation = given[lane, r.Q_MASS] * (across * across + up * up)
    return float(0.5 * (given[lane, r.Q_INERTIA] * omega * omega + translation))


@called
def take_off(given: Table, result: Table, w: Table, lane: int, slot: int, before: float, after: float) -> float:
    """After an impact at theta = 0: the landed corner (on ``SIDE``) leaves; returns theta' then.

    ``before`` is theta' before the impact, ``after`` what the law of restitution left of it.
    """
    side, height = w[r.SIDE, slot], given[lane, r.Q_HEIGHT]
    new, old = pivot(given, w, lane, slot, side), pivot(given, w, lane, slot, -side)
    rebound = given[lane, r.Q_BOUNCE] * (old + new) * abs(before)
    if rebound <= new * given[lane, r.Q_REST]:
        return float(after)
    omega = after - given[lane, r.Q_BOUNCE] * (before - after)
    across, up = height * omega, rebound + side * new * omega
    result[lane, r.R_DISSIPATED] += energy(given, lane, after, height * after, side * new * after)
    result[lane, r.R_DISSIPATED] -= energy(given, lane, omega, across, up)
    result[lane, r.R_MODE] = r.FLIGHT
    w[r.U1, slot] = across
    w[r.Z, slot], w[r.Z1, slot] = height, up
    return float(omega)


@called
def fly(
    given: Table, result: Table, w: Table, lane: int, slot: int, theta: float, omega: float, record: Table,
    i: int, f: float, h: float, linear: Any,
) -> tuple[float, float, float]:  # fmt: skip
    """Free flight from the fraction f of step i to its end or to a landing: the fraction, theta, theta' then."""
    height = given[lane, r.Q_HEIGHT]
    x, across = w[r.U, slot], w[r.U1, slot]
    z, up = w[r.Z, slot], w[r.Z1, slot]
    a0, g0, p0, q0 = inputs(w, slot, record, i, f)
    a1, g1, p1, q1 = inputs(w, slot, record, i, 1.0)
    whole = (1.0 - f) * h
    ax, az, at = -(a0 - g0 * p0 + height * q0), -g0, -q0
    bx = (-(a1 - g1 * p1 + height * q1) - ax) / whole
    bz, bt = (g0 - g1) / whole, (q0 - q1) / whole
    time, landed = whole, False
    for _ in range(100):
        # the corner's height is concave in time: Newton from beyond the landing closes in from that side
        turn = theta + time * (omega + time * (0.5 * at + time * bt / 6.0))
        rise = z + time * (up + time * (0.5 * az + time * bz / 6.0))
        _, level, _, slope = corner(given, w, lane, slot, turn)
        gap = rise - level
        if gap >= 0.0 and not landed:
            break
        landed = True
        rate = up + time * (az + 0.5 * time * bz) - slope * (omega + time * (at + 0.5 * time * bt))
        more = -gap / rate if rate < 0.0 else -0.5 * time
        time = min(whole, max(0.0, time + more))
        if abs(more) <= 1e-13 * h:
            break
    th1 = theta + time * (omega + time * (0.5 * at + time * bt / 6.0))
    om1 = omega + time * (at + 0.5 * time * bt)
    w[r.U, slot] = x + time * (across + time * (0.5 * ax + time * bx / 6.0))
    w[r.U1, slot] = across + time * (ax + 0.5 * time * bx)
    w[r.Z, slot] = z + time * (up + time * (0.5 * az + time * bz / 6.0))
    w[r.Z1, slot] = up + time * (az + 0.5 * time * bz)
    raise_peak(result, w, lane, slot, abs(th1))
    if not landed:
        return 1.0, th1, om1
    om1 = touch(given, result, w, lane, slot, th1, om1, linear)
    return f + time / h, th1, om1


@inlined
def touch(
    given: Table, result: Table, w: Table, lane: int, slot: int, theta: float, omega: float, linear: Any
) -> float:
    """A corner lands out of the air: it leaves again or stays; returns theta' after it."""
    mass = given[lane, r.Q_MASS]
    across, up = w[r.U1, slot], w[r.Z1, slot]
    x, _, sway, lift = corner(given, w, lane, slot, theta)
    rebound = -given[lane, r.Q_BOUNCE] * (up - lift * omega)
    if rebound <= pivot(given, w, lane, slot, 1.0 if theta >= 0.0 else -1.0) * given[lane, r.Q_REST]:
        rebound = 0.0
    momentum = given[lane, r.Q_INERTIA] / mass * omega + sway * across + lift * (up - rebound)
    after = momentum / (given[lane, r.Q_INERTIA] / mass + sway * sway + lift * lift)
    result[lane, r.R_DISSIPATED] += energy(given, lane, omega, across, up)
    across, up = sway * after, rebound + lift * after
    result[lane, r.R_DISSIPATED] -= energy(given, lane, after, across, up)
    side = 1.0 if theta >= 0.0 else -1.0
    if side != w[r.SIDE, slot]:
        result[lane, r.R_IMPACTS] += 1.0
        result[lane, r.R_SWING] = 0.0
        stand_on(given, w, lane, slot, side, linear)
    w[r.U1, slot], w[r.Z1, slot] = across, up
    if rebound == 0.0:
        result[lane, r.R_MODE] = r.UP
        w[r.U, slot] -= x
        w[r.U1, slot] = 0.0
    return float(after)
