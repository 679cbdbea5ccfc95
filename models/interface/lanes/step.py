"""One step of all W lanes: second order, one evaluation, linearly implicit in the layers.

The generalised-alpha rule in the form of Wood, Bossak, Zienkiewicz: with d the change of a,

    q1 = q + h v + h^2 (a/2 + beta d),  v1 = v + h (a + gamma d),  M (a + (1 - am) d) = Q - n at q1, v1,
    gamma = 1/2 - am,  beta = (1 - am)^2/4,

solved by one Newton step from d = 0 with the exact tangent of both strips (gamma h C + beta h^2 K):
the error left is of third order in h, like that of the rule. The stiff axial mode is damped by the
rule (am < 0) and sets no bound on h. M, n and Q are the full nonlinear ones of
`models.interface.reference.equation`, written in the wall's frame: x along the wall's top, z along its axis.

``mixed`` is None or True (one of the joints is bonded), ``laws`` None or True (a layer has rubber
laws beside the linear one): a compiled variant holds only what is in use.
"""

from __future__ import annotations

from typing import Any

from models.interface.lanes import rows as r
from models.interface.lanes.reading import account_joints, read_bodies, read_joints
from models.interface.lanes.rows import W
from models.interface.lanes.strip import resultants, slopes
from models.lanes.arrays import Table
from models.lanes.compiler import inlined
from models.lanes.elementary import sine_cosine

DISSIPATION = 0.8
"""Spectral radius at infinite frequency: 1 no numerical dissipation, 0 the most."""
AM = (DISSIPATION - 1.0) / (DISSIPATION + 1.0)
GAMMA = 0.5 - AM
BETA = 0.25 * (1.0 - AM) ** 2


