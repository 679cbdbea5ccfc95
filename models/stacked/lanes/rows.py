"""Where a quantity stands in the tables of the lane kernel.

``work`` (N_WORK, W) has a row for a quantity and a column for each lane under way; its sizes are constants,
so the compiler proves that rows do not overlap. ``given`` and ``result`` are tables (n, columns) over all
lanes; ``result`` starts with the columns of `models.stacked.account`.
Masses and moments of a lane are over its total mass M.

Arguments of all pieces of the kernel: ``lane``, a row of ``given`` and ``result``; ``slot``, the column of ``work`` in
which it is under way; ``record`` (5, steps + 2), the channels a, a_z (m s-2), psi, psi'' (per unit of pitch), shaken;
``i``, a step of ``h`` s, and ``f``, a fraction of it; ``log``, ``count`` as in `models.lanes.arrays.Tables`;
``linear``, ``general``, None or True, for the compiled variant: a general one knows a table that pitches and dry
friction; ``system`` (4, 5), the two equations of motion about each pair of pivots. Angles theta_1 (q1), r (q2) in rad,
rates in rad s-1, accelerations a (less G psi), G in m s-2, ``turning`` psi'' in rad s-2 (None: the variant is not
general), times in s; s1, s2: sides of `models.stacked.configuration`.
"""

from __future__ import annotations

from models.stacked.account import N_ACCOUNT

W = 16
"""Lanes under way together: two full 512-bit or four 256-bit vectors."""

# --- work: theta_1, r, their rates; the same at the start of the step
Q1, Q2, V1, V2 = 0, 1, 2, 3
Q1S, Q2S, V1S, V2S = 4, 5, 6, 7
X1, X2 = 8, 9  # q'' at the present time
X1S, X2S = 43, 44  # and at the start of the step
A0, G0 = 10, 11  # base acceleration and apparent gravity at the present time
RA, RV = 12, 13  # record, horizontal and vertical, at the end of the step
SCALE, OFFSET, GRAVITY, VSCALE = 14, 15, 16, 17
SIDE_1, SIDE_2 = 18, 19  # corners, 1 for a closed joint
FREE_1, FREE_2 = 20, 21  # 1 for a joint that is up, 0 for a closed one and for a wall that friction holds
KX, KZ = 22, 23  # (m1 A + m2 B)/M of the upright stack
BX, BZ = 24, 25  # B
CX, CZ = 26, 27  # m2 C/M
J1, J2 = 28, 29  # (I1 + m1 A.A + m2 B.B)/M, (I2 + m2 C.C)/M
SHARE = 30  # m2/M
DRAG = 31  # viscous couple over theta_1', over M
WIDE_1, WIDE_2 = 32, 33  # 2 b1, 2 b2 of the joints; 0 of a wall that friction holds
LIMIT_1, LIMIT_2 = 34, 35  # |theta| beyond which a lane needs attention; negative: always
DEMAND_1, DEMAND_2 = 36, 37  # largest |H|/N
WORK, WORK_STEP = 38, 39  # work lost in the couple over M: in all, in this step
MARGIN_1, MARGIN_2 = 40, 41  # negative: the joint has opened or closed in the step
FLAG = 42
PITCH, RP, RPP = 45, 46, 47  # rad s2 m-1 times scale; psi and psi'' of the record at the end of the step
PSI0, TURNING0 = 48, 49  # psi and psi'' at the present time
FRAME_1, FRAME_2 = 50, 51  # couples over -psi'', over M
LEVER_1, LEVER_2 = 52, 53  # (m1 z1 + m2 z2)/M, m2 z2/M of the mass centres' heights
COULOMB = 54  # couple of dry friction over M
OPPOSING = 55  # the same times the sign of theta_1'; 0 where it holds the wall
N_WORK = 56

# --- given: constants of a lane
(
    P_SCALE, P_OFFSET, P_GRAVITY, P_VSCALE, P_M1, P_I1, P_H1, P_TALL, P_M2, P_I2, P_H2, P_B1, P_B2, P_D1, P_D2,
    P_GIVEN_1, P_GIVEN_2, P_FACTOR_1, P_FACTOR_2, P_VISCOUS, P_CALM_1, P_CALM_2, P_STAND_1, P_STAND_2,
    P_RIGHT_1, P_LEFT_1, P_RIGHT_2, P_LEFT_2, P_FRAME_1, P_FRAME_2, P_PITCH, P_COULOMB, P_Q1, P_Q2, P_V1, P_V2,
) = range(36)  # fmt: skip
N_GIVEN = 36

# --- result: the account, then what a lane must remember: its configuration, since when, whether closed
R_SIDE_1, R_SIDE_2, R_SINCE, R_CLOSED = range(N_ACCOUNT, N_ACCOUNT + 4)
N_RESULT = N_ACCOUNT + 4

# kinds of events in a log, in the order of `models.stacked.lanes.run.EVENTS`
LOG_ONSET, LOG_IMPACT, LOG_CHANGE, LOG_REST, LOG_OVERTURNED = 0.0, 1.0, 2.0, 3.0, 4.0
