"""Names of the rows of the lane kernel's tables, each row W lanes long."""

from typing import Any

Table = Any
"""A table of the kernel, rows by lanes."""
W = 16
"""Lanes under way at once: two vectors of eight doubles, four of four."""
SIZES = (1, 6, 12)
"""Numbers of levels that are compiled: a chain is padded to the next one with levels that weigh nothing."""

# --- scalars: record now, at the step's end and its growth from step to step; results so far; bearings
(
    AT, NEXT, GROWTH, SCALE, STEP,
    PEAK_U, PEAK_ACCELERATION, PEAK_DRIFT, WORK, KINETIC, WINDOW,
    FORCE, BEFORE, AFTER, RATE_NEXT,
) = range(15)  # fmt: skip
N_SCALAR = 15
"""FORCE: of the bearings beyond k u + c u' at the last step; BEFORE, AFTER: its ends for the coming one;
RATE_NEXT: u' predicted at its end."""

# --- memory of the bearings beside that of the rubber's laws: u and u' where they last looked, wear now
U, RATE, AMPLITUDE, CROSSINGS, WEAR = range(5)
N_MEMORY = 5

# --- numbers of the bearings; zero where Payne's law or wear is absent
K, P_PAYNE, P_PER_AMPLITUDE, P_LOSS, P_PER_CROSSING = range(5)
N_LAW = 5

# --- result: what a lane has gathered; after these columns y and the memory at the end
R_PEAK_U, R_PEAK_ACCELERATION, R_PEAK_DRIFT, R_WORK, R_REST, R_FAILED = range(6)
N_RESULT = 6
