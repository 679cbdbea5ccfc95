"""Names of the rows of the lane kernel's tables: ``work`` (rows, W lanes), ``given``, ``result``."""

W = 16
"""Lanes under way at once: two vectors of eight doubles, four of four."""

# --- work: state at the end of the last step; A is the step rule's own acceleration
(
    T1, T2, Z1, Z2, V1, V2, Y1, Y2, A1, A2, AZ1, AZ2,
    # record at the end of the coming step, its growth from step to step, length of the steps (s), steps done
    RA, RV, GROWTH_A, GROWTH_V, STEP, CLOCK,
    # what the step rule makes of the lane's constants: powers of h, masses, stiffness of the layers
    HALF, NEAR, FAR, N1, N2, STIFF_B, STIFF_T,
    # constants of the lane
    SCALE, OFFSET, GRAVITY, VSCALE,
    M1, H1, I1, M2, H2, I2, HEIGHT, B1, BT, TOE_1, TOE_T, KB, KT, CB, CT, LATE_B, LATE_T, CLIP, FREE_B, FREE_T,
    # joints: height of the freer end over compression, time up, closings, first uplift (in steps), least share,
    # largest compression of the edge
    LIFT_B, LIFT_T, UP_B, UP_T, CLOSED_B, CLOSED_T, ONSET_B, ONSET_T, SHARE_B, SHARE_T, EDGE_B, EDGE_T,
    # power and work of the strips; forces along and across the joints at the worst ratio
    POWER_B, POWER_T, WORK_B, WORK_T, ALONG_B, ALONG_T, ACROSS_B, ACROSS_T,
    # bodies: peaks, kinetic energy (peak so far, peak of this window)
    PEAK_1, PEAK_2, KINETIC, WINDOW,
    # strips at the predictor: z, b S, c z', c b S', the least stress; what the fibres add: force, moment, slopes
    # times 1, x, x^2
    FZ_B, FZ_T, FS_B, FS_T, FY_B, FY_T, FR_B, FR_T, FN_B, FN_T, FM_B, FM_T, F1_B, F1_T, F2_B, F2_T, F3_B, F3_T, FLOOR,
    # whether uplifts and closings are to be logged, whether the lane needs attention
    LOGGED, FLAG,
    # of lanes with effects: sine of the wall's rotation, factors on the base's stiffness at x < 0 and x > 0
    LEAN, FACTOR_L, FACTOR_R,
) = range(97)  # fmt: skip
N_WORK = 97
CONSTANTS = tuple(range(SCALE, FREE_T + 1))
"""Rows copied from ``given``, in this order."""

# --- given: the constants in the order above, then the state at the start, the first period (s), steps per sample
N_CONSTANTS = len(CONSTANTS)
Q_STATE = N_CONSTANTS
Q_PERIOD = N_CONSTANTS + 8
Q_STEPS = N_CONSTANTS + 9
N_GIVEN = N_CONSTANTS + 10

# --- result: what a lane has gathered
(
    R_PEAK_1, R_PEAK_2, R_UP_B, R_UP_T, R_ONSET_B, R_ONSET_T, R_SHARE_B, R_SHARE_T, R_CLOSED_B, R_CLOSED_T,
    R_LOST_B, R_LOST_T, R_FRICTION_B, R_FRICTION_T, R_END_1, R_END_2, R_END_Z1, R_END_Z2, R_OVER_1, R_OVER_2,
    R_FAILED, R_EDGE_B, R_EDGE_T,
) = range(23)  # fmt: skip
N_RESULT = 23
"""R_LOST: work of the strips on the bodies, the energy of the layers not yet taken into account."""

# kinds of events in a log, in the order of `models.interface.lanes.run.EVENTS`
LOG_UPLIFT, LOG_CLOSING, LOG_REST, LOG_OVERTURNED = 0.0, 1.0, 2.0, 3.0
