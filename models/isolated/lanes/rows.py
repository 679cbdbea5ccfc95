"""Names of the rows of the lane kernel's tables, each row W lanes long."""

W = 16
"""Lanes under way at once: two vectors of eight doubles, four of four."""
SIZES = (1, 6, 12)
"""Numbers of levels that are compiled: a chain is padded to the next one with levels that weigh nothing."""

# --- scalars: record now, at the step's end and its growth from step to step; results so far; bearings
(
    AT, NEXT, GROWTH, SCALE, STEP,
    PEAK_U, PEAK_ACCELERATION, PEAK_DRIFT, WORK, KINETIC, WINDOW,
    FORCE, BEFORE, AFTER,
) = range(14)  # fmt: skip
N_SCALAR = 14
"""FORCE: of the bearings beyond k u + c u' at the last step; BEFORE, AFTER: its ends for the coming one."""

# --- memory of the bearings: u and u' where the laws last looked, hidden states, wear now
U, RATE, ARM, ZETA, LARGEST, AMPLITUDE, CROSSINGS, WEAR = range(8)
N_MEMORY = 8

# --- numbers of the laws; zero where a law is absent
(
    K, P_HARDENING, P_ARM, P_ARM_DECAY, P_ARM_GAIN, P_HYSTERETIC, P_YIELD, P_ORDER, P_SOFTENING, P_PER_STRAIN,
    P_PAYNE, P_PER_AMPLITUDE, P_LOSS, P_PER_CROSSING,
) = range(14)  # fmt: skip
N_LAW = 14

# --- result: what a lane has gathered; after these columns y and the memory at the end
R_PEAK_U, R_PEAK_ACCELERATION, R_PEAK_DRIFT, R_WORK, R_REST, R_FAILED = range(6)
N_RESULT = 6
