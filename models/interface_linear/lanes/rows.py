"""Names of the columns of the lane kernel's tables: ``given``, ``held`` (what a lane gathers), the readings."""

# --- given: inputs, masses and levers, joints (base, top), state at the start, first period (s), steps per sample
(
    SCALE, OFFSET, GRAVITY, VSCALE,
    M1, M2, H1, H2, LEVER, I11, I12, I22,
    B_B, B_T, K_B, K_T, C_B, C_T, COMPRESSION_B, COMPRESSION_T, SIGMA_B, SIGMA_T, RUBBER_B, RUBBER_T,
    START,
) = range(25)  # fmt: skip
PERIOD = START + 8
STEPS, LEVELS, BRIEF = PERIOD + 1, PERIOD + 2, PERIOD + 3
N_GIVEN = PERIOD + 4

# --- gathered: peaks, kinetic energy (so far, of this window), joints: time up, lost energy, closings, onset,
# least share, forces along and across at the worst ratio, largest compression of the edge
(
    PEAK_1, PEAK_2, KINETIC, WINDOW, UP_B, UP_T, LOST_B, LOST_T, CLOSED_B, CLOSED_T, ONSET_B, ONSET_T,
    SHARE_B, SHARE_T, ALONG_B, ALONG_T, ACROSS_B, ACROSS_T, EDGE_B, EDGE_T,
) = range(20)  # fmt: skip
N_GATHERED = 20

# --- reading of a state: q'' (4), the four watched values, their rates
ACC, VALUE, RATE, N_READING = 0, 4, 8, 12
# --- state: q, q', then the inputs: a, its slope, G, its slope
A, A_SLOPE, G, G_SLOPE = range(8, 12)
N_STATE = 12
