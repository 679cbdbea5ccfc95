"""Right hand side, matrix and solution of the step's equations for all lanes: L D L^T in blocks of four."""

from __future__ import annotations

from models.interface.lanes import rows as r
from models.interface.lanes.effects import rows as e
from models.interface.lanes.effects.rows import More
from models.interface.lanes.rows import W
from models.interface.lanes.step import AM
from models.lanes.arrays import Table
from models.lanes.compiler import called, inlined

Four = tuple[float, float, float, float]
Lower = tuple[float, float, float, float, float, float, float, float, float, float]
"""Entries on and below the diagonal of four rows, row by row."""


@inlined
def at(row: int, column: int) -> int:
    """Place of an entry of the matrix."""
    return e.MATRIX + (e.SIZE * row + column) * W


@called
def inertia(t: Table) -> None:
    """Forces of inertia with q'' = o, and (1 - am) M below its diagonal."""
    lanes = min(W, t.size)
    share = 1.0 - AM
    for i in range(lanes):
        half, turning, m2, i2 = t[e.HALF_MASS + i], t[e.HALF_INERTIA + i], t[r.M2 * W + i], t[r.I2 * W + i]
        free_b, free_t, free_m = t[r.FREE_B * W + i], t[r.FREE_T * W + i], t[e.FREE_M + i]
        slip, stiff = t[e.FREE_X1 + i], (1.0 - free_m) * free_b
        xl1, zl1, xu1, zu1, xb1, zb1 = (
            t[e.XL_1 + i], t[e.ZL_1 + i], t[e.XU_1 + i], t[e.ZU_1 + i], t[e.XB_1 + i], t[e.ZB_1 + i],
        )  # fmt: skip
        xum, zum, xbm, zbm, xb2, zb2 = (
            t[e.XU_M + i], t[e.ZU_M + i], t[e.XB_M + i], t[e.ZB_M + i], t[e.XB_2 + i], t[e.ZB_2 + i],
        )  # fmt: skip
        xz2, zz2, xx2, zx2, xzm, zzm = (
            t[e.XB_Z2 + i], t[e.ZB_Z2 + i], t[e.XB_X2 + i], t[e.ZB_X2 + i], t[e.X_ZM + i], t[e.Z_ZM + i],
        )  # fmt: skip
        o1, o2, oz1, oz2 = t[e.ACC + i], t[e.ACC + W + i], t[e.ACC + 2 * W + i], t[e.ACC + 3 * W + i]
        ox1, ox2, om, ozm = t[e.ACC + 4 * W + i], t[e.ACC + 5 * W + i], t[e.ACC + 6 * W + i], t[e.ACC + 7 * W + i]
        # the block turns with what it is bonded to
        held_1, held_m = (1.0 - free_t) * stiff, (1.0 - free_t) * free_m
        second = t[e.P_TURN + i]
        pxl = half * (t[e.P_XL + i] + xl1 * o1 + slip * ox1)
        pzl = half * (t[e.P_ZL + i] + zl1 * o1 + free_b * oz1)
        pxu = half * (t[e.P_XU + i] + xu1 * o1 + slip * ox1 + xum * om + xzm * ozm)
        pzu = half * (t[e.P_ZU + i] + zu1 * o1 + free_b * oz1 + zum * om + zzm * ozm)
        pxb = m2 * (t[e.P_XB + i] + xb1 * o1 + xb2 * o2 + xz2 * oz2 + slip * ox1 + xx2 * ox2 + xbm * om + xzm * ozm)
        pzb = t[e.P_ZB + i] + zb1 * o1 + zb2 * o2 + free_b * oz1 + zz2 * oz2 + zx2 * ox2 + zbm * om + zzm * ozm
        pzb *= m2
        turn_l, turn_u = turning * (second + free_b * o1), turning * (second + stiff * o1 + free_m * om)
        turn_b = i2 * (second + held_1 * o1 + free_t * o2 + held_m * om)
        t[e.P_XL + i], t[e.P_XU + i], t[e.P_XB + i], t[e.P_ZB + i] = pxl, pxu, pxb, pzb
        f1 = xl1 * pxl + zl1 * pzl + xu1 * pxu + zu1 * pzu + xb1 * pxb + zb1 * pzb
        t[e.F + i] = -(f1 + free_b * turn_l + stiff * turn_u + held_1 * turn_b)
        t[e.F + W + i] = -(xb2 * pxb + zb2 * pzb + free_t * turn_b)
        t[e.F + 2 * W + i] = -free_b * (pzl + pzu + pzb)
        t[e.F + 3 * W + i] = -(xz2 * pxb + zz2 * pzb)
        t[e.F + 4 * W + i] = -slip * (pxl + pxu + pxb)
        t[e.F + 5 * W + i] = -(xx2 * pxb + zx2 * pzb)
        t[e.F + 6 * W + i] = -(xum * pxu + zum * pzu + xbm * pxb + zbm * pzb + free_m * turn_u + held_m * turn_b)
        t[e.F + 7 * W + i] = -(xzm * (pxu + pxb) + zzm * (pzu + pzb))
        # --- the matrix
        half, turning, m2, i2 = share * half, share * turning, share * m2, share * i2
        whole = 2.0 * half + m2
        m11 = half * (xl1 * xl1 + zl1 * zl1 + xu1 * xu1 + zu1 * zu1) + m2 * (xb1 * xb1 + zb1 * zb1)
        t[at(0, 0) + i] = m11 + turning * (free_b * free_b + stiff * stiff) + i2 * held_1 * held_1
        t[at(1, 0) + i] = m2 * (xb2 * xb1 + zb2 * zb1) + i2 * free_t * held_1
        t[at(1, 1) + i] = m2 * (xb2 * xb2 + zb2 * zb2) + i2 * free_t * free_t
        t[at(2, 0) + i] = free_b * (half * (zl1 + zu1) + m2 * zb1)
        t[at(2, 1) + i] = free_b * m2 * zb2
        t[at(2, 2) + i] = free_b * free_b * whole
        t[at(3, 0) + i] = m2 * (xz2 * xb1 + zz2 * zb1)
        t[at(3, 1) + i] = m2 * (xz2 * xb2 + zz2 * zb2)
        t[at(3, 2) + i] = m2 * zz2 * free_b
        t[at(3, 3) + i] = m2 * (xz2 * xz2 + zz2 * zz2)
        t[at(4, 0) + i] = slip * (half * (xl1 + xu1) + m2 * xb1)
        t[at(4, 1) + i] = slip * m2 * xb2
        t[at(4, 2) + i] = 0.0
        t[at(4, 3) + i] = slip * m2 * xz2
        t[at(4, 4) + i] = slip * slip * whole
        t[at(5, 0) + i] = m2 * (xx2 * xb1 + zx2 * zb1)
        t[at(5, 1) + i] = m2 * (xx2 * xb2 + zx2 * zb2)
        t[at(5, 2) + i] = m2 * zx2 * free_b
        t[at(5, 3) + i] = m2 * (xx2 * xz2 + zx2 * zz2)
        t[at(5, 4) + i] = m2 * xx2 * slip
        t[at(5, 5) + i] = m2 * (xx2 * xx2 + zx2 * zx2)
        m61 = half * (xum * xu1 + zum * zu1) + m2 * (xbm * xb1 + zbm * zb1)
        t[at(6, 0) + i] = m61 + turning * free_m * stiff + i2 * held_m * held_1
        t[at(6, 1) + i] = m2 * (xbm * xb2 + zbm * zb2) + i2 * held_m * free_t
        t[at(6, 2) + i] = free_b * (half * zum + m2 * zbm)
        t[at(6, 3) + i] = m2 * (xbm * xz2 + zbm * zz2)
        t[at(6, 4) + i] = slip * (half * xum + m2 * xbm)
        t[at(6, 5) + i] = m2 * (xbm * xx2 + zbm * zx2)
        m66 = half * (xum * xum + zum * zum) + m2 * (xbm * xbm + zbm * zbm)
        t[at(6, 6) + i] = m66 + turning * free_m * free_m + i2 * held_m * held_m
        t[at(7, 0) + i] = half * (xzm * xu1 + zzm * zu1) + m2 * (xzm * xb1 + zzm * zb1)
        t[at(7, 1) + i] = m2 * (xzm * xb2 + zzm * zb2)
        t[at(7, 2) + i] = zzm * free_b * (half + m2)
        t[at(7, 3) + i] = m2 * (xzm * xz2 + zzm * zz2)
        t[at(7, 4) + i] = slip * xzm * (half + m2)
        t[at(7, 5) + i] = m2 * (xzm * xx2 + zzm * zx2)
        t[at(7, 6) + i] = half * (xzm * xum + zzm * zum) + m2 * (xzm * xbm + zzm * zbm)
        t[at(7, 7) + i] = (half + m2) * (xzm * xzm + zzm * zzm)


