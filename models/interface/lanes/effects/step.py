"""One step of all lanes with effects: the rule of `models.interface.lanes.step` in up to eight coordinates.

Each part of the step goes over all lanes by itself, behind a flag of the call where it belongs to one mechanism. The
layers along the joints, the wall's bending, the couples and dry friction are implicit as the layers are: however stiff,
they set no bound on the step.
"""

from __future__ import annotations

from typing import Any

from models.interface.effects import CLOSED, OPENED
from models.interface.lanes import rows as r
from models.interface.lanes.effects import dry, joints, kinematics, solve
from models.interface.lanes.effects import rows as e
from models.interface.lanes.effects.rows import More
from models.interface.lanes.reading import account_joints, read_bodies, read_joints
from models.interface.lanes.step import AM
from models.lanes.arrays import Table
from models.lanes.compiler import called


@called
def predict(w: Table, m: More) -> None:
    """Everything at the predictor that the layers' laws want to know."""
    kinematics.predict(w, m)
    kinematics.chain(w, m)
    if m.acts & e.HALVES:
        joints.base_by_halves(w, m)


@called
def strips_of_fibres(w: Table, m: More) -> None:
    """z, b S, c z', c b S' of both strips, and the least stress, for the fibres of the laws."""
    joint, lanes = m.joint, m.q.shape[1]
    for which in range(2):
        for i in range(lanes):
            c, b = w[r.CB + which, i], w[r.B1 + which, i]
            rate = joint[e.C1, i] * m.v[0, i] if which == 0 else joint[e.CR, i] * (m.v[1, i] - m.v[6, i])
            w[r.FZ_B + which, i], w[r.FY_B + which, i] = m.q[2 + which, i], c * m.v[2 + which, i]
            w[r.FS_B + which, i] = b * joint[e.S1 if which == 0 else e.SR, i]
            w[r.FR_B + which, i] = c * b * rate
    for i in range(lanes):
        w[r.FLOOR, i] = 0.0 if w[r.CLIP, i] > 0.0 else -e.UNBOUNDED
        for row in range(10):
            w[r.FN_B + row, i] = 0.0


@called
def step(w: Table, m: More, laws: Any) -> int:
    """One step from the predictor on; returns how many lanes need attention."""
    own, joint, lanes = m.own, m.joint, m.q.shape[1]
    if not m.acts & e.HALVES:
        joints.base_strip(w, m)
    if m.acts & e.BONDS:
        joints.bonds(w, m)
    joints.top_strip(w, m)
    for i in range(lanes):
        w[r.SHARE_B, i] = min(w[r.SHARE_B, i], joint[e.LENGTH_B, i])
        w[r.SHARE_T, i] = min(w[r.SHARE_T, i], joint[e.LENGTH_T, i])
    if laws is not None:
        joints.add_laws(w, m)
    if m.acts & e.FREEZES:
        joints.freeze(w, m)
    solve.inertia(m, 1.0 - AM)
    solve.forces(w, m)
    solve.factor(m)
    solve.solve(m, m.f, m.d)
    if m.acts & e.DRIES:
        dry.hold(w, m)
    go_on(w, m)
    flagged = read(w, m)
    for i in range(lanes):
        if m.acts & e.BONDS:
            z, s = w[r.Z1, i], w[r.LEAN, i]
            own[e.TORN_LEFT, i], own[e.TORN_RIGHT, i] = joints.tears(own, i, w[r.B1, i], z, s)
        if m.acts & e.WEARS:
            share, is_open = joint[e.LENGTH_B, i], own[e.OPEN, i] > 0.0
            closes = is_open & (share > CLOSED * 2.0 * w[r.B1, i])
            own[e.CLOSINGS, i] += 1.0 if closes else 0.0
            opens = share < OPENED * 2.0 * w[r.B1, i]
            own[e.OPEN, i] = 1.0 if (is_open | opens) & (not closes) else 0.0
    return flagged


