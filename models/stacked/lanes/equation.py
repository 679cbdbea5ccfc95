"""The equations of `models.stacked.equation` and one Runge-Kutta step; inlined into the loop over lanes.

All configurations share one branch-free form: a closed joint has FREE = 0, which takes its row and
column out of M q'' = F. ``linear`` is None or True: a compiled variant holds only the branch in use.
"""

from __future__ import annotations

from typing import Any

from models.lanes.arrays import Table
from models.lanes.compiler import inlined
from models.lanes.elementary import sine_cosine
from models.stacked.lanes import rows as r

BOUNDLESS = 1e300


@inlined
def turned(w: Table, lane: int, q1: float, q2: float, linear: Any) -> tuple[float, ...]:
    """K, B and C (weighted as in `rows`) at rotations q1 and q1 + q2, and the sine and cosine of the latter."""
    kx, kz = w[r.KX, lane], w[r.KZ, lane]
    bx, bz = w[r.BX, lane], w[r.BZ, lane]
    cx, cz = w[r.CX, lane], w[r.CZ, lane]
    if linear is not None:
        t2 = q1 + q2
        return kx + kz * q1, kz, bx + bz * q1, bz, cx + cz * t2, cz, t2, 1.0
    s1, c1 = sine_cosine(q1)
    s2, c2 = sine_cosine(q1 + q2)
    return (
        kx * c1 + kz * s1,
        kz * c1 - kx * s1,
        bx * c1 + bz * s1,
        bz * c1 - bx * s1,
        cx * c2 + cz * s2,
        cz * c2 - cx * s2,
        s2,
        c2,
    )


@inlined
def forces(
    w: Table, lane: int, v1: float, v2: float, a: float, g: float, turning: Any, place: tuple[float, ...], linear: Any
) -> tuple[float, float, float, float, float]:
    """M11, M12, M22 and F1, F2, over the total mass."""
    kx, kz, bx, bz, cx, cz, _, _ = place
    j2 = w[r.J2, lane]
    f2 = g * cx - a * cz
    f1 = g * kx - a * kz + f2 - w[r.DRAG, lane] * v1
    if turning is not None:
        f1 -= w[r.FRAME_1, lane] * turning
        f1 -= w[r.OPPOSING, lane]
        f2 -= w[r.FRAME_2, lane] * turning
    if linear is not None:
        dot = w[r.BX, lane] * w[r.CX, lane] + w[r.BZ, lane] * w[r.CZ, lane]
    else:
        dot = bx * cx + bz * cz
        cross = bz * cx - bx * cz
        f1 += cross * v2 * (v1 + v1 + v2)
        f2 -= cross * v1 * v1
    m12 = j2 + dot
    return w[r.J1, lane] + m12 + dot, m12, j2, f1, f2


@inlined
def solve(w: Table, lane: int, m11: float, m12: float, m22: float, f1: float, f2: float) -> tuple[float, float]:
    """q'' of the joints that are up, 0 of the closed ones."""
    free_1, free_2 = w[r.FREE_1, lane], w[r.FREE_2, lane]
    mixed = free_1 * free_2 * m12
    scale = 1.0 / (m11 * m22 - mixed * mixed)
    return free_1 * scale * (m22 * f1 - mixed * f2), free_2 * scale * (m11 * f2 - mixed * f1)


@inlined
def acceleration(
    w: Table, lane: int, q1: float, q2: float, v1: float, v2: float, a: float, g: float, turning: Any, linear: Any
) -> tuple[float, float]:
    place = turned(w, lane, q1, q2, linear)
    m11, m12, m22, f1, f2 = forces(w, lane, v1, v2, a, g, turning, place, linear)
    return solve(w, lane, m11, m12, m22, f1, f2)