@inlined
def slide(t: Table, which: int, i: int, near: float, far: float) -> None:
    """Add the layers' shear to the equation of one slip; no loop over the joints, it would not become vector code."""
    j, row = which * W + i, 4 + which
    free, along = t[e.FREE_X1 + j], t[e.SHEAR_B + j] * t[e.LENGTH_B + j]
    k, c = along * t[r.KB * W + j], along * t[r.CB * W + j]
    landed = t[e.SHEAR_B + j] * t[r.KB * W + j] * t[e.SHIFT_B + j]
    t[e.F + 4 * W + j] -= free * (k * t[e.Q + 4 * W + j] + c * t[e.V + 4 * W + j] - landed)
    t[at(row, row) + i] += free * (near * k + far * c) + 1.0 - free


@called
def forces(t: Table) -> None:
    """Add those of layers, couples and the wall's bending, and their slopes."""
    lanes = min(W, t.size)
    for i in range(lanes):
        near, far = t[r.NEAR * W + i], t[r.FAR * W + i]
        free_b, free_t, free_m = t[r.FREE_B * W + i], t[r.FREE_T * W + i], t[e.FREE_M + i]
        stiff, t1 = (1.0 - free_m) * free_b, t[e.Q + i]
        c1, cr = t[e.C1 + i] * free_b, t[e.CR + i] * free_t
        # the top joint's angle over theta1 and theta2; over thetam where the wall bends
        ct, cm = -cr * stiff, -cr * free_m
        over = max(abs(t1) - t[e.COUPLE_GAP + i], 0.0)
        spring, dashpot = t[e.COUPLE_K + i], t[e.COUPLE_C + i]
        couple = dashpot * t[e.V + i] + (spring * over if t1 >= 0.0 else -spring * over)
        mb, mt, d2, d3 = t[e.M_B + i], t[e.M_T + i], t[e.D2_T + i], t[e.D3_T + i]
        bend, axial = t[e.BEND + i], t[e.AXIAL + i]
        bent = bend * (t[e.Q + 6 * W + i] - t1)
        t[e.F + i] -= mb * c1 + mt * ct + free_b * (couple - bent)
        t[e.F + W + i] -= mt * cr
        t[e.F + 2 * W + i] += free_b * t[e.N_B + i]
        t[e.F + 3 * W + i] += free_t * t[e.N_T + i]
        t[e.F + 6 * W + i] -= free_m * (bent - mt * t[e.CR + i] * free_t)
        t[e.F + 7 * W + i] -= free_m * axial * t[e.Q + 7 * W + i]
        m11 = t[e.D3_B + i] * c1 * c1 + d3 * ct * ct + (near * spring if over > 0.0 else 0.0)
        t[at(0, 0) + i] += m11 + far * dashpot + 1.0 - free_b + near * bend * free_b
        t[at(1, 0) + i] += d3 * cr * ct
        t[at(1, 1) + i] += d3 * cr * cr + 1.0 - free_t
        t[at(2, 0) + i] -= t[e.D2_B + i] * c1
        t[at(2, 2) + i] += t[e.D1_B + i] * free_b + 1.0 - free_b
        t[at(3, 0) + i] -= d2 * ct
        t[at(3, 1) + i] -= d2 * cr
        t[at(3, 3) + i] += t[e.D1_T + i] * free_t + 1.0 - free_t
        t[at(6, 0) + i] += d3 * ct * cm - near * bend * free_b
        t[at(6, 1) + i] += d3 * cr * cm
        t[at(6, 3) + i] -= d2 * cm
        t[at(6, 6) + i] += d3 * cm * cm + near * bend + 1.0 - free_m
        t[at(7, 7) + i] += near * axial + 1.0 - free_m
        slide(t, 0, i, near, far)
        slide(t, 1, i, near, far)


