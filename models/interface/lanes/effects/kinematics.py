"""The chain of `models.interface.chain` at the predictor of the coming step, for all lanes."""

from __future__ import annotations

from models.interface.lanes import rows as r
from models.interface.lanes.effects import rows as e
from models.interface.lanes.effects.rows import More
from models.lanes.arrays import Table
from models.lanes.compiler import called
from models.lanes.elementary import sine_cosine


@called
def predict(w: Table, m: More) -> None:
    """q, q' with the acceleration held over the step."""
    own, lanes = m.own, m.q.shape[1]
    for k in range(4):
        for i in range(lanes):
            h, o, v = w[r.STEP, i], w[r.A1 + k, i], w[r.V1 + k, i]
            m.q[k, i], m.v[k, i], m.o[k, i] = w[r.T1 + k, i] + h * v + w[r.HALF, i] * o, v + h * o, o
            o, v = own[e.AX1 + k, i], own[e.VX1 + k, i]
            m.q[4 + k, i], m.v[4 + k, i], m.o[4 + k, i] = own[e.X1 + k, i] + h * v + w[r.HALF, i] * o, v + h * o, o


@called
def chain(w: Table, m: More) -> None:
    """Sines and cosines, Jacobians, and the accelerations that are there without q''."""
    own, joint, shape, pull, lanes = m.own, m.joint, m.shape, m.pull, m.q.shape[1]
    for i in range(lanes):
        t1, t2, tm = m.q[0, i], m.q[1, i], m.q[6, i]
        v1, v2, vm = m.v[0, i], m.v[1, i], m.v[6, i]
        s1, c1 = sine_cosine(t1)
        sm, cm = sine_cosine(tm)
        sr, cr = sine_cosine(t2 - tm)
        s2, c2 = sm * cr + cm * sr, cm * cr - sm * sr
        joint[e.S1, i], joint[e.C1, i], joint[e.SM, i], joint[e.CM, i] = s1, c1, sm, cm
        joint[e.SR, i], joint[e.CR, i] = sr, cr
        free_b, free_t, free_m = w[r.FREE_B, i], w[r.FREE_T, i], own[e.FREE_M, i]
        free_x1, free_x2 = own[e.FREE_X1, i], own[e.FREE_X2, i]
        b1 = w[r.TOE_1, i] if s1 >= 0.0 else -w[r.TOE_1, i]
        bt = w[r.TOE_T, i] if sr >= 0.0 else -w[r.TOE_T, i]
        height, h2, d = own[e.LENGTH, i], w[r.H2, i], own[e.TOP_OFFSET, i]
        half, quarter = 0.5 * height, 0.25 * height
        x1, x2, zm = m.q[4, i], m.q[5, i], m.q[7, i]
        roll, along = b1 * s1, bt - bt * cr + x2
        high, level = quarter + zm, w[r.HEIGHT, i] - half + zm + m.q[3, i]
        xr_d = bt * sr
        # columns over thetam: of the block and, where the wall does not bend, part of theta1
        mx, mz = (level - xr_d) * cm - along * sm, (xr_d - level) * sm - along * cm
        bx, bz = xr_d * cm + h2 * c2 - d * s2, -xr_d * sm - h2 * s2 - d * c2
        mx, mz = mx + (1.0 - free_t) * bx, mz + (1.0 - free_t) * bz
        stiff = (1.0 - free_m) * free_b
        shape[0, 0, i], shape[1, 0, i] = free_b * (roll + quarter * c1), -free_b * quarter * s1
        cut_x, cut_z = free_b * (roll + half * c1), -free_b * half * s1
        shape[2, 0, i], shape[3, 0, i] = cut_x + stiff * high * cm, cut_z - stiff * high * sm
        shape[4, 0, i], shape[5, 0, i] = cut_x + stiff * mx, cut_z + stiff * mz
        shape[2, 6, i], shape[3, 6, i] = free_m * high * cm, -free_m * high * sm
        shape[4, 6, i], shape[5, 6, i] = free_m * mx, free_m * mz
        shape[4, 1, i], shape[5, 1, i] = free_t * bx, free_t * bz
        shape[1, 2, i], shape[3, 2, i], shape[5, 2, i] = free_b, free_b, free_b
        shape[4, 3, i], shape[5, 3, i] = free_t * sm, free_t * cm
        shape[0, 4, i], shape[2, 4, i], shape[4, 4, i] = free_x1, free_x1, free_x1
        shape[4, 5, i], shape[5, 5, i] = free_x2 * cm, -free_x2 * sm
        shape[2, 7, i], shape[3, 7, i] = free_m * sm, free_m * cm
        shape[4, 7, i], shape[5, 7, i] = free_m * sm, free_m * cm
        shape[6, 0, i], shape[7, 0, i], shape[7, 6, i] = free_b, stiff, free_m
        shape[8, 1, i], shape[8, 0, i], shape[8, 6, i] = free_t, (1.0 - free_t) * stiff, (1.0 - free_t) * free_m
        # J' q', the acceleration of the pitching base, gravity
        q11, qmm, q22, turn = v1 * v1, vm * vm, v2 * v2, v2 - vm
        drift, rise = xr_d * turn + m.v[5, i], m.v[7, i] + m.v[3, i]
        pitching = w[r.SCALE, i] * own[e.PITCH, i]
        gravity = w[r.GRAVITY, i] + w[r.VSCALE, i] * w[r.RV, i]
        a = w[r.SCALE, i] * w[r.RA, i] + w[r.OFFSET, i] - gravity * pitching * own[e.PSI, i]
        second = pitching * own[e.PSI_SECOND, i]
        foot_x, foot_z, foot = b1 - b1 * c1 + x1, m.q[2, i], b1 * c1 * q11
        upper_x, upper_z = along * cm + level * sm, level * cm - along * sm
        block_x, block_z = d * c2 + h2 * s2, h2 * c2 - d * s2
        cut_x, cut_z = a + foot - half * s1 * q11, gravity - half * c1 * q11
        place_x, place_z = foot_x + half * s1, foot_z + half * c1
        pull[0, i] = a + foot - quarter * s1 * q11 + second * (foot_z + quarter * c1)
        pull[1, i] = gravity - quarter * c1 * q11 - second * (foot_x + quarter * s1)
        pull[2, i] = cut_x - high * sm * qmm + 2.0 * vm * m.v[7, i] * cm + second * (place_z + high * cm)
        pull[3, i] = cut_z - high * cm * qmm - 2.0 * vm * m.v[7, i] * sm - second * (place_x + high * sm)
        inward = bt * cr * turn * turn
        pull[4, i] = (
            cut_x - upper_x * qmm + 2.0 * vm * (rise * cm - drift * sm) + inward * cm - block_x * q22
            + second * (place_z + upper_z + block_z)
        )  # fmt: skip
        pull[5, i] = (
            cut_z - upper_z * qmm - 2.0 * vm * (rise * sm + drift * cm) - inward * sm - block_z * q22
            - second * (place_x + upper_x + block_x)
        )  # fmt: skip
        pull[6, i], pull[7, i], pull[8, i] = second, second, second