@inlined
def contact(
    w: Table, lane: int, q1: float, q2: float, v1: float, v2: float, a: float, g: float, turning: Any, linear: Any
) -> tuple[float, float, float, float, float, float]:
    """q'' (2), margins (2) and friction demands (2) of the joints in a state.

    The margin of a joint that is up is its opening s q; of a closed one the smaller of the moments
    that hold it on its corners: with R its residual about the right corner and N the force across the
    joint (both over M), -R on the right and R + 2 b N on the left; dry friction helps at the base. Of a wall that it
    holds, what it has to spare.
    """
    place = turned(w, lane, q1, q2, linear)
    kx, kz, bx, bz, cx, cz, sine, cosine = place
    m11, m12, m22, f1, f2 = forces(w, lane, v1, v2, a, g, turning, place, linear)
    x1, x2 = solve(w, lane, m11, m12, m22, f1, f2)
    share = w[r.SHARE, lane]
    w1, w2, t2 = v1 * v1, (v1 + v2) * (v1 + v2), x1 + x2
    top_h = share * (a + x1 * bz - w1 * bx) + t2 * cz - w2 * cx
    top_n = share * (g - x1 * bx - w1 * bz) - t2 * cx - w2 * cz
    base_h = a + x1 * kz - w1 * kx + t2 * cz - w2 * cx
    base_n = g - x1 * kx - w1 * kz - t2 * cx - w2 * cz
    # a closed joint leaves a moment about its right corner, and from it the one about its left corner
    r1 = f1 - m11 * x1 - m12 * x2
    r2 = f2 - m12 * x1 - m22 * x2
    if linear is not None:
        # the linear equations hold the block at its upright inertia, and so its lever arms
        across = share * g - x1 * w[r.BX, lane] * share - t2 * w[r.CX, lane]
        below = g - x1 * w[r.KX, lane] - t2 * w[r.CX, lane]
    else:
        across = cosine * top_n + sine * top_h
        below = base_n
    if turning is not None:
        # the couples of the turning frame are the same about either corner: across the joint none of it
        top_h += w[r.LEVER_2, lane] * turning
        base_h += w[r.LEVER_1, lane] * turning
    closed_1 = min(-r1, r1 + w[r.WIDE_1, lane] * below)
    closed_2 = min(-r2, r2 + w[r.WIDE_2, lane] * across)
    if turning is not None:
        closed_1 += w[r.COULOMB, lane]
    margin_1 = w[r.SIDE_1, lane] * q1 if w[r.FREE_1, lane] > 0.0 else closed_1
    margin_2 = w[r.SIDE_2, lane] * q2 if w[r.FREE_2, lane] > 0.0 else closed_2
    base = abs(base_h) / base_n
    top = abs(top_h) / top_n
    return (
        x1,
        x2,
        margin_1,
        margin_2,
        base if base_n > 0.0 else BOUNDLESS,
        top if top_n > 0.0 else BOUNDLESS,
    )


@inlined
def rk4(
    w: Table, lane: int, q1: float, q2: float, v1: float, v2: float, x1: float, x2: float, step: float,
    a0: float, a1: float, g0: float, g1: float, pitch: Any, linear: Any,
) -> tuple[float, float, float, float, float]:  # fmt: skip
    """theta_1, r and their rates after ``step``, and the work of the couples over M.

    ``x1``, ``x2`` is q'' at the start; the base's own acceleration a, G and ``pitch`` (psi at both ends, psi'' at
    both; None: the variant is not general) are linear over the step.
    """
    half = 0.5 * step
    am, gm = 0.5 * (a0 + a1), 0.5 * (g0 + g1)
    turning, turning1 = None, None
    if pitch is not None:
        psi0, psi1, turning0, turning1 = pitch
        turning = 0.5 * (turning0 + turning1)
        am -= gm * (0.5 * (psi0 + psi1))
        a1 -= g1 * psi1
    p2, r2 = v1 + half * x1, v2 + half * x2
    y1, y2 = acceleration(w, lane, q1 + half * v1, q2 + half * v2, p2, r2, am, gm, turning, linear)
    p3, r3 = v1 + half * y1, v2 + half * y2
    z1, z2 = acceleration(w, lane, q1 + half * p2, q2 + half * r2, p3, r3, am, gm, turning, linear)
    p4, r4 = v1 + step * z1, v2 + step * z2
    u1, u2 = acceleration(w, lane, q1 + step * p3, q2 + step * r3, p4, r4, a1, g1, turning1, linear)
    sixth = step / 6.0
    work = sixth * w[r.DRAG, lane] * (v1 * v1 + 2.0 * (p2 * p2 + p3 * p3) + p4 * p4)
    turned = sixth * (v1 + 2.0 * (p2 + p3) + p4)
    if pitch is not None:
        work += w[r.OPPOSING, lane] * turned
    return (
        q1 + turned,
        q2 + sixth * (v2 + 2.0 * (r2 + r3) + r4),
        v1 + sixth * (x1 + 2.0 * (y1 + z1) + u1),
        v2 + sixth * (x2 + 2.0 * (y2 + z2) + u2),
        work,
    )