@inlined
def factor_four(a: Lower) -> Lower:
    """L below the diagonal and 1/D on it, of a symmetric A = L D L^T of four rows."""
    a00, a10, a11, a20, a21, a22, a30, a31, a32, a33 = a
    d0 = 1.0 / a00
    l10, l20, l30 = a10 * d0, a20 * d0, a30 * d0
    d1 = 1.0 / (a11 - l10 * a10)
    b21, b31 = a21 - l20 * a10, a31 - l30 * a10
    l21, l31 = b21 * d1, b31 * d1
    d2 = 1.0 / (a22 - l20 * a20 - l21 * b21)
    b32 = a32 - l30 * a20 - l31 * b21
    l32 = b32 * d2
    return d0, l10, d1, l20, l21, d2, l30, l31, l32, 1.0 / (a33 - l30 * a30 - l31 * b31 - l32 * b32)


@inlined
def forward(a: Lower, x: Four) -> Four:
    """L^-1 x."""
    _, l10, _, l20, l21, _, l30, l31, l32, _ = a
    x1 = x[1] - l10 * x[0]
    x2 = x[2] - l20 * x[0] - l21 * x1
    return x[0], x1, x2, x[3] - l30 * x[0] - l31 * x1 - l32 * x2


@inlined
def scaled(a: Lower, x: Four) -> Four:
    """D^-1 x."""
    return a[0] * x[0], a[2] * x[1], a[5] * x[2], a[9] * x[3]


