"""Where a quantity stands in the tables of the lane kernel.

``work`` (N_WORK, W) has a row for a quantity and a column for each lane under way; its sizes are constants,
so the compiler proves that rows do not overlap. ``given`` and ``result`` are tables (n, columns) over all
lanes.

Arguments of all pieces of the kernel: ``lane``, a row of ``given`` and ``result``; ``slot``, the column of ``work`` in
which it is under way; ``record`` (5, steps + 2), the channels a, a_z (m s-2), psi, psi'' (per unit of pitch), shaken;
``i``, a step of ``h`` s, and ``f``, a fraction of it; ``log``, ``count`` as in `models.lanes.arrays.Tables`;
``general``, ``linear``, None or True, for the compiled variant. Angles in rad, rates in rad s-1, accelerations a, G in
m s-2, times in s; couples, moments and work over M, so in m2 s-2.
"""

from __future__ import annotations

from models.housner.lanes.table import N_TABLE

W = 16
"""Lanes under way together: two full 512-bit or four 256-bit vectors."""

# --- work: state and inputs of the step
TH, OM = 0, 1  # theta, theta'
TH0, OM0 = 2, 3  # the same at the start of the step
A0, G0 = 4, 5  # base acceleration and apparent gravity at the start of the coming step
RA, RV = 6, 7  # record, horizontal and vertical, at the end of the step
SCALE, OFFSET, GRAVITY, VSCALE = 8, 9, 10, 11
SIDE = 12  # sign of theta
LIMIT = 13  # |theta| beyond which a lane needs attention
DEMAND = 14  # largest |H|/N
# the side on which the block stands: M b/I_O (signed), M h/I_O, I_O/M
CB, CH, LAMBDA = 15, 16, 17
# --- work: rows that only the general equation reads
B, H, IM = 18, 19, 20  # b of this side, h, I/M
RHO, CRUSH, PEAK = 21, 22, 23
JOINT = 24  # 1/joint angle, negative when rigid
K, GAP, VISCOUS, COULOMB, QUADRATIC = 25, 26, 27, 28, 29  # over M
DIRECTION = 30  # sign of theta' held during the step
PITCH, RP, RPP, P0, PP0 = 31, 32, 33, 34, 35  # rad s2 m-1 times scale; psi and psi'' of the record
WORK, WORK_STEP = 36, 37  # work lost in couples over M: in all, in this step
FLAG = 38  # whether the lane needs attention after this step
# --- work: degrees of freedom of a regime (`models.housner.lanes.regimes`); U, U1 in contact: slip u, u'
U, U1 = 39, 40  # in flight: x and x' of the mass centre; in flexure: amplitude eta and eta' of the mode
Z, Z1 = 41, 42  # in flight: z and z' of the mass centre
# --- work: a step that starts inside a step of the record, after an impact
START, START0 = 43, 44  # fraction of the coming step that is over already; of the step just taken
ROUNDS = 45  # impacts so far within this step of the record
TURN = 46  # a turning point matters when |theta| exceeds this: the peak so far, or always (-1)
STOPS = 47  # whether a law may hold the lane at a turning point
TABLE = 48  # a law in a table, as in `models.housner.lanes.table`
N_WORK = TABLE + N_TABLE

# --- given: constants of a lane
(
    Q_SCALE, Q_OFFSET, Q_GRAVITY, Q_VSCALE, Q_MASS, Q_HEIGHT, Q_RIGHT, Q_LEFT, Q_INERTIA,
    Q_RESTITUTION, Q_FACTOR, Q_ASPECT, Q_EXPONENT, Q_SLOPE, Q_LOSS, Q_FLOOR, Q_REST, Q_ALPHA, Q_P,
    Q_RHO, Q_CRUSH, Q_JOINT, Q_K, Q_GAP, Q_VISCOUS, Q_COULOMB, Q_QUADRATIC, Q_PITCH,
    Q_BOUNCE, Q_FRICTION, Q_FREQUENCY, Q_MODAL_MASS, Q_MODAL_FORCE, Q_MODAL_MOMENT,
    Q_THETA, Q_OMEGA, Q_PEAK, Q_SWING, Q_IMPACTS,
) = range(39)  # fmt: skip
N_GIVEN = 39

# --- result: what a lane has gathered
(
    R_PEAK, R_UPLIFT, R_ONSET, R_OVERTURNED_AT, R_IMPACTS, R_ROTATION, R_DISSIPATED, R_DEMAND, R_STATUS,
    R_SWING, R_UP_SINCE, R_MODE, R_ENERGY,
) = range(13)  # fmt: skip
N_RESULT = 13

# R_MODE: rocking, at rest, held at a turning point by friction, sliding flat on the base, in free
# flight, ringing with the base in full contact; only a rocking lane moves in the vector loop
UP, DOWN, HELD, SLIDING, FLIGHT, RINGING = 0.0, 1.0, 2.0, 3.0, 4.0, 5.0

REST, ROCKING, OVERTURNED, NOT_CONVERGED = 1.0, 2.0, 3.0, 5.0

# kinds of events in a log, in the order of `models.housner.lanes.run.EVENTS`
LOG_ONSET, LOG_IMPACT, LOG_REST, LOG_OVERTURNED = 0.0, 1.0, 2.0, 3.0
