"""Where in a step something happens, one lane."""

from __future__ import annotations

from typing import Any

from models.lanes.arrays import Table
from models.lanes.chunks import CHUNK
from models.lanes.compiler import called, inlined
from models.stacked.lanes import rows as r
from models.stacked.lanes.equation import contact, rk4

State = tuple[float, float, float, float]
Pair = tuple[float, float]
NONE = 2.0
"""A fraction of the step that never comes."""
LATE = 1e-6
"""Share of the moment at the end of the step by which an opening is located late."""


@inlined
def base(w: Table, slot: int, record: Table, i: int, f: float, general: Any) -> tuple[float, float, Any, Any]:
    """The base's own acceleration, G, psi and psi'' at the fraction f of step i; None of a base that does not pitch."""
    # the record may jump to zero at its end: no part of its last sample acts in the step after it
    live = record[4, i]
    first, second = live * (1.0 - f), live * f
    a = first * record[0, i] + second * record[0, i + 1]
    v = first * record[1, i] + second * record[1, i + 1]
    a, g = w[r.SCALE, slot] * a + w[r.OFFSET, slot], w[r.GRAVITY, slot] + w[r.VSCALE, slot] * v
    if general is None:
        return a, g, None, None
    pitch = w[r.PITCH, slot]
    psi, turning = first * record[2, i] + second * record[2, i + 1], first * record[3, i] + second * record[3, i + 1]
    return a, g, pitch * psi, pitch * turning


@inlined
def inputs(w: Table, slot: int, record: Table, i: int, f: float, general: Any) -> tuple[float, float, Any]:
    """a, G and psi'' at the fraction f of step i."""
    a, g, psi, turning = base(w, slot, record, i, f, general)
    if general is not None:
        a -= g * psi
    return a, g, turning


@called
def onset(given: Table, w: Table, lane: int, slot: int, record: Table, i: int, f: float, general: Any) -> float:
    """First fraction >= f of step i at which the stack leaves rest, NONE if it stays.

    A joint opens where -p > G k to the right or p > G k to the left, p = a + (couple over -psi'') psi''/(M h) and k the
    slenderness (tangent) on that side, of both as one body or of the upper block; dry friction holds the base.
    """
    a0, g0, turning0 = inputs(w, slot, record, i, f, general)
    a1, g1, turning1 = inputs(w, slot, record, i, 1.0, general)
    first = NONE
    for joint in range(2):
        p0, p1, dry = a0, a1, 0.0
        if general is not None:
            lever = frame(given, lane, joint)
            dry = given[lane, r.P_COULOMB] / moment(given, lane) if joint == 0 else 0.0
            p0, p1 = a0 + lever * turning0, a1 + lever * turning1
        for side in (1.0, -1.0):
            k = given[lane, (r.P_RIGHT_1 if side > 0.0 else r.P_LEFT_1) + 2 * joint]
            m0 = -side * p0 - g0 * k - dry
            m1 = -side * p1 - g1 * k - dry
            if m0 > 0.0:
                first = f
            elif m1 > 0.0:
                first = min(first, f + (1.0 - f) * (-m0) / (m1 - m0))
    return first


@inlined
def moment(given: Table, lane: int) -> float:
    """M h: mass and height of the centre of both as one body."""
    high = given[lane, r.P_TALL] + given[lane, r.P_H2]
    return float(given[lane, r.P_M1] * given[lane, r.P_H1] + given[lane, r.P_M2] * high)


@inlined
def frame(given: Table, lane: int, joint: int) -> float:
    """Couple over -psi'' on what turns about a joint, over its mass and the height of its centre."""
    if joint == 1:
        return float(given[lane, r.P_FRAME_2] / (given[lane, r.P_M2] * given[lane, r.P_H2]))
    return float(given[lane, r.P_FRAME_1] / moment(given, lane))


@called
def next_onset(
    given: Table, w: Table, lane: int, slot: int, record: Table, i: int, last: int, chunk: Table, general: Any
) -> int:
    """First step from i on in which the resting stack is lifted, ``last`` if there is none.

    ``chunk`` (4, n) holds the extremes of the record over `CHUNK` steps: |a|, |a_z|, |psi|, |psi''|.
    """
    k = min(
        min(given[lane, r.P_RIGHT_1], given[lane, r.P_LEFT_1]), min(given[lane, r.P_RIGHT_2], given[lane, r.P_LEFT_2])
    )
    scale, lift, pitch = abs(w[r.SCALE, slot]), abs(w[r.VSCALE, slot]), abs(w[r.PITCH, slot])
    lever = max(frame(given, lane, 0), frame(given, lane, 1))
    while i < last:
        if i % CHUNK == 0 and i + CHUNK <= last:
            c = i // CHUNK
            up = lift * chunk[1, c]
            push = scale * chunk[0, c] + abs(w[r.OFFSET, slot])
            push += pitch * ((w[r.GRAVITY, slot] + up) * chunk[2, c] + lever * chunk[3, c])
            if push < (w[r.GRAVITY, slot] - up) * k:
                i += CHUNK
                continue
        if onset(given, w, lane, slot, record, i, 0.0, general) < NONE:
            return i
        i += 1
    return last


