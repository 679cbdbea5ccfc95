"""What a lane gathers: peaks, forces, time up, energies; step after step and at the switches of a joint."""

from __future__ import annotations

import math

from models.interface_linear.equation import FULL, HELD_RIGHT, STATES
from models.interface_linear.lanes import rows as r
from models.interface_linear.lanes.rows import ACC, RATE, VALUE, A, G
from models.lanes.arrays import Table
from models.lanes.compiler import inlined


@inlined
def share_and_side(state: int) -> tuple[float, float]:
    """1 + g and the side of the half of a joint; a held joint counts as full, the rest of its force apart."""
    side = 1.0 if state == 1 else -1.0
    half = (state != FULL) & (state < HELD_RIGHT)
    return (1.0 if half else 2.0), (side if half else 0.0)


@inlined
def form(b: float, share: float, side: float, turn: float, z: float, turn_2: float, z_2: float) -> float:
    """The strip's bilinear form of (turn, z) and (turn_2, z_2), per metre of contact."""
    both = b * b / 3.0 * turn * turn_2 + z * z_2
    return share * b * both - side * 0.5 * b * b * (turn * z_2 + turn_2 * z)


@inlined
def stored(given: Table, lane: int, joint: int, state: int, x: Table) -> float:
    """Elastic energy (J) of a joint in the configuration in use."""
    b, k = given[lane, r.B_B + joint], given[lane, r.K_B + joint]
    share, side = share_and_side(state)
    turn = x[1] - x[0] if joint == 1 else x[0]
    return float(0.5 * k * form(b, share, side, turn, x[2 + joint], turn, x[2 + joint]))


@inlined
def loss(given: Table, lane: int, joint: int, state: int, x: Table, reading: Table) -> tuple[float, float]:
    """Power (W) that a joint takes out, and its rate."""
    b, c = given[lane, r.B_B + joint], given[lane, r.C_B + joint]
    share, side = share_and_side(state)
    turn, fast = (x[5] - x[4], reading[ACC + 1] - reading[ACC]) if joint == 1 else (x[4], reading[ACC])
    z_rate, z_second = x[6 + joint], reading[ACC + 2 + joint]
    power = c * form(b, share, side, turn, z_rate, turn, z_rate)
    growth = 2.0 * c * form(b, share, side, turn, z_rate, fast, z_second)
    if state >= HELD_RIGHT:
        # the force mu d works with d q' = s b^3/3 r' while h' = 0; mu = -sigma_u times the watched value
        arm = (1.0 if state == HELD_RIGHT else -1.0) * b * b * b / 3.0 * given[lane, r.SIGMA_B + joint]
        mu, mu_rate = reading[VALUE + 2 * joint], reading[RATE + 2 * joint]
        power += arm * mu * turn
        growth += arm * (mu_rate * turn + mu * fast)
    return power, growth


@inlined
def summit(t0: float, v0: float, t1: float, v1: float, t: float) -> float:
    """Where its rate changes sign: the cubic through values and rates at both ends of a step; else the first value."""
    if not v0 * v1 < 0.0:
        return t0
    r0, r1, change = t * v0, t * v1, t1 - t0
    second, third = 3.0 * change - 2.0 * r0 - r1, r0 + r1 - 2.0 * change
    root = math.copysign(math.sqrt(max(second * second - 3.0 * third * r0, 0.0)), r0)
    s = r0 / (root - second)
    return float(t0 + s * (r0 + s * (second + s * third)))


@inlined
def peak(t0: float, v0: float, t1: float, v1: float, t: float) -> float:
    """Largest |theta| of the cubic."""
    return max(abs(t0), abs(t1), abs(summit(t0, v0, t1, v1, t)))


