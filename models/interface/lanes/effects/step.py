"""One step of all lanes with effects: the rule of `models.interface.lanes.step` in up to eight coordinates.

Each part of the step goes over all lanes by itself, behind a flag of the call where it belongs to one mechanism. The
layers along the joints, the wall's bending, the couples and dry friction are implicit as the layers are: however stiff,
they set no bound on the step.
"""

from __future__ import annotations

from typing import Any

from models.interface.effects import CLOSED, OPENED
from models.interface.lanes import rows as r
from models.interface.lanes.effects import dry, joints, kinematics, landing, solve, table
from models.interface.lanes.effects import rows as e
from models.interface.lanes.effects.rows import More
from models.interface.lanes.reading import account_joints, read_bodies, read_joints
from models.interface.lanes.rows import W
from models.interface.lanes.step import AM
from models.lanes.arrays import Table
from models.lanes.compiler import called, inlined


@called
def predict(t: Table, m: More) -> None:
    """Everything at the predictor that the layers' laws want to know."""
    kinematics.predict(t)
    kinematics.chain(t)
    if m.acts & e.HALVES:
        joints.base_by_halves(t)


@called
def strips_of_fibres(t: Table) -> None:
    """z, b S, c z', c b S' of both strips, and the least stress, for the fibres of the laws."""
    lanes = min(W, t.size)
    for i in range(lanes):
        c, b = t[r.CB * W + i], t[r.B1 * W + i]
        t[r.FZ_B * W + i], t[r.FY_B * W + i] = t[e.Q + 2 * W + i], c * t[e.V + 2 * W + i]
        t[r.FS_B * W + i], t[r.FR_B * W + i] = b * t[e.S1 + i], c * b * t[e.C1 + i] * t[e.V + i]
        c, b = t[r.CT * W + i], t[r.BT * W + i]
        rate = t[e.CR + i] * (t[e.V + W + i] - t[e.V + 6 * W + i])
        t[r.FZ_T * W + i], t[r.FY_T * W + i] = t[e.Q + 3 * W + i], c * t[e.V + 3 * W + i]
        t[r.FS_T * W + i], t[r.FR_T * W + i] = b * t[e.SR + i], c * b * rate
        t[r.FLOOR * W + i] = 0.0 if t[r.CLIP * W + i] > 0.0 else -e.UNBOUNDED
    for row in range(r.FN_B, r.FN_B + 10):
        for i in range(lanes):
            t[row * W + i] = 0.0


@called
def step(t: Table, m: More, laws: Any) -> int:
    """One step from the predictor on; returns how many lanes need attention."""
    if not m.acts & e.HALVES:
        joints.base_strip(t)
    if m.acts & e.BONDS:
        joints.bonds(t)
    joints.top_strip(t)
    pressing(t)
    if m.acts & e.SHEARS:
        landing.land(t)
    if laws is not None:
        joints.add_laws(t)
    if m.acts & e.FREEZES:
        joints.freeze(t)
    solve.inertia(t)
    solve.forces(t)
    if m.acts & e.TABLES_ACT:
        table.act(t)
    solve.factor(t, m)
    solve.solve(t, m, e.F, e.D)
    if m.acts & e.DRIES:
        dry.hold(t, m)
    go_on(t)
    flagged = read(t)
    if m.acts & e.BONDS:
        tear(t)
    if m.acts & e.WEARS:
        wear(t)
    return flagged


@called
def pressing(t: Table) -> None:
    """The least length of both joints that pressed so far."""
    lanes = min(W, t.size)
    for i in range(lanes):
        t[r.SHARE_B * W + i] = min(t[r.SHARE_B * W + i], t[e.LENGTH_B + i])
        t[r.SHARE_T * W + i] = min(t[r.SHARE_T * W + i], t[e.LENGTH_T + i])