@inlined
def backward(a: Lower, x: Four) -> Four:
    """L^-T x."""
    _, l10, _, l20, l21, _, l30, l31, l32, _ = a
    x2 = x[2] - l32 * x[3]
    x1 = x[1] - l21 * x2 - l31 * x[3]
    return x[0] - l10 * x1 - l20 * x2 - l30 * x[3], x1, x2, x[3]


@inlined
def along(x: Four, y: Four) -> float:
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2] + x[3] * y[3]


@inlined
def lower(t: Table, first: int, i: int) -> Lower:
    """The entries on and below the diagonal of the four rows and columns from ``first`` on."""
    return (
        t[at(first, first) + i], t[at(first + 1, first) + i], t[at(first + 1, first + 1) + i],
        t[at(first + 2, first) + i], t[at(first + 2, first + 1) + i], t[at(first + 2, first + 2) + i],
        t[at(first + 3, first) + i], t[at(first + 3, first + 1) + i], t[at(first + 3, first + 2) + i],
        t[at(first + 3, first + 3) + i],
    )  # fmt: skip


@inlined
def put_lower(t: Table, first: int, i: int, a: Lower) -> None:
    t[at(first, first) + i], t[at(first + 1, first) + i], t[at(first + 1, first + 1) + i] = a[0], a[1], a[2]
    t[at(first + 2, first) + i], t[at(first + 2, first + 1) + i], t[at(first + 2, first + 2) + i] = a[3], a[4], a[5]
    t[at(first + 3, first) + i], t[at(first + 3, first + 1) + i] = a[6], a[7]
    t[at(first + 3, first + 2) + i], t[at(first + 3, first + 3) + i] = a[8], a[9]


@inlined
def four(t: Table, place: int, i: int) -> Four:
    """Four rows from a place on."""
    return t[place + i], t[place + W + i], t[place + 2 * W + i], t[place + 3 * W + i]


@inlined
def put_four(t: Table, place: int, i: int, x: Four) -> None:
    t[place + i], t[place + W + i], t[place + 2 * W + i], t[place + 3 * W + i] = x


@called
def factor(t: Table, m: More) -> None:
    """The matrix (P, B^T; B, C) in its place: P = L D L^T, rows D^-1 L^-1 B^T, and C - B P^-1 B^T = L D L^T."""
    lanes = min(W, t.size)
    for i in range(lanes):
        put_lower(t, 0, i, factor_four(lower(t, 0, i)))
    if m.size > 4:
        for i in range(lanes):
            p, c = lower(t, 0, i), lower(t, 4, i)
            y4, y5 = forward(p, four(t, at(4, 0), i)), forward(p, four(t, at(5, 0), i))
            y6, y7 = forward(p, four(t, at(6, 0), i)), forward(p, four(t, at(7, 0), i))
            z4, z5, z6, z7 = scaled(p, y4), scaled(p, y5), scaled(p, y6), scaled(p, y7)
            put_four(t, at(4, 0), i, z4)
            put_four(t, at(5, 0), i, z5)
            put_four(t, at(6, 0), i, z6)
            put_four(t, at(7, 0), i, z7)
            left = (
                c[0] - along(z4, y4), c[1] - along(z5, y4), c[2] - along(z5, y5), c[3] - along(z6, y4),
                c[4] - along(z6, y5), c[5] - along(z6, y6), c[6] - along(z7, y4), c[7] - along(z7, y5),
                c[8] - along(z7, y6), c[9] - along(z7, y7),
            )  # fmt: skip
            put_lower(t, 4, i, factor_four(left))


@called
def solve(t: Table, m: More, f: int, d: int) -> None:
    """d = M^-1 f, both by the place of their first row."""
    lanes = min(W, t.size)
    if m.size > 4:
        for i in range(lanes):
            p, c = lower(t, 0, i), lower(t, 4, i)
            z4, z5 = four(t, at(4, 0), i), four(t, at(5, 0), i)
            z6, z7 = four(t, at(6, 0), i), four(t, at(7, 0), i)
            g, h = forward(p, four(t, f, i)), four(t, f + 4 * W, i)
            h = forward(c, (h[0] - along(z4, g), h[1] - along(z5, g), h[2] - along(z6, g), h[3] - along(z7, g)))
            x = backward(c, scaled(c, h))
            put_four(t, d + 4 * W, i, x)
            g = scaled(p, g)
            g = (
                g[0] - along((z4[0], z5[0], z6[0], z7[0]), x), g[1] - along((z4[1], z5[1], z6[1], z7[1]), x),
                g[2] - along((z4[2], z5[2], z6[2], z7[2]), x), g[3] - along((z4[3], z5[3], z6[3], z7[3]), x),
            )  # fmt: skip
            put_four(t, d, i, backward(p, g))
    else:
        for i in range(lanes):
            p = lower(t, 0, i)
            put_four(t, d, i, backward(p, scaled(p, forward(p, four(t, f, i)))))
