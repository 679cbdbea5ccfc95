"""When the block at rest is lifted onto a corner, or slides."""

from __future__ import annotations

import math
from typing import Any

from models.housner.lanes import rows as r
from models.housner.lanes.impact import pivot
from models.housner.lanes.step import inputs
from models.housner.lanes.table import BASE, FRICTION, RATE, ROTATION, of_given
from models.lanes.arrays import Table
from models.lanes.chunks import CHUNK
from models.lanes.compiler import called, inlined

NONE = 2.0
"""A fraction of the step that never comes."""
ROUNDING = 1e-14
"""Share of the base's moment on the block at rest that is none: at the acceleration of onset itself the block rests."""
HALVINGS = 40
"""Of the step, to the onset under a law in a table over the base acceleration, which bends within the step."""


@inlined
def excess(
    given: Table, w: Table, lane: int, slot: int, side: float,
    a: float, g: float, psi: float, psi2: float, linear: Any,
) -> float:  # fmt: skip
    """Moment over M that lifts the block at rest onto ``side``: positive means it starts to rock."""
    h = given[lane, r.Q_HEIGHT]
    b = pivot(given, w, lane, slot, side)
    inertia = given[lane, r.Q_INERTIA] / given[lane, r.Q_MASS]
    push = -side * ((a - g * psi) * h + (inertia + h * h) * psi2)
    if given.shape[1] > r.N_GIVEN:
        law = of_given(given, r.N_GIVEN, ROTATION, lane, side * 1e-300)
        law += of_given(given, r.N_GIVEN, RATE, lane, side * 1e-300)
        law += of_given(given, r.N_GIVEN, FRICTION, lane, side * 1e-300) * side
        law += of_given(given, r.N_GIVEN, BASE, lane, a * given[lane, r.N_GIVEN + 2])
        push += side * law * (inertia + h * h + b * b)
    if w[r.JOINT, slot] >= 0.0:
        return float(push - w[r.COULOMB, slot])
    if linear is not None:
        return float(push - g * h * math.atan(b / h))
    return float(push - g * b - w[r.COULOMB, slot])


@called
def onset(
    given: Table, w: Table, lane: int, slot: int, record: Table, i: int, f: float, linear: Any
) -> tuple[float, float]:
    """First fraction >= f of step i at which the block leaves rest, and the side; (NONE, 0) if it stays."""
    a0, g0, p0, q0 = inputs(w, slot, record, i, f)
    a1, g1, p1, q1 = inputs(w, slot, record, i, 1.0)
    h = given[lane, r.Q_HEIGHT]
    first, which = NONE, 0.0
    for side in (1.0, -1.0):
        m0 = excess(given, w, lane, slot, side, a0, g0, p0, q0, linear)
        m1 = excess(given, w, lane, slot, side, a1, g1, p1, q1, linear)
        at = NONE
        if m0 > ROUNDING * abs(a0) * h:
            at = f
        elif m1 > ROUNDING * abs(a1) * h:
            at = f + (1.0 - f) * max(0.0, -m0) / (m1 - m0)
            if given.shape[1] > r.N_GIVEN:
                at = halved(given, w, lane, slot, side, record, i, f, linear)
        if at < first:
            first, which = at, side
    return first, which


@called
def halved(
    given: Table, w: Table, lane: int, slot: int, side: float, record: Table, i: int, f: float, linear: Any
) -> float:
    """Fraction of step i, above f, from which the moment that lifts the block is positive, as it is at the end."""
    low, high = f, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        a, g, psi, psi2 = inputs(w, slot, record, i, middle)
        if excess(given, w, lane, slot, side, a, g, psi, psi2, linear) > 0.0:
            high = middle
        else:
            low = middle
    return high


@called
def slip_onset(given: Table, w: Table, lane: int, slot: int, record: Table, i: int, f: float) -> tuple[float, float]:
    """First fraction >= f of step i at which |H| > mu N in full contact, and the direction of slip."""
    a0, g0, p0, q0 = inputs(w, slot, record, i, f)
    a1, g1, p1, q1 = inputs(w, slot, record, i, 1.0)
    h, mu = given[lane, r.Q_HEIGHT], given[lane, r.Q_FRICTION]
    first, which = NONE, 0.0
    for way in (1.0, -1.0):
        m0 = -way * (a0 - g0 * p0 + h * q0) - mu * g0
        m1 = -way * (a1 - g1 * p1 + h * q1) - mu * g1
        at = NONE
        if m0 > 0.0:
            at = f
        elif m1 > 0.0:
            at = f + (1.0 - f) * (-m0) / (m1 - m0)
        if at < first:
            first, which = at, way
    return first, which


@called
def next_onset(
    given: Table, w: Table, lane: int, slot: int, record: Table, i: int, last: int, chunk: Table, linear: Any
) -> int:
    """First step from i on in which the resting block is lifted or slides, ``last`` if there is none.

    ``chunk`` (4, n) holds the extremes of the record over `CHUNK` steps: |a|, -a_z, |psi|, |psi''|.
    """
    h = given[lane, r.Q_HEIGHT]
    b = min(pivot(given, w, lane, slot, 1.0), pivot(given, w, lane, slot, -1.0))
    if linear is not None:
        b = h * math.atan(b / h)
    if w[r.JOINT, slot] >= 0.0:
        b = 0.0
    mu = given[lane, r.Q_FRICTION]
    b = min(b, mu * h)
    inertia = given[lane, r.Q_INERTIA] / given[lane, r.Q_MASS] + h * h
    scale, pitch = abs(w[r.SCALE, slot]), abs(w[r.PITCH, slot])
    while i < last:
        if i % CHUNK == 0 and i + CHUNK <= last:
            c = i // CHUNK
            low = w[r.GRAVITY, slot] - abs(w[r.VSCALE, slot]) * chunk[1, c]
            high = w[r.GRAVITY, slot] + abs(w[r.VSCALE, slot]) * chunk[1, c]
            push = (scale * chunk[0, c] + abs(w[r.OFFSET, slot]) + high * pitch * chunk[2, c]) * h
            if push + inertia * pitch * chunk[3, c] < low * b:
                i += CHUNK
                continue
        f, _ = onset(given, w, lane, slot, record, i, 0.0, linear)
        if f < NONE:
            return i
        if mu < math.inf:
            f, _ = slip_onset(given, w, lane, slot, record, i, 0.0)
            if f < NONE:
                return i
        i += 1
    return last
