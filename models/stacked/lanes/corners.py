"""M x = R of one lane for the four pairs of pivots: forces in motion, impulses at an impact.

``system`` (4, 5) holds M11, M12, M22, R1, R2 in the line 2 (s1 < 0) + (s2 < 0); the formulas are
those of `models.stacked.equation` and `models.stacked.reference.impact`.
"""

from __future__ import annotations

from typing import Any

from models.lanes.arrays import Table
from models.lanes.compiler import called, inlined
from models.lanes.elementary import sine_cosine
from models.stacked.lanes import rows as r


@inlined
def line(s1: float, s2: float) -> int:
    """Where a pair of pivots stands in a table of systems."""
    return (2 if s1 < 0.0 else 0) + (1 if s2 < 0.0 else 0)


@inlined
def corner_inertia(given: Table, lane: int, side: float) -> float:
    """I_O of both as one body about a pivot of the base."""
    u1, u2 = side * given[lane, r.P_B1] - given[lane, r.P_D1], side * given[lane, r.P_B1] - given[lane, r.P_D2]
    tall = given[lane, r.P_TALL] + given[lane, r.P_H2]
    own = given[lane, r.P_I1] + given[lane, r.P_M1] * (given[lane, r.P_H1] ** 2 + u1 * u1)
    return float(own + given[lane, r.P_I2] + given[lane, r.P_M2] * (tall * tall + u2 * u2))


@inlined
def vectors(
    given: Table, lane: int, s1: float, s2: float, sc: tuple[float, float, float, float], lift: float
) -> tuple[float, float, float, float, float, float]:
    """A, C, D (x and z each) for the sines and cosines of theta_1 and theta_2."""
    sine_1, cosine_1, sine_2, cosine_2 = sc
    left = given[lane, r.P_D1] - s1 * given[lane, r.P_B1]
    joint = left + s2 * given[lane, r.P_B2] - given[lane, r.P_D1]
    right = given[lane, r.P_D2] - s2 * given[lane, r.P_B2]
    h1, tall, h2 = given[lane, r.P_H1], given[lane, r.P_TALL], given[lane, r.P_H2]
    cx = right * cosine_2 + h2 * sine_2
    cz = h2 * cosine_2 - lift * right * sine_2
    return (
        left * cosine_1 + h1 * sine_1,
        h1 * cosine_1 - lift * left * sine_1,
        cx,
        cz,
        joint * cosine_1 + tall * sine_1 + cx,
        tall * cosine_1 - lift * joint * sine_1 + cz,
    )


@inlined
def products(given: Table, lane: int, p: tuple[float, ...], o: tuple[float, ...]) -> tuple[float, float, float, float]:
    """C11, C12, C21, C22 of the motions with vectors ``p`` (after) and ``o`` (before)."""
    m1, m2, i2 = given[lane, r.P_M1], given[lane, r.P_M2], given[lane, r.P_I2]
    return (
        given[lane, r.P_I1] + m1 * (p[0] * o[0] + p[1] * o[1]) + i2 + m2 * (p[4] * o[4] + p[5] * o[5]),
        i2 + m2 * (p[4] * o[2] + p[5] * o[3]),
        i2 + m2 * (p[2] * o[4] + p[3] * o[5]),
        i2 + m2 * (p[2] * o[2] + p[3] * o[3]),
    )


@inlined
def turns(q1: float, q2: float, linear: Any) -> tuple[float, float, float, float]:
    """Sines and cosines of theta_1 and theta_2."""
    if linear is not None:
        return q1, 1.0, q1 + q2, 1.0
    sine_1, cosine_1 = sine_cosine(q1)
    sine_2, cosine_2 = sine_cosine(q1 + q2)
    return sine_1, cosine_1, sine_2, cosine_2


UPRIGHT = (0.0, 1.0, 0.0, 1.0)


@called
def motion(
    system: Table, given: Table, lane: int, up: float, q1: float, q2: float, v1: float, v2: float, a: float, g: float,
    turning: Any, linear: Any,
) -> None:  # fmt: skip
    """M and F for each pair of pivots, the wall at rest just about to turn about the base's.

    With friction a wall that is ``up`` on a corner (0: the base is closed) keeps it: the pair's first sign is then that
    of the way it turns.
    """
    sc = turns(q1, q2, linear)
    lift = 1.0 if linear is None else 0.0
    m1, m2 = given[lane, r.P_M1], given[lane, r.P_M2]
    for way in (1.0, -1.0):
        s1 = way
        if turning is not None:
            s1 = up if up != 0.0 else way
        drag = given[lane, r.P_VISCOUS] * corner_inertia(given, lane, s1) * v1
        if turning is not None:
            drag += given[lane, r.P_COULOMB] * (way if v1 == 0.0 else 1.0 if v1 > 0.0 else -1.0)
        for s2 in (1.0, -1.0):
            k = line(way, s2)
            v = vectors(given, lane, s1, s2, sc, lift)
            f1 = g * (m1 * v[0] + m2 * v[4]) - a * (m1 * v[1] + m2 * v[5]) - drag
            f2 = m2 * (g * v[2] - a * v[3])
            if turning is not None:
                f1 -= given[lane, r.P_FRAME_1] * turning
                f2 -= given[lane, r.P_FRAME_2] * turning
            still = v
            if linear is None:
                cross = m2 * (v[5] * v[2] - v[4] * v[3])
                f1 += cross * v2 * (v1 + v1 + v2)
                f2 -= cross * v1 * v1
            else:
                still = vectors(given, lane, s1, s2, UPRIGHT, lift)
            m11, m12, _, m22 = products(given, lane, still, still)
            system[k, 0], system[k, 1], system[k, 2] = m11, m12, m22
            system[k, 3], system[k, 4] = f1, f2


@inlined
def kinetic_energy(
    given: Table, lane: int, s1: float, s2: float, q1: float, q2: float, v1: float, v2: float, linear: Any
) -> float:  # fmt: skip
    """In J, about the pivots s1, s2 (1 or -1)."""
    v = vectors(given, lane, s1, s2, turns(q1, q2, linear) if linear is None else UPRIGHT, 1.0)
    m11, m12, _, m22 = products(given, lane, v, v)
    return 0.5 * (m11 * v1 * v1 + m22 * v2 * v2) + m12 * v1 * v2


@called
def impulses(
    system: Table, given: Table, lane: int, s1: float, s2: float, q1: float, q2: float, v1: float, v2: float,
    linear: Any,
) -> float:  # fmt: skip
    """M and C q' for each pair of pivots held afterwards; returns the kinetic energy before, in J."""
    sc = turns(q1, q2, linear) if linear is None else UPRIGHT
    before = vectors(given, lane, s1, s2, sc, 1.0)
    for c1 in (1.0, -1.0):
        for c2 in (1.0, -1.0):
            k = line(c1, c2)
            after = vectors(given, lane, c1, c2, sc, 1.0)
            m11, m12, _, m22 = products(given, lane, after, after)
            c11, c12, c21, c22 = products(given, lane, after, before)
            system[k, 0], system[k, 1], system[k, 2] = m11, m12, m22
            system[k, 3], system[k, 4] = c11 * v1 + c12 * v2, c21 * v1 + c22 * v2
    k = line(s1, s2)
    return float(0.5 * (v1 * system[k, 3] + v2 * system[k, 4]))