@called
def go_on(w: Table, m: More) -> None:
    """The state at the end of the step; what a bonded joint or a stiff wall ties together stays so."""
    own, lanes = m.own, m.q.shape[1]
    for k in range(8):
        for i in range(lanes):
            d = m.d[k, i] if k < m.size else 0.0
            q, v, o = m.q[k, i] + w[r.NEAR, i] * d, m.v[k, i] + w[r.FAR, i] * d, m.o[k, i] + d
            if k < 4:
                w[r.T1 + k, i], w[r.V1 + k, i], w[r.A1 + k, i] = q, v, o
            else:
                own[e.X1 + k - 4, i], own[e.VX1 + k - 4, i], own[e.AX1 + k - 4, i] = q, v, o
    for i in range(lanes):
        bends = own[e.FREE_M, i] > 0.0
        own[e.TM, i] = own[e.TM, i] if bends else w[r.T1, i]
        own[e.VTM, i] = own[e.VTM, i] if bends else w[r.V1, i]
        own[e.ATM, i] = own[e.ATM, i] if bends else w[r.A1, i]
        turns = w[r.FREE_T, i] > 0.0
        w[r.T2, i] = w[r.T2, i] if turns else own[e.TM, i]
        w[r.V2, i] = w[r.V2, i] if turns else own[e.VTM, i]
        w[r.A2, i] = w[r.A2, i] if turns else own[e.ATM, i]


@called
def read(w: Table, m: More) -> int:
    """What is read off the new state; returns how many lanes need attention."""
    own, joint, shape, pull, lanes = m.own, m.joint, m.shape, m.pull, m.q.shape[1]
    flagged = 0
    # forces of inertia along x at the end of the step, and twice the kinetic energy
    for row in range(9):
        for j in range(m.size):
            for i in range(lanes):
                pull[row, i] += (1.0 - AM) * m.weight[row, i] * shape[row, j, i] * m.d[j, i]
    for i in range(lanes):
        kinetic = 0.0
        for row in range(9):
            speed = 0.0
            for j in range(4):
                speed += shape[row, j, i] * w[r.V1 + j, i]
            for j in range(4):
                speed += shape[row, 4 + j, i] * own[e.VX1 + j, i]
            kinetic += m.weight[row, i] * speed * speed
        v1, vm, v2, y1, y2 = w[r.V1, i], own[e.VTM, i], w[r.V2, i], w[r.Y1, i], w[r.Y2, i]
        c1, cr, near = joint[e.C1, i], joint[e.CR, i], w[r.NEAR, i]
        d1, d2, d3, d4 = m.d[0, i], m.d[1, i], m.d[2, i], m.d[3, i]
        turned = own[e.TM, i] - m.q[6, i]
        lean = joint[e.S1, i] + c1 * near * d1
        w[r.LEAN, i] = lean
        z1, z2, rate = w[r.Z1, i], w[r.Z2, i], v2 - vm
        angle = joint[e.SR, i] + cr * (w[r.T2, i] - m.q[1, i] - turned)
        steady = read_joints(w, i, z1, z2, lean, angle, y1, y2, c1 * v1, cr * rate)
        stands = read_bodies(w, i, w[r.T1, i], w[r.T2, i], kinetic)
        dm = m.d[6, i] if own[e.FREE_M, i] > 0.0 else d1
        dr = d2 - dm
        nb = joint[e.N_B, i] - joint[e.D1_B, i] * d3 + joint[e.D2_B, i] * c1 * d1
        nt = joint[e.N_T, i] - joint[e.D1_T, i] * d4 + joint[e.D2_T, i] * cr * dr
        couple_b = c1 * (joint[e.M_B, i] - joint[e.D2_B, i] * d3 + joint[e.D3_B, i] * c1 * d1)
        couple_t = cr * (joint[e.M_T, i] - joint[e.D2_T, i] * d4 + joint[e.D3_T, i] * cr * dr)
        over = max(abs(w[r.T1, i]) - own[e.COUPLE_GAP, i], 0.0)
        couple = own[e.COUPLE_K, i] * (over if w[r.T1, i] >= 0.0 else -over) + own[e.COUPLE_C, i] * v1
        power_b = nb * y1 - (couple_b + couple) * v1
        power_t = nt * y2 - couple_t * rate
        if m.acts & e.DRIES:
            power_b += joint[e.HELD_1, i] * v1 + joint[e.HELD_X, i] * own[e.VX1, i]
        if m.size > 4:
            along = own[e.SHEAR_B, i] * joint[e.LENGTH_B, i] * own[e.VX1, i]
            power_b -= along * (w[r.KB, i] * own[e.X1, i] + w[r.CB, i] * own[e.VX1, i])
            along = own[e.SHEAR_T, i] * joint[e.LENGTH_T, i] * own[e.VX2, i]
            power_t -= along * (w[r.KT, i] * own[e.X2, i] + w[r.CT, i] * own[e.VX2, i])
        push = pull[4, i] * joint[e.CM, i] - pull[5, i] * joint[e.SM, i]
        account_joints(w, i, pull[0, i] + pull[2, i] + pull[4, i], nb, push, nt, power_b, power_t)
        attention = not (stands & steady)
        w[r.FLAG, i] = 1.0 if attention else 0.0
        flagged += 1 if attention else 0
    return flagged
