"""Where in a step something happens, one lane."""

from __future__ import annotations

from typing import Any

from models.lanes.compiler import called, inlined
from models.stacked.lanes.equation import contact, rk4
from models.stacked.lanes.rows import FREE_1, FREE_2, GRAVITY, OFFSET, P_LEFT, P_RIGHT, SCALE, SIDE_1, SIDE_2, VSCALE, W

Table = Any
State = tuple[float, float, float, float]
NONE = 2.0
"""A fraction of the step that never comes."""
LATE = 1e-6
"""Share of the moment at the end of the step by which an opening is located late."""


@inlined
def inputs(w: Table, slot: int, record: Table, i: int, f: float) -> tuple[float, float]:
    """a and G at the fraction f of step i."""
    # the record may jump to zero at its end: no part of its last sample acts in the step after it
    live = record[2, i]
    first, second = live * (1.0 - f), live * f
    a = first * record[0, i] + second * record[0, i + 1]
    v = first * record[1, i] + second * record[1, i + 1]
    return w[SCALE * W + slot] * a + w[OFFSET * W + slot], w[GRAVITY * W + slot] + w[VSCALE * W + slot] * v


@called
def onset(given: Table, w: Table, lane: int, slot: int, record: Table, i: int, f: float) -> float:
    """First fraction >= f of step i at which the stack leaves rest, NONE if it stays.

    It leaves where -a > G k to the right or a > G k to the left, k the least slenderness (tangent)
    of both as one body and of the upper block on that side.
    """
    a0, g0 = inputs(w, slot, record, i, f)
    a1, g1 = inputs(w, slot, record, i, 1.0)
    first = NONE
    for side in (1.0, -1.0):
        k = given[lane, P_RIGHT] if side > 0.0 else given[lane, P_LEFT]
        m0 = -side * a0 - g0 * k
        m1 = -side * a1 - g1 * k
        if m0 > 0.0:
            first = f
        elif m1 > 0.0:
            first = min(first, f + (1.0 - f) * (-m0) / (m1 - m0))
    return first


@called
def next_onset(
    given: Table, w: Table, lane: int, slot: int, record: Table, i: int, last: int, chunk: Table
) -> int:
    """First step from i on in which the resting stack is lifted, ``last`` if there is none.

    ``chunk`` (2, n) holds the extremes of the record over 64 steps: |a|, |a_z|.
    """
    k = min(given[lane, P_RIGHT], given[lane, P_LEFT])
    scale, lift = abs(w[SCALE * W + slot]), abs(w[VSCALE * W + slot])
    while i < last:
        if i % 64 == 0 and i + 64 <= last:
            c = i // 64
            push = scale * chunk[0, c] + abs(w[OFFSET * W + slot])
            if push < (w[GRAVITY * W + slot] - lift * chunk[1, c]) * k:
                i += 64
                continue
        if onset(given, w, lane, slot, record, i, 0.0) < NONE:
            return i
        i += 1
    return last


@called
def look(
    w: Table, slot: int, state: State, record: Table, i: int, f: float, linear: Any
) -> tuple[float, float, float, float, float, float]:  # fmt: skip
    """`contact` of a state at fraction f of step i."""
    a, g = inputs(w, slot, record, i, f)
    return contact(w, slot, state[0], state[1], state[2], state[3], a, g, linear)


@called
def part(
    w: Table, slot: int, state: State, second: tuple[float, float], record: Table, i: int, f: float, share: float,
    h: float, linear: Any,
) -> tuple[State, float, float, float]:  # fmt: skip
    """State, margins of both joints and work after ``share`` of step i from its fraction f."""
    a0, g0 = inputs(w, slot, record, i, f)
    a1, g1 = inputs(w, slot, record, i, f + share)
    q1, q2, v1, v2, work = rk4(
        w, slot, state[0], state[1], state[2], state[3], second[0], second[1], share * h, a0, a1, g0, g1, linear
    )
    end = (q1, q2, v1, v2)
    _, _, m1, m2, _, _ = look(w, slot, end, record, i, f + share, linear)
    return end, m1, m2, work


@inlined
def hermite_root(q: float, v: float, q_end: float, v_end: float, step: float) -> float:
    """Fraction of the step at which the cubic through both ends passes zero (q_end beyond it)."""
    c = 3.0 * (q_end - q) - step * (2.0 * v + v_end)
    d = 2.0 * (q - q_end) + step * (v + v_end)
    f = 1.0
    for _ in range(4):
        value = q + f * (step * v + f * (c + f * d))
        slope = step * v + f * (2.0 * c + 3.0 * d * f)
        if slope * q_end <= 0.0:
            break
        f -= value / slope
    return f


@inlined
def pick(joint: int, pair: tuple[float, float]) -> float:
    return pair[0] if joint == 0 else pair[1]


@called
def locate(
    w: Table, slot: int, joint: int, state: State, second: tuple[float, float], end: State, margin: float,
    record: Table, i: int, f: float, rest: float, h: float, linear: Any,
) -> tuple[float, State, float, float]:  # fmt: skip
    """Share of the step until ``joint`` closes or opens; state, margin of the other joint and work there.

    ``margin`` < 0 is that after ``rest`` of the step. Newton within a bracket on the step itself for a
    joint that closes; its last correction, under 1e-7 of the step, is applied to the state. False
    position (Illinois) for one that opens, to a moment `LATE` of the last: from there on it does open,
    and a late opening costs only the square of the delay.
    """
    closing = (w[FREE_1 * W + slot] if joint == 0 else w[FREE_2 * W + slot]) > 0.0
    side = w[SIDE_1 * W + slot] if joint == 0 else w[SIDE_2 * W + slot]
    low, high, late = 0.0, rest, 0.0
    low_margin, high_margin = 0.0, margin
    if closing:
        share = rest * hermite_root(
            pick(joint, (state[0], state[1])), pick(joint, (state[2], state[3])),
            pick(joint, (end[0], end[1])), pick(joint, (end[2], end[3])), rest * h,
        )  # fmt: skip
    else:
        _, _, m1, m2, _, _ = look(w, slot, state, record, i, f, linear)
        late = -LATE * margin
        low_margin = max(0.0, pick(joint, (m1, m2)))
        high_margin = margin + late
        share = rest * low_margin / (low_margin - margin)
    if not low < share < high:
        share = 0.5 * rest
    found, other, work = state, 0.0, 0.0
    for _ in range(60):
        found, m1, m2, work = part(w, slot, state, second, record, i, f, share, h, linear)
        now, other = pick(joint, (m1, m2)), pick(joint, (m2, m1))
        if closing:
            v = side * pick(joint, (found[2], found[3]))
            if now < 0.0:
                high = share
            else:
                low = share
            if v < 0.0 and abs(now) <= -1e-7 * v * h:
                more = -now / (v * h)
                k = more / share
                found = (
                    found[0] + more * h * found[2],
                    found[1] + more * h * found[3],
                    found[2] + (found[2] - state[2]) * k,
                    found[3] + (found[3] - state[3]) * k,
                )
                return share + more, found, other, work
            trial = share - now / (v * h) if v < 0.0 else -1.0
        else:
            past = now + late
            if abs(past) <= 0.1 * late:
                break
            if past < 0.0:
                high, high_margin = share, past
                low_margin *= 0.5
            else:
                low, low_margin = share, past
                high_margin *= 0.5
            trial = low + (high - low) * low_margin / (low_margin - high_margin)
        if high - low <= 1e-14:
            break
        share = trial if low < trial < high else 0.5 * (low + high)
    return share, found, other, work
