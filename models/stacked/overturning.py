"""When two stacked blocks have overturned, and the energies this is judged by.

A body has overturned when its |theta| reaches pi/2; also, once the shaking has ended, when its mass
centre has passed over the pivot it stands on, it turns outwards, and the mechanical energy is below
that of its balance on that pivot: of both seated on each other for the wall, of block 2 on an upright
wall for block 2. When the wall overturns, so does what stands on it.
"""

from __future__ import annotations

import math

from models.stacked.equation import Rotations, vectors
from models.stacked.impact import kinetic_energy
from models.stacked.stack import Stack


def potential_energy(stack: Stack, s1: int, s2: int, q: Rotations, ground: Rotations) -> float:
    """In J, of gravity and of a constant base acceleration; 0 at the middle of the base."""
    a, gravity = ground
    v = vectors(stack, s1 or 1, s2 or 1, q, False)
    pivot = (s1 or 1) * stack.base_pivot
    m1, m2 = stack.mass_1, stack.mass_2
    return float(gravity * (m1 * v.az + m2 * v.dz) + a * (m1 * (pivot + v.ax) + m2 * (pivot + v.dx)))


def energy(stack: Stack, s1: int, s2: int, q: Rotations, rate: Rotations, ground: Rotations) -> float:
    """Kinetic and potential energy in J (full nonlinear form)."""
    kinetic = kinetic_energy(stack, s1, s2, q, rate, False)
    return kinetic + potential_energy(stack, s1, s2, q, ground)


def balance(stack: Stack, side: int, ground: Rotations) -> float:
    """Potential energy (J) of both, seated on each other, balanced on the base pivot of ``side``."""
    a, gravity = ground
    arm = side * stack.base_pivot - stack.shift
    radius = math.hypot(arm, stack.centre)
    return float(stack.mass * (math.hypot(a, gravity) * radius + a * side * stack.base_pivot))


def balance_2(stack: Stack, side: int, ground: Rotations) -> float:
    """Potential energy (J) of block 2 balanced on its pivot of ``side`` on an upright wall, and of the wall."""
    a, gravity = ground
    radius = math.hypot(side * stack.top_pivot - stack.shift_2, stack.centre_2)
    wall = stack.mass_1 * (gravity * stack.centre_1 + a * stack.shift_1)
    place = gravity * stack.height_1 + a * side * stack.top_pivot
    return float(wall + stack.mass_2 * (place + math.hypot(a, gravity) * radius))


def margins(
    stack: Stack, s1: int, s2: int, q: Rotations, rate: Rotations, ground: Rotations
) -> tuple[float, float]:
    """For the wall and for block 2: positive once the rule after the end of shaking is fulfilled."""
    a, gravity = ground
    v = vectors(stack, s1 or 1, s2 or 1, q, False)
    now = energy(stack, s1, s2, q, rate, ground)
    wall = top = -math.inf
    if s1:
        moment = s1 * (gravity * v.ax - a * v.az)
        wall = min(moment, s1 * rate[0], balance(stack, s1, ground) - now)
    if s2:
        moment = s2 * (gravity * v.cx - a * v.cz)
        top = min(moment, s2 * (rate[0] + rate[1]), balance_2(stack, s2, ground) - now)
    return float(wall), float(top)
