"""Displacement of the centres of many walls or of their blocks along their runs."""

from __future__ import annotations

from math import cos, sin

from models.base import FloatArray
from models.lanes.compiler import compiled, inlined
from models.lanes.elementary import sine_cosine

REACH = 1.75
"""rad, up to which `sine_cosine` holds: no wall goes further but one that has overturned."""


@inlined
def rolled(slip: float, edge: float, turn: float, cosine: float) -> float:
    """Slip of a joint, and what it moves on where a body that turns rolls over its ``edge``."""
    along = edge * (1.0 - cosine)
    return slip + (along if turn > 0.0 else -along if turn < 0.0 else 0.0)


@compiled
def centres(state: FloatArray, lanes: FloatArray, of_block: bool, found: FloatArray) -> None:
    """Fill ``found`` (n, m) with the displacement (m) of the block's centre, or of that of both halves of the wall.

    ``state``: q, q' of the plain wall (n, m, 8), or (n, m, 16) with those of the other coordinates. ``lanes`` (n, 6):
    half height of the wall, thickness of the top layer in the height, height and offset of the block's centre over its
    foot, half widths of the base and of the top joint where a body that turns rolls over its edge, else 0.
    """
    n, m, k = state.shape
    for lane in range(n):
        half, thick, above, beside, edge_b, edge_t = lanes[lane]
        q = state[lane]
        largest = 0.0
        for i in range(m):
            largest = max(largest, max(abs(q[i, 0]), abs(q[i, 1])))
            if k == 16:
                largest = max(largest, abs(q[i, 10]))
        for i in range(m):
            t1, t2, tm = q[i, 0], q[i, 1], q[i, 0]
            x1 = x2 = zm = 0.0
            if k == 16:
                x1, x2, tm, zm = q[i, 8], q[i, 9], q[i, 10], q[i, 11]
            if largest <= REACH:
                s1, c1 = sine_cosine(t1)
                sm, cm = sine_cosine(tm)
                s2, c2 = sine_cosine(t2)
            else:
                s1, c1, sm, cm, s2, c2 = sin(t1), cos(t1), sin(tm), cos(tm), sin(t2), cos(t2)
            foot = rolled(x1, edge_b, t1, c1)
            if of_block:
                along = rolled(x2, edge_t, t2 - tm, c2 * cm + s2 * sm)
                up = half + thick + zm + q[i, 3]
                found[lane, i] = foot + half * s1 + along * cm + up * sm + above * s2 + beside * c2
            else:
                found[lane, i] = foot + 0.75 * half * s1 + (0.25 * half + 0.5 * zm) * sm
