"""The chain of `models.interface.chain` at the predictor of the coming step, for all lanes."""

from __future__ import annotations

from models.interface.lanes import rows as r
from models.interface.lanes.effects import rows as e
from models.interface.lanes.rows import W
from models.lanes.arrays import Table
from models.lanes.compiler import called
from models.lanes.elementary import sine_cosine


@called
def predict(t: Table) -> None:
    """q, q' with the acceleration held over the step."""
    # a length that the compiler does not know: else it unrolls the loops instead of making vector code
    lanes = min(W, t.size)
    for k in range(4):
        for i in range(lanes):
            h, half, j = t[r.STEP * W + i], t[r.HALF * W + i], k * W + i
            o, v = t[r.A1 * W + j], t[r.V1 * W + j]
            t[e.Q + j], t[e.V + j], t[e.ACC + j] = t[r.T1 * W + j] + h * v + half * o, v + h * o, o
            o, v, x, more = t[e.AX1 + j], t[e.VX1 + j], t[e.X1 + j], 4 * W + j
            t[e.Q + more], t[e.V + more], t[e.ACC + more] = x + h * v + half * o, v + h * o, o


@called
def chain(t: Table) -> None:
    """Sines and cosines, Jacobians, and the accelerations that are there without q''."""
    lanes = min(W, t.size)
    for i in range(lanes):
        t1, t2, tm = t[e.Q + i], t[e.Q + W + i], t[e.Q + 6 * W + i]
        s1, c1 = sine_cosine(t1)
        sm, cm = sine_cosine(tm)
        sr, cr = sine_cosine(t2 - tm)
        t[e.S1 + i], t[e.C1 + i], t[e.SM + i], t[e.CM + i], t[e.SR + i], t[e.CR + i] = s1, c1, sm, cm, sr, cr
    for i in range(lanes):
        s1, c1, sm, cm, sr, cr = t[e.S1 + i], t[e.C1 + i], t[e.SM + i], t[e.CM + i], t[e.SR + i], t[e.CR + i]
        s2, c2 = sm * cr + cm * sr, cm * cr - sm * sr
        v1, v2, vm = t[e.V + i], t[e.V + W + i], t[e.V + 6 * W + i]
        free_b, free_t, free_m = t[r.FREE_B * W + i], t[r.FREE_T * W + i], t[e.FREE_M + i]
        free_x2 = t[e.FREE_X2 + i]
        b1 = t[r.TOE_1 * W + i] if s1 >= 0.0 else -t[r.TOE_1 * W + i]
        bt = t[r.TOE_T * W + i] if sr >= 0.0 else -t[r.TOE_T * W + i]
        h2, d = t[r.H2 * W + i], t[e.TOP_OFFSET + i]
        half, quarter = 0.5 * t[e.LENGTH + i], 0.25 * t[e.LENGTH + i]
        z1, z2, x1 = t[e.Q + 2 * W + i], t[e.Q + 3 * W + i], t[e.Q + 4 * W + i]
        x2, zm = t[e.Q + 5 * W + i], t[e.Q + 7 * W + i]
        roll, along = b1 * s1, bt - bt * cr + x2
        high, level = quarter + zm, t[r.HEIGHT * W + i] - half + zm + z2
        xr_d = bt * sr
        # columns over thetam: of the block and, where the wall does not bend, part of theta1
        mx, mz = (level - xr_d) * cm - along * sm, (xr_d - level) * sm - along * cm
        bx, bz = xr_d * cm + h2 * c2 - d * s2, -xr_d * sm - h2 * s2 - d * c2
        mx, mz = mx + (1.0 - free_t) * bx, mz + (1.0 - free_t) * bz
        stiff = (1.0 - free_m) * free_b
        t[e.XL_1 + i], t[e.ZL_1 + i] = free_b * (roll + quarter * c1), -free_b * quarter * s1
        cut_x, cut_z = free_b * (roll + half * c1), -free_b * half * s1
        t[e.XU_1 + i], t[e.ZU_1 + i] = cut_x + stiff * high * cm, cut_z - stiff * high * sm
        t[e.XB_1 + i], t[e.ZB_1 + i] = cut_x + stiff * mx, cut_z + stiff * mz
        t[e.XU_M + i], t[e.ZU_M + i] = free_m * high * cm, -free_m * high * sm
        t[e.XB_M + i], t[e.ZB_M + i] = free_m * mx, free_m * mz
        t[e.XB_2 + i], t[e.ZB_2 + i] = free_t * bx, free_t * bz
        t[e.XB_Z2 + i], t[e.ZB_Z2 + i] = free_t * sm, free_t * cm
        t[e.XB_X2 + i], t[e.ZB_X2 + i] = free_x2 * cm, -free_x2 * sm
        t[e.X_ZM + i], t[e.Z_ZM + i] = free_m * sm, free_m * cm
        # J' q', the acceleration of the pitching base, gravity
        q11, qmm, q22, turn = v1 * v1, vm * vm, v2 * v2, v2 - vm
        z2_rate, x2_rate, zm_rate = t[e.V + 3 * W + i], t[e.V + 5 * W + i], t[e.V + 7 * W + i]
        drift, rise = xr_d * turn + x2_rate, zm_rate + z2_rate
        scale = t[r.SCALE * W + i]
        pitching = scale * t[e.PITCH + i]
        gravity = t[r.GRAVITY * W + i] + t[r.VSCALE * W + i] * t[r.RV * W + i]
        a = scale * t[r.RA * W + i] + t[r.OFFSET * W + i] - gravity * pitching * t[e.PSI + i]
        second = pitching * t[e.PSI_SECOND + i]
        foot_x, foot = b1 - b1 * c1 + x1, b1 * c1 * q11
        upper_x, upper_z = along * cm + level * sm, level * cm - along * sm
        block_x, block_z = d * c2 + h2 * s2, h2 * c2 - d * s2
        cut_x, cut_z = a + foot - half * s1 * q11, gravity - half * c1 * q11
        place_x, place_z = foot_x + half * s1, z1 + half * c1
        inward = bt * cr * turn * turn
        t[e.P_XL + i] = a + foot - quarter * s1 * q11 + second * (z1 + quarter * c1)
        t[e.P_ZL + i] = gravity - quarter * c1 * q11 - second * (foot_x + quarter * s1)
        t[e.P_XU + i] = cut_x - high * sm * qmm + 2.0 * vm * zm_rate * cm + second * (place_z + high * cm)
        t[e.P_ZU + i] = cut_z - high * cm * qmm - 2.0 * vm * zm_rate * sm - second * (place_x + high * sm)
        t[e.P_XB + i] = (
            cut_x - upper_x * qmm + 2.0 * vm * (rise * cm - drift * sm) + inward * cm - block_x * q22
            + second * (place_z + upper_z + block_z)
        )  # fmt: skip
        t[e.P_ZB + i] = (
            cut_z - upper_z * qmm - 2.0 * vm * (rise * sm + drift * cm) - inward * sm - block_z * q22
            - second * (place_x + upper_x + block_x)
        )  # fmt: skip
        t[e.P_TURN + i] = second
