"""The account of a lane: configurations, events, peaks."""

from __future__ import annotations

import math

from models.lanes.arrays import Table
from models.lanes.compiler import called
from models.lanes.events import turning_point
from models.stacked import account as acc
from models.stacked.configuration import CONFIGURATIONS
from models.stacked.lanes import rows as r
from models.stacked.lanes.corners import UPRIGHT, corner_inertia, vectors

State = tuple[float, float, float, float]
INDEX = tuple(CONFIGURATIONS.index((s1, s2)) for s1 in (-1, 0, 1) for s2 in (-1, 0, 1))


@called
def stand(given: Table, w: Table, lane: int, slot: int, s1: float, s2: float) -> None:
    """Set the coefficients of a configuration; a closed joint (0) is written about its right corner."""
    c1 = s1 if s1 != 0.0 else 1.0
    c2 = s2 if s2 != 0.0 else 1.0
    m1, m2 = given[lane, r.P_M1], given[lane, r.P_M2]
    mass = m1 + m2
    ax, az, cx, cz, dx, dz = vectors(given, lane, c1, c2, UPRIGHT, 1.0)
    bx, bz = dx - cx, dz - cz
    w[r.SIDE_1, slot], w[r.SIDE_2, slot] = c1, c2
    w[r.FREE_1, slot] = 1.0 if s1 != 0.0 else 0.0
    w[r.FREE_2, slot] = 1.0 if s2 != 0.0 else 0.0
    w[r.SHARE, slot] = m2 / mass
    w[r.KX, slot] = (m1 * ax + m2 * bx) / mass
    w[r.KZ, slot] = (m1 * az + m2 * bz) / mass
    w[r.BX, slot], w[r.BZ, slot] = bx, bz
    w[r.CX, slot], w[r.CZ, slot] = m2 * cx / mass, m2 * cz / mass
    w[r.J1, slot] = (given[lane, r.P_I1] + m1 * (ax * ax + az * az) + m2 * (bx * bx + bz * bz)) / mass
    w[r.J2, slot] = (given[lane, r.P_I2] + m2 * (cx * cx + cz * cz)) / mass
    w[r.DRAG, slot] = given[lane, r.P_VISCOUS] * corner_inertia(given, lane, c1) / mass
    w[r.WIDE_1, slot], w[r.WIDE_2, slot] = 2.0 * given[lane, r.P_B1], 2.0 * given[lane, r.P_B2]


@called
def add_time(result: Table, lane: int, time: float) -> None:
    """Book the time since the last change to the present configuration."""
    k = INDEX[int(3.0 * (result[lane, r.R_SIDE_1] + 1.0) + result[lane, r.R_SIDE_2] + 1.0)]
    result[lane, acc.TIME_IN + k] += time - result[lane, r.R_SINCE]
    result[lane, r.R_SINCE] = time


@called
def mark_configuration(result: Table, lane: int) -> None:
    """Mark the present configuration."""
    k = INDEX[int(3.0 * (result[lane, r.R_SIDE_1] + 1.0) + result[lane, r.R_SIDE_2] + 1.0)]
    result[lane, acc.VISITED] = float(int(result[lane, acc.VISITED]) | (1 << k))


@called
def configure(given: Table, result: Table, w: Table, lane: int, slot: int, s1: float, s2: float, time: float) -> None:
    """The lane goes over to the configuration (s1, s2) at ``time``."""
    if s1 == result[lane, r.R_SIDE_1] and s2 == result[lane, r.R_SIDE_2]:
        return
    add_time(result, lane, time)
    if s1 != 0.0 and result[lane, r.R_SIDE_1] == 0.0 and math.isnan(result[lane, acc.ONSET_BASE]):
        result[lane, acc.ONSET_BASE] = time
    if s2 != 0.0 and result[lane, r.R_SIDE_2] == 0.0 and math.isnan(result[lane, acc.ONSET_TOP]):
        result[lane, acc.ONSET_TOP] = time
    result[lane, r.R_SIDE_1], result[lane, r.R_SIDE_2] = s1, s2
    result[lane, r.R_CLOSED] = 1.0 if s1 == 0.0 and s2 == 0.0 else 0.0
    stand(given, w, lane, slot, s1, s2)
    mark_configuration(result, lane)


@called
def raise_peaks(result: Table, lane: int, start: State, end: State, step: float) -> None:
    """Keep the largest rotations of both bodies over a part of a step without events."""
    t0, t1, u0, u1 = start[0] + start[1], end[0] + end[1], start[2] + start[3], end[2] + end[3]
    peak_1, peak_2 = abs(end[0]), abs(t1)
    if start[2] * end[2] < 0.0:
        peak_1 = max(peak_1, turning_point(start[0], start[2], end[0], end[2], step))
    if u0 * u1 < 0.0:
        peak_2 = max(peak_2, turning_point(t0, u0, t1, u1, step))
    result[lane, acc.PEAK_1] = max(result[lane, acc.PEAK_1], peak_1)
    result[lane, acc.PEAK_2] = max(result[lane, acc.PEAK_2], peak_2)
