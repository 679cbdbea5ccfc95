"""The first bending mode of a wall clamped at its base, and what it needs of the masses.

The shape is that of a uniform cantilever of height H, 1 at the top, beta = 1.8751 its first root:

    phi(x) = 1/2 [cosh(beta x) - cos(beta x) - sigma (sinh(beta x) - sin(beta x))],   x = z/H

For the wall: integral of phi^2 = m1/4, of phi = sigma/beta m1, of phi z = m1 H/beta^2. A mass on top moves with
1 + phi'(1) h2/H and turns with phi'(1)/H. Validity: the shape stays that of the uniform wall with a mass on
top too; the integrals of the wall then differ by up to 6 % from those of the static shape under a load at the
top. The inertia of the wall's sections against turning is left out.
"""

from __future__ import annotations

import math

from models.base import FloatArray

BETA = 1.8751040687119611
SIGMA = (math.cosh(BETA) + math.cos(BETA)) / (math.sinh(BETA) + math.sin(BETA))
STRUCTURAL_DAMPING = 0.02
"""Ratio of the mode's damping to critical, clamped: usual for masonry that does not crack."""
TOP_SLOPE = 0.5 * BETA * (math.sinh(BETA) + math.sin(BETA) - SIGMA * (math.cosh(BETA) - math.cos(BETA)))


def modal_integrals(
    mass: FloatArray, height: FloatArray, top_mass: FloatArray, top_height: FloatArray, top_inertia: FloatArray
) -> dict[str, FloatArray]:
    """Integrals over the mass of phi^2 (kg), phi (kg) and phi z (kg m), arrays ``(n,)``.

    ``height`` is that of the wall, ``top_height`` that of the top mass's centre above it.
    """
    top = 1.0 + TOP_SLOPE * top_height / height
    turn = TOP_SLOPE / height
    return {
        "modal_mass": 0.25 * mass + top_mass * top**2 + top_inertia * turn**2,
        "modal_force": SIGMA / BETA * mass + top_mass * top,
        "modal_moment": mass * height / BETA**2 + top_mass * top * (height + top_height) + top_inertia * turn,
    }