@inlined
def step_one(t: Table, i: int, mixed: Any, laws: Any) -> bool:
    """One step of the lane in slot i; returns whether it needs attention."""
    h = t[r.STEP * W + i]
    # --- predictor and inputs at the end of the step
    o1, o2, o3, o4 = t[r.A1 * W + i], t[r.A2 * W + i], t[r.AZ1 * W + i], t[r.AZ2 * W + i]
    v1, v2, y1, y2 = t[r.V1 * W + i], t[r.V2 * W + i], t[r.Y1 * W + i], t[r.Y2 * W + i]
    half, near, far = t[r.HALF * W + i], t[r.NEAR * W + i], t[r.FAR * W + i]
    t1, t2 = t[r.T1 * W + i] + h * v1 + half * o1, t[r.T2 * W + i] + h * v2 + half * o2
    z1, z2 = t[r.Z1 * W + i] + h * y1 + half * o3, t[r.Z2 * W + i] + h * y2 + half * o4
    v1, v2, y1, y2 = v1 + h * o1, v2 + h * o2, y1 + h * o3, y2 + h * o4
    a = t[r.SCALE * W + i] * t[r.RA * W + i] + t[r.OFFSET * W + i]
    g = t[r.GRAVITY * W + i] + t[r.VSCALE * W + i] * t[r.RV * W + i]
    # --- kinematics: columns A, B, (-s1, c1), (0, 1) of J_2 in the wall's frame
    s1, c1 = sine_cosine(t1)
    sr, cr = sine_cosine(t2 - t1)
    turn = v2 - v1
    m1, m2, i1, i2 = t[r.M1 * W + i], t[r.M2 * W + i], t[r.I1 * W + i], t[r.I2 * W + i]
    h1, h2 = t[r.H1 * W + i], t[r.H2 * W + i]
    b1 = t[r.TOE_1 * W + i] if s1 >= 0.0 else -t[r.TOE_1 * W + i]
    bt = t[r.TOE_T * W + i] if sr >= 0.0 else -t[r.TOE_T * W + i]
    xr, xr_d = bt - bt * cr, bt * sr
    height = t[r.HEIGHT * W + i] + z2
    level = height - xr_d
    roll = b1 * s1
    ax, az = level + roll * c1, roll * s1 - xr
    bx, bz = xr_d + h2 * cr, -h2 * sr
    jx, jz = roll + h1 * c1, -h1 * s1
    free_b, free_t = 1.0, 1.0
    if mixed is not None:
        # the columns of what a bonded joint takes away vanish; theta2 moves with theta1
        free_b, free_t = t[r.FREE_B * W + i], t[r.FREE_T * W + i]
        ax, az = free_b * (ax + (1.0 - free_t) * bx), free_b * (az + (1.0 - free_t) * bz)
        jx, jz = free_b * jx, free_b * jz
        bx, bz = free_t * bx, free_t * bz
        # keeps the rows of absent coordinates regular
        i1, i2 = i1 + free_b * (1.0 - free_t) * i2, i2 + (1.0 - free_t) * i1
    cx, cz = -free_b * s1, free_b * c1
    # --- accelerations of both centres with q'' = a, gravity and the base's motion included
    q11, q22 = v1 * v1, v2 * v2
    pivot = a + b1 * c1 * q11
    px = m1 * (pivot - h1 * s1 * q11 + jx * o1)
    pz = m1 * (g - h1 * c1 * q11 + jz * o1 + free_b * o3)
    ux = bt * cr * turn * turn + 2.0 * v1 * y2 - q11 * xr + pivot * c1 - g * s1 - h2 * sr * q22
    uz = pivot * s1 + g * c1 - 2.0 * v1 * xr_d * turn - q11 * height - h2 * cr * q22
    ux = m2 * (ux + ax * o1 + bx * o2 + cx * o3)
    uz = m2 * (uz + az * o1 + bz * o2 + cz * o3 + free_t * o4)
    # --- strips
    rb, rt = c1 * v1, cr * turn
    kb, kt, cb, ct, clip = t[r.KB * W + i], t[r.KT * W + i], t[r.CB * W + i], t[r.CT * W + i], t[r.CLIP * W + i]
    slope_b, steep_b, lean_b = slopes(kb, cb, s1, rb)
    slope_t, steep_t, lean_t = slopes(kt, ct, sr, rt)
    below, above = lean_b * steep_b, lean_t * steep_t
    inverse = 1.0 / (below * above)
    nb, mb, d1b, d2b, d3b, share_b = resultants(
        t[r.B1 * W + i], clip, z1, kb * z1 + cb * y1, s1, slope_b, steep_b, lean_b, inverse * above,
        t[r.STIFF_B * W + i],
    )  # fmt: skip
    nt, mt, d1t, d2t, d3t, share_t = resultants(
        t[r.BT * W + i], clip, z2, kt * z2 + ct * y2, sr, slope_t, steep_t, lean_t, inverse * below,
        t[r.STIFF_T * W + i],
    )  # fmt: skip
    t[r.SHARE_B * W + i] = min(t[r.SHARE_B * W + i], share_b)
    t[r.SHARE_T * W + i] = min(t[r.SHARE_T * W + i], share_t)
    if laws is not None:
        nb, mb = nb + t[r.FN_B * W + i], mb + t[r.FM_B * W + i]
        nt, mt = nt + t[r.FN_T * W + i], mt + t[r.FM_T * W + i]
    # --- residual Q - n - M a, and the matrix (1 - am) M + gamma h C + beta h^2 K
    couple_b, couple_t = mb * c1, mt * cr
    f1 = free_b * couple_t - couple_b - i1 * o1 - px * jx - pz * jz - ux * ax - uz * az
    f2 = -couple_t - i2 * o2 * free_t - ux * bx - uz * bz
    f3 = nb - free_b * pz - ux * cx - uz * cz
    f4 = nt - free_t * uz
    if laws is not None:
        d1b, d1t = d1b + near * t[r.F1_B * W + i], d1t + near * t[r.F1_T * W + i]
        d2b, d2t = d2b + near * t[r.F2_B * W + i], d2t + near * t[r.F2_T * W + i]
        d3b, d3t = d3b + near * t[r.F3_B * W + i], d3t + near * t[r.F3_T * W + i]
    d2b, d3b, d2t, d3t = d2b * c1, d3b * c1 * c1, d2t * cr, d3t * cr * cr
    n1, n2 = t[r.N1 * W + i], t[r.N2 * W + i]
    njx, njz = n1 * jx, n1 * jz
    nax, naz, nbx, nbz, ncx, ncz = n2 * ax, n2 * az, n2 * bx, n2 * bz, n2 * cx, n2 * cz
    k11 = (1.0 - AM) * i1 + njx * jx + njz * jz + nax * ax + naz * az
    k12 = nax * bx + naz * bz
    w13 = free_b * njz + nax * cx + naz * cz
    w14 = free_t * naz
    k22 = (1.0 - AM) * i2 + nbx * bx + nbz * bz
    w23 = nbx * cx + nbz * cz
    w24 = free_t * nbz
    w34 = free_t * ncz
    k13, k14, k24 = w13, w14, w24
    w11, w12, w22 = k11 + d3b + free_b * d3t, k12 - free_b * d3t, k22 + d3t
    w13, w14, w24 = w13 - d2b, w14 + free_b * d2t, w24 - d2t
    w33, w44 = n1 + n2 + d1b, n2 + d1t
    if mixed is not None:
        w44 += (1.0 - free_t) * n1
    # --- z1, z2 eliminated first, all over their determinant
    det = w33 * w44 - w34 * w34
    u13, u14 = w13 * w44 - w14 * w34, w14 * w33 - w13 * w34
    u23, u24 = w23 * w44 - w24 * w34, w24 * w33 - w23 * w34
    x11 = det * w11 - u13 * w13 - u14 * w14
    x12 = det * w12 - u13 * w23 - u14 * w24
    x22 = det * w22 - u23 * w23 - u24 * w24
    e1 = det * f1 - u13 * f3 - u14 * f4
    e2 = det * f2 - u23 * f3 - u24 * f4
    both = x11 * x22 - x12 * x12
    inverse = 1.0 / (both * det)
    d1 = (e1 * x22 - e2 * x12) * (inverse * det)
    d2 = (e2 * x11 - e1 * x12) * (inverse * det)
    f3 -= w13 * d1 + w23 * d2
    f4 -= w14 * d1 + w24 * d2
    d3 = (f3 * w44 - f4 * w34) * (inverse * both)
    d4 = (f4 * w33 - f3 * w34) * (inverse * both)
    if mixed is not None:
        d2 = d2 if free_t > 0.0 else d1 + o1 - o2
    # --- the new state
    turned_1, turned_2 = near * d1, near * d2
    t1, t2, z1, z2 = t1 + turned_1, t2 + turned_2, z1 + near * d3, z2 + near * d4
    v1, v2, y1, y2 = v1 + far * d1, v2 + far * d2, y1 + far * d3, y2 + far * d4
    t[r.T1 * W + i], t[r.T2 * W + i], t[r.Z1 * W + i], t[r.Z2 * W + i] = t1, t2, z1, z2
    t[r.V1 * W + i], t[r.V2 * W + i], t[r.Y1 * W + i], t[r.Y2 * W + i] = v1, v2, y1, y2
    t[r.A1 * W + i], t[r.A2 * W + i], t[r.AZ1 * W + i], t[r.AZ2 * W + i] = o1 + d1, o2 + d2, o3 + d3, o4 + d4
    # --- what is read off it
    turn = v2 - v1
    steady = read_joints(t, i, z1, z2, s1 + c1 * turned_1, sr + cr * (turned_2 - turned_1), y1, y2, c1 * v1, cr * turn)
    # v M v, times 1 - am: only its ratio to its peak is looked at
    both_1 = k11 * v1 + 2.0 * (k12 * v2 + k13 * y1 + k14 * y2)
    both_2 = k22 * v2 + 2.0 * (w23 * y1 + k24 * y2)
    kinetic = both_1 * v1 + both_2 * v2 + ((n1 + n2) * y1 + 2.0 * w34 * y2) * y1 + n2 * y2 * y2
    stands = read_bodies(t, i, t1, t2, kinetic)
    # forces of the strips in the new state, by their tangent: they carry what lies above
    nb, nt = nb - d1b * d3 + d2b * d1, nt - d1t * d4 + d2t * (d2 - d1)
    couple_b, couple_t = couple_b - d2b * d3 + d3b * d1, couple_t - d2t * d4 + d3t * (d2 - d1)
    ux += nax * d1 + nbx * d2 + ncx * d3
    across = nt
    if mixed is not None:
        across = nt if free_t > 0.0 else uz + naz * d1 + ncz * d3
    px += njx * d1 + ux * c1 + across * s1
    account_joints(t, i, px, nb, ux, across, nb * y1 - couple_b * v1, nt * y2 - couple_t * turn)
    attention = not (stands & steady)
    t[r.FLAG * W + i] = 1.0 if attention else 0.0
    return attention


@inlined
def step_all(t: Table, mixed: Any, laws: Any) -> int:
    """One step of all lanes; returns how many need attention."""
    flagged = 0
    for i in range(W):
        flagged += 1 if step_one(t, i, mixed, laws) else 0
    return flagged