@called
def go_on(t: Table) -> None:
    """The state at the end of the step; what a bonded joint or a stiff wall ties together stays so."""
    lanes = min(W, t.size)
    for k in range(4):
        for i in range(lanes):
            near, far, j = t[r.NEAR * W + i], t[r.FAR * W + i], k * W + i
            d, more = t[e.D + j], t[e.D + 4 * W + j]
            t[r.T1 * W + j], t[r.V1 * W + j] = t[e.Q + j] + near * d, t[e.V + j] + far * d
            t[e.X1 + j], t[e.VX1 + j] = t[e.Q + 4 * W + j] + near * more, t[e.V + 4 * W + j] + far * more
            t[r.A1 * W + j], t[e.AX1 + j] = t[e.ACC + j] + d, t[e.ACC + 4 * W + j] + more
    for i in range(lanes):
        bends, turns = t[e.FREE_M + i] > 0.0, t[r.FREE_T * W + i] > 0.0
        tm = t[e.TM + i] if bends else t[r.T1 * W + i]
        vm = t[e.VTM + i] if bends else t[r.V1 * W + i]
        am = t[e.ATM + i] if bends else t[r.A1 * W + i]
        t[e.TM + i], t[e.VTM + i], t[e.ATM + i] = tm, vm, am
        t[r.T2 * W + i] = t[r.T2 * W + i] if turns else tm
        t[r.V2 * W + i] = t[r.V2 * W + i] if turns else vm
        t[r.A2 * W + i] = t[r.A2 * W + i] if turns else am


@inlined
def kinetic_energy(t: Table, i: int) -> float:
    """Twice that of the bodies (J) at the end of the step."""
    free_b, free_t, free_m = t[r.FREE_B * W + i], t[r.FREE_T * W + i], t[e.FREE_M + i]
    v1, v2, y1, y2 = t[r.V1 * W + i], t[r.V2 * W + i], t[r.Y1 * W + i], t[r.Y2 * W + i]
    slip, slip_2, vm, ym = t[e.VX1 + i], t[e.VX2 + i], t[e.VTM + i], t[e.VZM + i]
    stiff, base_x, base_z = (1.0 - free_m) * free_b, t[e.FREE_X1 + i] * slip, free_b * y1
    rise_x, rise_z = t[e.X_ZM + i] * ym + base_x, t[e.Z_ZM + i] * ym + base_z
    xl, zl = t[e.XL_1 + i] * v1 + base_x, t[e.ZL_1 + i] * v1 + base_z
    xu, zu = t[e.XU_1 + i] * v1 + t[e.XU_M + i] * vm + rise_x, t[e.ZU_1 + i] * v1 + t[e.ZU_M + i] * vm + rise_z
    xb = t[e.XB_1 + i] * v1 + t[e.XB_2 + i] * v2 + t[e.XB_Z2 + i] * y2 + t[e.XB_X2 + i] * slip_2
    zb = t[e.ZB_1 + i] * v1 + t[e.ZB_2 + i] * v2 + t[e.ZB_Z2 + i] * y2 + t[e.ZB_X2 + i] * slip_2
    xb, zb = xb + t[e.XB_M + i] * vm + rise_x, zb + t[e.ZB_M + i] * vm + rise_z
    upper, block = stiff * v1 + free_m * vm, (1.0 - free_t) * (stiff * v1 + free_m * vm) + free_t * v2
    lower = free_b * v1
    halves = t[e.HALF_MASS + i] * (xl * xl + zl * zl + xu * xu + zu * zu)
    halves += t[e.HALF_INERTIA + i] * (lower * lower + upper * upper)
    return float(halves + t[r.M2 * W + i] * (xb * xb + zb * zb) + t[r.I2 * W + i] * block * block)