@inlined
def edge(given: Table, lane: int, joint: int, x0: Table, x1: Table, t: float) -> float:
    """Largest compression (m) of a joint's ends, each on its cubic."""
    largest = -x0[2 + joint]
    for end in range(2):
        arm = (1.0 - 2.0 * end) * given[lane, r.B_B + joint]
        if joint == 1:
            u0, v0 = arm * (x0[1] - x0[0]) - x0[3], arm * (x0[5] - x0[4]) - x0[7]
            u1, v1 = arm * (x1[1] - x1[0]) - x1[3], arm * (x1[5] - x1[4]) - x1[7]
        else:
            u0, v0, u1, v1 = arm * x0[0] - x0[2], arm * x0[4] - x0[6], arm * x1[0] - x1[2], arm * x1[4] - x1[6]
        largest = max(largest, u0, u1, summit(u0, v0, u1, v1, t))
    return float(largest)


@inlined
def forces(gathered: Table, given: Table, lane: int, x: Table, reading: Table) -> None:
    """Forces along and across both joints, where their ratio is the worst so far; no force where bonded."""
    m1, m2 = given[lane, r.M1], given[lane, r.M2]
    along = x[A] + given[lane, r.LEVER] * reading[ACC] + given[lane, r.H2] * reading[ACC + 1]
    across = max(m2 * (x[G] + reading[ACC + 2] + reading[ACC + 3]), 0.0)
    base = abs(m2 * along + m1 * (x[A] + given[lane, r.H1] * reading[ACC]))
    down = max(m2 * (x[G] + reading[ACC + 2] + reading[ACC + 3]) + m1 * (x[G] + reading[ACC + 2]), 0.0)
    worse(gathered, 0, base, down)
    # across the wall's top, which leans by theta1
    worse(gathered, 1, abs(m2 * along - x[0] * across), across)


@inlined
def worse(gathered: Table, joint: int, along: float, across: float) -> None:
    if along * gathered[r.ACROSS_B + joint] > gathered[r.ALONG_B + joint] * across:
        gathered[r.ALONG_B + joint], gathered[r.ACROSS_B + joint] = along, across


@inlined
def look(gathered: Table, given: Table, lane: int, c: int, x: Table, reading: Table) -> None:
    """What is read off one state: kinetic energy, forces, least share of contact."""
    v1, v2, y1, y2 = x[4], x[5], x[6], x[7]
    kinetic = 0.5 * (given[lane, r.I11] * v1 * v1 + given[lane, r.I22] * v2 * v2 + given[lane, r.M1] * y1 * y1)
    kinetic += given[lane, r.I12] * v1 * v2 + 0.5 * given[lane, r.M2] * (y1 + y2) * (y1 + y2)
    gathered[r.KINETIC], gathered[r.WINDOW] = max(gathered[r.KINETIC], kinetic), max(gathered[r.WINDOW], kinetic)
    forces(gathered, given, lane, x, reading)
    for joint in range(2):
        state = c // STATES if joint == 0 else c % STATES
        if state != FULL:
            turn = x[1] - x[0] if joint == 1 else x[0]
            apart = x[2 + joint] >= given[lane, r.B_B + joint] * abs(turn)
            gathered[r.SHARE_B + joint] = min(gathered[r.SHARE_B + joint], 0.0 if apart else 0.5)


@inlined
def gather(
    gathered: Table, given: Table, lane: int, c: int, x0: Table, before: Table, x1: Table, after: Table, t: float,
) -> None:  # fmt: skip
    """Over a step of length t (s) in configuration c.

    The lost power is integrated by the cubic rule t/2 (P0 + P1) + t^2/12 (P0' - P1').
    """
    gathered[r.PEAK_1] = max(gathered[r.PEAK_1], peak(x0[0], x0[4], x1[0], x1[4], t))
    gathered[r.PEAK_2] = max(gathered[r.PEAK_2], peak(x0[1], x0[5], x1[1], x1[5], t))
    for joint in range(2):
        state = c // STATES if joint == 0 else c % STATES
        gathered[r.UP_B + joint] += t if state != FULL else 0.0
        gathered[r.EDGE_B + joint] = max(gathered[r.EDGE_B + joint], edge(given, lane, joint, x0, x1, t))
        p0, g0 = loss(given, lane, joint, state, x0, before)
        p1, g1 = loss(given, lane, joint, state, x1, after)
        gathered[r.LOST_B + joint] += 0.5 * t * (p0 + p1) + t * t / 12.0 * (g0 - g1)
    look(gathered, given, lane, c, x1, after)
