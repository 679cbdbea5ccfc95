"""What happens inside a step of a lane: its entry in the log, and turning points."""

from __future__ import annotations

from models.lanes.arrays import Counts, Table
from models.lanes.compiler import inlined


@inlined
def note(log: Table, count: Counts, lane: int, time: float, kind: float, body: float) -> None:
    """Write an event at ``time`` (s) in the log (n, most, 3) of a lane, as long as there is room; count it anyway."""
    if log.shape[1] > 0:
        if count[lane] < log.shape[1]:
            log[lane, count[lane], 0] = time
            log[lane, count[lane], 1] = kind
            log[lane, count[lane], 2] = body
        count[lane] += 1


@inlined
def turning_point(q: float, v: float, q_end: float, v_end: float, step: float) -> float:
    """|q| (rad) where the cubic through both ends of the step (s) turns: two Newton steps from the secant."""
    c = 3.0 * (q_end - q) - step * (2.0 * v + v_end)
    d = 2.0 * (q - q_end) + step * (v + v_end)
    f = v / (v - v_end)
    for _ in range(2):
        curve = 2.0 * c + 6.0 * d * f
        if curve != 0.0:
            f -= (step * v + f * (2.0 * c + 3.0 * d * f)) / curve
    f = min(1.0, max(0.0, f))
    return abs(q + f * (step * v + f * (c + f * d)))