@called
def read(t: Table) -> int:
    """What is read off the new state; returns how many lanes need attention."""
    lanes = min(W, t.size)
    flagged = 0
    for i in range(lanes):
        v1, vm, v2, y1, y2 = t[r.V1 * W + i], t[e.VTM + i], t[r.V2 * W + i], t[r.Y1 * W + i], t[r.Y2 * W + i]
        c1, cr, near = t[e.C1 + i], t[e.CR + i], t[r.NEAR * W + i]
        d1, d2, d3, d4 = t[e.D + i], t[e.D + W + i], t[e.D + 2 * W + i], t[e.D + 3 * W + i]
        d5, d6, d7, d8 = t[e.D + 4 * W + i], t[e.D + 5 * W + i], t[e.D + 6 * W + i], t[e.D + 7 * W + i]
        turned = t[e.TM + i] - t[e.Q + 6 * W + i]
        lean = t[e.S1 + i] + c1 * near * d1
        t[r.LEAN * W + i] = lean
        z1, z2, rate = t[r.Z1 * W + i], t[r.Z2 * W + i], v2 - vm
        angle = t[e.SR + i] + cr * (t[r.T2 * W + i] - t[e.Q + W + i] - turned)
        steady = read_joints(t, i, z1, z2, lean, angle, y1, y2, c1 * v1, cr * rate)
        stands = read_bodies(t, i, t[r.T1 * W + i], t[r.T2 * W + i], kinetic_energy(t, i))
        dm = d7 if t[e.FREE_M + i] > 0.0 else d1
        dr = d2 - dm
        nb = t[e.N_B + i] - t[e.D1_B + i] * d3 + t[e.D2_B + i] * c1 * d1
        nt = t[e.N_T + i] - t[e.D1_T + i] * d4 + t[e.D2_T + i] * cr * dr
        couple_b = c1 * (t[e.M_B + i] - t[e.D2_B + i] * d3 + t[e.D3_B + i] * c1 * d1)
        couple_t = cr * (t[e.M_T + i] - t[e.D2_T + i] * d4 + t[e.D3_T + i] * cr * dr)
        over = max(abs(t[r.T1 * W + i]) - t[e.COUPLE_GAP + i], 0.0)
        couple = t[e.COUPLE_K + i] * (over if t[r.T1 * W + i] >= 0.0 else -over) + t[e.COUPLE_C + i] * v1
        slip, slip_2 = t[e.VX1 + i], t[e.VX2 + i]
        power_b = nb * y1 - (couple_b + couple) * v1 + t[e.HELD_1 + i] * v1 + t[e.HELD_X + i] * slip
        power_t = nt * y2 - couple_t * rate
        along, along_2 = t[e.SHEAR_B + i] * t[e.LENGTH_B + i], t[e.SHEAR_T + i] * t[e.LENGTH_T + i]
        power_b -= along * slip * (t[r.KB * W + i] * t[e.X1 + i] + t[r.CB * W + i] * slip)
        power_t -= along_2 * slip_2 * (t[r.KT * W + i] * t[e.X2 + i] + t[r.CT * W + i] * slip_2)
        power_b += t[e.SHEAR_B + i] * t[r.KB * W + i] * t[e.SHIFT_B + i] * slip
        power_t += t[e.SHEAR_T + i] * t[r.KT * W + i] * t[e.SHIFT_T + i] * slip_2
        # forces of inertia at the end of the step: along x of all, along and across the top joint of the block
        m, m2, base = (1.0 - AM) * t[e.HALF_MASS + i], (1.0 - AM) * t[r.M2 * W + i], t[e.FREE_X1 + i] * d5
        lower = m * (t[e.XL_1 + i] * d1 + base)
        upper = m * (t[e.XU_1 + i] * d1 + t[e.XU_M + i] * d7 + t[e.X_ZM + i] * d8 + base)
        x = t[e.XB_1 + i] * d1 + t[e.XB_2 + i] * d2 + t[e.XB_Z2 + i] * d4 + t[e.XB_X2 + i] * d6
        z = t[e.ZB_1 + i] * d1 + t[e.ZB_2 + i] * d2 + t[e.ZB_Z2 + i] * d4 + t[e.ZB_X2 + i] * d6
        x += t[e.XB_M + i] * d7 + t[e.X_ZM + i] * d8 + base
        z += t[e.ZB_M + i] * d7 + t[e.Z_ZM + i] * d8 + t[r.FREE_B * W + i] * d3
        x, z = t[e.P_XB + i] + m2 * x - t[e.PUSH + i], t[e.P_ZB + i] + m2 * z
        whole = t[e.P_XL + i] + lower + t[e.P_XU + i] + upper + x
        push = x * t[e.CM + i] - z * t[e.SM + i]
        account_joints(t, i, whole, nb, push, nt, power_b, power_t)
        attention = not (stands & steady)
        t[r.FLAG * W + i] = 1.0 if attention else 0.0
        flagged += 1 if attention else 0
    return flagged


@called
def tear(t: Table) -> None:
    """What is bonded still."""
    lanes = min(W, t.size)
    for i in range(lanes):
        left, right = joints.tears(t, i, t[r.B1 * W + i], t[r.Z1 * W + i], t[r.LEAN * W + i])
        t[e.TORN_LEFT + i], t[e.TORN_RIGHT + i] = left, right


@called
def wear(t: Table) -> None:
    """Closings of the base, which its stiffness falls with."""
    lanes = min(W, t.size)
    for i in range(lanes):
        share, is_open = t[e.LENGTH_B + i], t[e.OPEN + i] > 0.0
        closes = is_open & (share > CLOSED * 2.0 * t[r.B1 * W + i])
        t[e.CLOSINGS + i] += 1.0 if closes else 0.0
        opens = share < OPENED * 2.0 * t[r.B1 * W + i]
        t[e.OPEN + i] = 1.0 if (is_open | opens) & (not closes) else 0.0
