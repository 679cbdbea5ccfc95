"""A joint closes, one lane: the impact, what may stay closed after it, and the energy lost."""

from __future__ import annotations

from typing import Any

from models.lanes.arrays import Counts, Table
from models.lanes.compiler import called
from models.lanes.events import note
from models.stacked import account as acc
from models.stacked.lanes import rows as r
from models.stacked.lanes.bookkeeping import configure
from models.stacked.lanes.corners import impulses, kinetic_energy
from models.stacked.lanes.friction import respond, rub, stopped
from models.stacked.lanes.impact import imposed, land


@called
def close(
    given: Table, result: Table, w: Table, system: Table, lane: int, slot: int, joint: int, q1: float, q2: float,
    v1: float, v2: float, a: float, g: float, turning: Any, time: float, log: Table, count: Counts, linear: Any,
) -> tuple[float, float]:  # fmt: skip
    """The impact of ``joint`` at ``time``; sets the configuration, returns the rates after it.

    Rates so small that the swing ahead does not matter end, if the forces of now keep the joint closed and, where the
    wall is up, friction holds it.
    """
    s1, s2 = result[lane, r.R_SIDE_1], result[lane, r.R_SIDE_2]
    c1 = s1 if s1 != 0.0 else 1.0
    c2 = s2 if s2 != 0.0 else 1.0
    energy = impulses(system, given, lane, c1, c2, q1, q2, v1, v2, linear)
    landing = land(system, given, lane, joint, s1, s2, v1, v2, energy)
    calm_1 = abs(landing[2]) < given[lane, r.P_CALM_1]
    calm_2 = abs(landing[3]) < given[lane, r.P_CALM_2]
    up, calm = (landing[0], calm_1) if joint == 0 else (landing[1], calm_2)
    after = landing
    rests = False
    if calm_1 and calm_2 and q1 == 0.0 and q2 == 0.0:
        n1, n2, _ = respond(
            given, w, system, lane, slot, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, a, g, turning, False, linear
        )  # fmt: skip
        rests = n1 == 0.0 and n2 == 0.0
        if rests:
            after = (0.0, 0.0, 0.0, 0.0)
    if turning is not None:
        if joint == 1 and calm_1 and calm_2 and stopped(w, slot, s1, 0.0):
            _, n2, way = respond(
                given, w, system, lane, slot, s1, 0.0, q1, q2, 0.0, 0.0, a, g, turning, False, linear
            )  # fmt: skip
            rests = n2 == 0.0 and way == 0.0
            if rests:
                after = (s1, 0.0, 0.0, 0.0)
    if not rests and calm and up != 0.0:
        impulses(system, given, lane, c1, c2, q1, q2, v1, v2, linear)
        trial = imposed(system, joint, 0.0, s2 if joint == 0 else s1, energy)
        n1, n2, _ = respond(
            given, w, system, lane, slot, trial[0], trial[1], q1, q2, trial[2], trial[3], a, g, turning, False, linear
        )  # fmt: skip
        if (n1 if joint == 0 else n2) == 0.0:
            after = trial
    n1, n2, way = respond(
        given, w, system, lane, slot, after[0], after[1], q1, q2, after[2], after[3], a, g, turning, False, linear
    )  # fmt: skip
    k1 = n1 if n1 != 0.0 else 1.0
    k2 = n2 if n2 != 0.0 else 1.0
    lost = energy - kinetic_energy(given, lane, k1, k2, q1, q2, after[2], after[3], linear)
    if joint == 0:
        result[lane, acc.IMPACTS_BASE] += 1.0
        result[lane, acc.LOST_BASE] += lost
    else:
        result[lane, acc.IMPACTS_TOP] += 1.0
        result[lane, acc.LOST_TOP] += lost
    note(log, count, lane, time, r.LOG_IMPACT, joint + 1.0)
    configure(given, result, w, lane, slot, n1, n2, time)
    if turning is not None:
        rub(given, w, lane, slot, n1, way)
    if n1 == 0.0 and n2 == 0.0:
        note(log, count, lane, time, r.LOG_REST, 1.0)
    return after[2], after[3]
