"""When two stacked blocks have overturned, and the energies this is judged by.

A body has overturned when its |theta| reaches pi/2; also, once the shaking has ended, when its mass
centre has passed over the pivot it stands on, it turns outwards, and the mechanical energy is below
that of its balance on that pivot: of both seated on each other for the wall, of block 2 on an upright
wall for block 2. When the wall overturns, so does what stands on it.
"""

from __future__ import annotations

import math

from models.stacked.configuration import State
from models.stacked.equation import vectors
from models.stacked.reference.impact import kinetic_energy
from models.stacked.stack import Stack

Ground = tuple[float, float]
"""a and G, in m s-2."""


def energy(stack: Stack, state: State, ground: Ground) -> float:
    """Kinetic energy and the potential of gravity and of a constant base acceleration, in J.

    The potential is 0 at the middle of the base.
    """
    a, gravity = ground
    v = vectors(stack, *state.corners, state.q, False)
    pivot = state.corners[0] * stack.base_pivot
    across = stack.mass_1 * (pivot + v.ax) + stack.mass_2 * (pivot + v.dx)
    up = stack.mass_1 * v.az + stack.mass_2 * v.dz
    return float(gravity * up + a * across) + kinetic_energy(stack, state, False)


def balance(stack: Stack, side: int, ground: Ground) -> float:
    """Potential energy (J) of both, seated on each other, balanced on the base pivot of ``side``."""
    a, gravity = ground
    arm = side * stack.base_pivot - stack.shift
    radius = math.hypot(float(arm), float(stack.centre))
    return float(stack.mass * (math.hypot(a, gravity) * radius + a * side * stack.base_pivot))


def balance_2(stack: Stack, side: int, ground: Ground) -> float:
    """Potential energy (J) of block 2 balanced on its pivot of ``side`` on an upright wall, and of the wall."""
    a, gravity = ground
    radius = math.hypot(float(side * stack.top_pivot - stack.shift_2), float(stack.centre_2))
    wall = stack.mass_1 * (gravity * stack.centre_1 + a * stack.shift_1)
    place = gravity * stack.height_1 + a * side * stack.top_pivot
    return float(wall + stack.mass_2 * (place + math.hypot(a, gravity) * radius))


def margins(stack: Stack, state: State, ground: Ground) -> tuple[float, float]:
    """For the wall and for block 2: positive once the rule after the end of shaking is fulfilled."""
    a, gravity = ground
    s1, s2 = state.sides
    v = vectors(stack, *state.corners, state.q, False)
    now = energy(stack, state, ground)
    wall = top = -math.inf
    if s1:
        moment = float(s1 * (gravity * v.ax - a * v.az))
        # dry friction could still hold it; of its couple the wall's own weight has to be the larger
        moment -= float(stack.coulomb / stack.mass_1)
        wall = min(moment, s1 * state.rate[0], balance(stack, s1, ground) - now)
    if s2:
        moment = float(s2 * (gravity * v.cx - a * v.cz))
        top = min(moment, s2 * (state.rate[0] + state.rate[1]), balance_2(stack, s2, ground) - now)
    return wall, top
