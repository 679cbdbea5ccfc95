"""Names of the rows of the tables that lanes with effects have beside those of the plain kernel."""

from __future__ import annotations

from typing import NamedTuple

from models.lanes.arrays import Table

UNBOUNDED = 1e300
SIZE = 8
"""Coordinates; see `models.interface.chain`."""

# --- own: coordinates beyond the plain ones, their rates, accelerations of the step rule; the pitch of the base at
# the end of the coming step and its growth; memory
(
    X1, X2, TM, ZM, VX1, VX2, VTM, VZM, AX1, AX2, ATM, AZM,
    PSI, PSI_SECOND, GROWTH_PSI, GROWTH_SECOND,
    CLOSINGS, OPEN, TORN_LEFT, TORN_RIGHT,
    # constants of the lane
    PITCH, TOP_OFFSET, COUPLE_K, COUPLE_GAP, COUPLE_C, DRY, LEFT, RIGHT, FROZEN_B, FROZEN_T, LOSS, PER_CLOSING, TEARING,
    SHEAR_B, SHEAR_T, FRICTION, SLIDES, BEND, AXIAL, FREE_X1, FREE_X2, FREE_M, PER_OPENING_B, PER_OPENING_T,
    LENGTH, HALF_MASS, HALF_INERTIA,
) = range(47)  # fmt: skip
N_OWN = 47
CONSTANTS = tuple(range(PITCH, HALF_INERTIA + 1))
"""LENGTH: height of the wall; PER_OPENING: one over the opening that freezes a contact at half."""

# --- given: constants in this order, then coordinates, rates and memory at the start
G_STATE = len(CONSTANTS)
G_MEMORY = G_STATE + 8
N_GIVEN = G_MEMORY + 4
N_ENDED = 12

# --- joints at the predictor: sines and cosines; forces, moments, integrals of the stiffness, pressing lengths; what
# dry friction adds to theta1 and x1
(
    S1, C1, SM, CM, SR, CR, N_B, N_T, M_B, M_T, D1_B, D1_T, D2_B, D2_T, D3_B, D3_T, LENGTH_B, LENGTH_T,
    HELD_1, HELD_X,
) = range(20)  # fmt: skip
N_JOINT = 20

# --- bits of what acts
PITCHES, HALVES, BONDS, FREEZES, WEARS, DRIES, LEANS = (1 << k for k in range(7))
"""LEANS: rubber laws have to know the sides of the base or the angle of the upper half."""


class More(NamedTuple):
    """What a kernel is given of walls with effects: for n lanes, and tables of the W lanes under way to work in."""

    given: Table
    """(n, `N_GIVEN`)."""
    ended: Table
    """(n, `N_ENDED`): coordinates, rates and memory at the end, for the kernel to fill."""
    acts: int
    """Sum of the bits of what acts."""
    size: int
    """Coordinates that move: 4, 6 or 8."""
    own: Table
    """(`N_OWN`, W)."""
    joint: Table
    """(`N_JOINT`, W)."""
    q: Table
    """(8, W) at the predictor, as v; o: accelerations before; d: their change; f: right hand side."""
    v: Table
    o: Table
    d: Table
    f: Table
    shape: Table
    """(9, 8, W): x and z of the lower half, the upper half, the block, then the rotations of the three, over q."""
    pull: Table
    """(9, W): accelerations of these, then forces."""
    weight: Table
    """(9, W): masses and inertias."""
    matrix: Table
    """(8, 8, W)."""
    held: Table
    """(2, 8, W): answers to a couple on the wall, to a force along the base."""