@called
def look(
    w: Table, slot: int, state: State, record: Table, i: int, f: float, linear: Any, general: Any
) -> tuple[Pair, Pair, Pair]:
    """`contact` of a state at fraction f of step i: q'', margins and friction demands of both joints."""
    a, g, turning = inputs(w, slot, record, i, f, general)
    x1, x2, m1, m2, d1, d2 = contact(w, slot, state[0], state[1], state[2], state[3], a, g, turning, linear)
    return (x1, x2), (m1, m2), (d1, d2)


@called
def part(
    w: Table, slot: int, state: State, second: Pair, record: Table, i: int, f: float, share: float, h: float,
    linear: Any, general: Any,
) -> tuple[State, Pair, Pair, Pair, float]:  # fmt: skip
    """State, q'', margins, demands and work after ``share`` of step i from its fraction f."""
    a0, g0, psi0, turning0 = base(w, slot, record, i, f, general)
    a1, g1, psi1, turning1 = base(w, slot, record, i, f + share, general)
    pitch = None
    if general is not None:
        pitch = psi0, psi1, turning0, turning1
    q1, q2, v1, v2, work = rk4(
        w, slot, state[0], state[1], state[2], state[3], second[0], second[1], share * h, a0, a1, g0, g1, pitch, linear
    )
    if general is not None:
        a1 -= g1 * psi1
    x1, x2, m1, m2, d1, d2 = contact(w, slot, q1, q2, v1, v2, a1, g1, turning1, linear)
    return (q1, q2, v1, v2), (x1, x2), (m1, m2), (d1, d2), work


@inlined
def hermite_root(q: float, v: float, x: float, q_end: float, v_end: float, x_end: float, step: float) -> float:
    """Fraction of the step at which the quintic through both ends passes zero (q_end beyond it)."""
    c1, c2 = step * v, 0.5 * step * step * x
    d = q_end - q - c1 - c2
    e = step * v_end - c1 - 2.0 * c2
    b = step * step * x_end - 2.0 * c2
    c3, c4, c5 = 10.0 * d - 4.0 * e + 0.5 * b, 7.0 * e - 15.0 * d - b, 6.0 * d - 3.0 * e + 0.5 * b
    f = 1.0
    for _ in range(4):
        value = q + f * (c1 + f * (c2 + f * (c3 + f * (c4 + f * c5))))
        slope = c1 + f * (2.0 * c2 + f * (3.0 * c3 + f * (4.0 * c4 + f * 5.0 * c5)))
        if slope * q_end <= 0.0:
            break
        f -= value / slope
    return f


@called
def closing(
    w: Table, slot: int, joint: int, state: State, second: Pair, end: State, second_end: Pair, record: Table, i: int,
    f: float, rest: float, h: float, linear: Any, general: Any,
) -> tuple[float, State, Pair, Pair, Pair, float]:  # fmt: skip
    """Share of the step until ``joint`` closes; state, q'', margins, demands and work there.

    It has closed by ``rest`` of the step. Newton within a bracket on the step itself, from the root of
    the interpolant; the last correction, under 1e-7 of the step, is applied to the state.
    """
    side = w[r.SIDE_1, slot] if joint == 0 else w[r.SIDE_2, slot]
    low, high = 0.0, rest
    share = rest * hermite_root(
        state[joint], state[joint + 2], second[joint], end[joint], end[joint + 2], second_end[joint], rest * h
    )
    if not low < share < high:
        share = 0.5 * rest
    while True:
        found, x, margins, demands, work = part(w, slot, state, second, record, i, f, share, h, linear, general)
        opening, v = margins[joint], side * found[joint + 2]
        if opening < 0.0:
            high = share
        else:
            low = share
        if v < 0.0 and abs(opening) <= -1e-7 * v * h:
            more = -opening / (v * h)
            t = more * h
            moved = (
                found[0] + t * found[2], found[1] + t * found[3], found[2] + t * x[0], found[3] + t * x[1],
            )  # fmt: skip
            return share + more, moved, x, margins, demands, work
        if high - low <= 1e-14:
            return share, found, x, margins, demands, work
        trial = share - opening / (v * h) if v < 0.0 else -1.0
        share = trial if low < trial < high else 0.5 * (low + high)


@called
def opening(
    w: Table, slot: int, joint: int, state: State, second: Pair, first: float, last: float, record: Table, i: int,
    f: float, rest: float, h: float, linear: Any, general: Any,
) -> tuple[float, State, Pair, Pair, Pair, float]:  # fmt: skip
    """Share of the step until the closed ``joint`` opens; state, q'', margins, demands and work there.

    ``first`` and ``last`` < 0 are its margins at the start and after ``rest`` of the step. False
    position (Illinois), to a moment `LATE` of the last: from there on it does open, and a late opening
    costs only the square of the delay.
    """
    late = -LATE * last
    low, high = 0.0, rest
    m_low, m_high = max(0.0, first) + late, last + late
    while True:
        trial = low + (high - low) * m_low / (m_low - m_high)
        share = trial if low < trial < high else 0.5 * (low + high)
        found, x, margins, demands, work = part(w, slot, state, second, record, i, f, share, h, linear, general)
        past = margins[joint] + late
        if abs(past) <= 0.1 * late or high - low <= 1e-14:
            return share, found, x, margins, demands, work
        if past < 0.0:
            high, m_high = share, past
            m_low *= 0.5
        else:
            low, m_low = share, past
            m_high *= 0.5
