"""Where the layers landed along the joints, for all lanes; see `models.interface.landing`."""

from __future__ import annotations

from models.interface.effects import CELLS
from models.interface.lanes import rows as r
from models.interface.lanes.effects import rows as e
from models.interface.lanes.rows import W
from models.interface.lanes.strip import TINY
from models.lanes.arrays import Table
from models.lanes.compiler import called, inlined
from models.lanes.elementary import sine_cosine


@inlined
def touching(z: float, s: float, b: float) -> tuple[float, float]:
    """Ends of what touches at z, S."""
    front = min(max(z / (abs(s) + TINY), -b), b)
    return front if s >= 0.0 else -b, b if s >= 0.0 else -front


@inlined
def overlap(low: float, high: float, first: float, last: float) -> float:
    return max(min(high, last) - max(low, first), 0.0)


@called
def touch(t: Table, slot: int) -> None:
    """What touches in the state in which a lane begins; ``tm`` of the upper half is known."""
    base, top = sine_cosine(t[r.T1 * W + slot])[0], sine_cosine(t[r.T2 * W + slot] - t[e.TM + slot])[0]
    for which in range(2):
        j = which * W + slot
        ends = touching(t[r.Z1 * W + j], base if which == 0 else top, t[r.B1 * W + j])
        t[e.FROM_B + j], t[e.TO_B + j] = ends


@called
def land(t: Table) -> None:
    """Slips at landing at the predictor, and their integral over what presses."""
    lanes = min(W, t.size)
    for which in range(2):
        for i in range(lanes):
            j = which * W + i
            b, s = t[r.B1 * W + j], t[e.S1 + 4 * which * W + i]
            length = t[e.LENGTH_B + j]
            ends = touching(t[e.Q + 2 * W + j], s, b)
            t[e.NEXT_FROM_B + j], t[e.NEXT_TO_B + j] = ends
            t[e.LOW_B + j], t[e.HIGH_B + j] = (b - length if s >= 0.0 else -b), (b if s >= 0.0 else length - b)
            t[e.SHIFT_B + j] = 0.0
        for f in range(CELLS):
            for i in range(lanes):
                j = which * W + i
                cell, slip = e.LANDED + (which * CELLS + f) * W + i, t[e.Q + 4 * W + j]
                first = t[r.B1 * W + j] * (2.0 * f / CELLS - 1.0)
                last = first + t[r.B1 * W + j] * (2.0 / CELLS)
                was = overlap(t[e.FROM_B + j], t[e.TO_B + j], first, last)
                now = overlap(t[e.NEXT_FROM_B + j], t[e.NEXT_TO_B + j], first, last)
                more = max(now - was, 0.0)
                landed = (t[cell] * was + slip * more) / (was + more + TINY)
                landed = landed if now > 0.0 else slip
                t[cell] = landed
                t[e.SHIFT_B + j] += landed * overlap(t[e.LOW_B + j], t[e.HIGH_B + j], first, last)
        for i in range(lanes):
            j = which * W + i
            t[e.FROM_B + j], t[e.TO_B + j] = t[e.NEXT_FROM_B + j], t[e.NEXT_TO_B + j]
