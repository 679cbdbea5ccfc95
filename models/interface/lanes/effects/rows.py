"""Places of the rows that lanes with effects have in the kernel's flat table, behind those of the rubber laws.

Row k of lane i lies at place + i, as in `models.interface.lanes.along`: one table with constant places, so that loops
over the lanes become vector code.
"""

from __future__ import annotations

from typing import NamedTuple

from models.interface.effects import CELLS
from models.interface.lanes.along import N_WORK_LAWS
from models.interface.lanes.rows import W
from models.interface.table import ONE_LINE, TABLES
from models.lanes.arrays import Table

UNBOUNDED = 1e300
SIZE = 8
"""Coordinates; see `models.interface.chain`."""


def _places(first: int, count: int) -> range:
    return range(first * W, (first + count) * W, W)


# --- own: coordinates beyond the plain ones, their rates, accelerations of the step rule; the pitch of the base at
# the end of the coming step and its growth; memory
N_OWN = 47
(
    X1, X2, TM, ZM, VX1, VX2, VTM, VZM, AX1, AX2, ATM, AZM,
    PSI, PSI_SECOND, GROWTH_PSI, GROWTH_SECOND,
    CLOSINGS, OPEN, TORN_LEFT, TORN_RIGHT,
    # constants of the lane
    PITCH, TOP_OFFSET, COUPLE_K, COUPLE_GAP, COUPLE_C, DRY, LEFT, RIGHT, FROZEN_B, FROZEN_T, LOSS, PER_CLOSING, TEARING,
    SHEAR_B, SHEAR_T, FRICTION, SLIDES, BEND, AXIAL, FREE_X1, FREE_X2, FREE_M, PER_OPENING_B, PER_OPENING_T,
    LENGTH, HALF_MASS, HALF_INERTIA,
) = _places(N_WORK_LAWS, N_OWN)  # fmt: skip
OWN, N_CONSTANTS = X1, (HALF_INERTIA - PITCH) // W + 1
"""LENGTH: height of the wall; PER_OPENING: one over the opening that freezes a contact at half."""

# --- of both joints: slips at which the layers have landed; ends of what touched at the last step and touches now, of
# what presses now; integral of those slips over what presses
_LANDED = N_WORK_LAWS + N_OWN
N_LANDED = 2 * CELLS + 14
LANDED = _LANDED * W
(
    FROM_B, FROM_T, TO_B, TO_T, NEXT_FROM_B, NEXT_FROM_T, NEXT_TO_B, NEXT_TO_T, LOW_B, LOW_T, HIGH_B, HIGH_T,
    SHIFT_B, SHIFT_T,
) = _places(_LANDED + 2 * CELLS, 14)  # fmt: skip

# --- joints at the predictor: sines and cosines; forces, moments, integrals of the stiffness, pressing lengths; what
# dry friction adds to theta1 and x1
_JOINTS = _LANDED + N_LANDED
(
    S1, C1, SM, CM, SR, CR, N_B, N_T, M_B, M_T, D1_B, D1_T, D2_B, D2_T, D3_B, D3_T, LENGTH_B, LENGTH_T,
    HELD_1, HELD_X,
) = _places(_JOINTS, 20)  # fmt: skip

# --- bodies at the predictor: x and z of the lower half (L), the upper half (U) and the block (B) over theta1, theta2,
# thetam, z2, x2, and of the last two over zm; over the others they are 0 or 1. Their accelerations, then forces of
# inertia, and those of rotation that the base brings along
_BODIES = _JOINTS + 20
(
    XL_1, ZL_1, XU_1, ZU_1, XB_1, ZB_1, XB_2, ZB_2, XU_M, ZU_M, XB_M, ZB_M, XB_Z2, ZB_Z2, XB_X2, ZB_X2, X_ZM, Z_ZM,
    P_XL, P_ZL, P_XU, P_ZU, P_XB, P_ZB, P_TURN,
) = _places(_BODIES, 25)  # fmt: skip

# --- equations, 8 rows each: q, q' at the predictor, accelerations before, their change, right hand side; answers to a
# couple on the wall and to a force along the base; then the matrix, 8 rows of 8
_EQUATIONS = _BODIES + 25
Q, V, ACC, D, F, HELD, HELD_BASE, MATRIX = _places(_EQUATIONS, 8 * SIZE)[::SIZE]

# --- a law in a table: one over the spacings, the values; its force on the block with that force's slope over d along
# the base, and the block's motion along the base over q
_LAW = _EQUATIONS + 7 * SIZE + SIZE**2
N_REACHES, N_VALUES = len(TABLES.variables), len(TABLES.terms) * ONE_LINE
N_LAW = N_REACHES + N_VALUES
REACH, VALUES, PUSH, PUSHED, ALONG = (
    (_LAW + k) * W for k in (0, N_REACHES, N_LAW, N_LAW + 1, N_LAW + 2)
)  # fmt: skip
N_TABLE = _LAW + N_LAW + 2 + SIZE

# --- given: constants in the order above, then coordinates, rates and memory at the start, then the law in a table
G_STATE = N_CONSTANTS
G_MEMORY = G_STATE + 8
G_LANDED = G_MEMORY + 4
G_LAW = G_LANDED + 2 * CELLS
N_GIVEN = G_LAW + N_LAW
N_ENDED = 12 + 2 * CELLS

# --- bits of what acts
PITCHES, HALVES, BONDS, FREEZES, WEARS, DRIES, TABLES_ACT, SHEARS = (1 << k for k in range(8))


class More(NamedTuple):
    """What a kernel is given of n walls with effects."""

    given: Table
    """(n, `N_GIVEN`)."""
    ended: Table
    """(n, `N_ENDED`): coordinates, rates and memory at the end, for the kernel to fill."""
    acts: int
    """Sum of the bits of what acts."""
    size: int
    """Coordinates that move: 4, 6 or 8."""
