"""The corners are rounded and roll on the base."""

from __future__ import annotations

from models.base import Mechanism, MechanismParameter, Values
from models.housner.block import Block


def on_housner(block: Block, values: Values) -> Block:
    return block.replace(corner_radius=values["radius_over_half_width"] * block.base_half_width)


MECHANISM = Mechanism(
    name="rounded_corner",
    effect_class="contact_geometry",
    parameters=(
        MechanismParameter(
            "radius_over_half_width", "rho/b", "1", "radius of the corners over the half width", 0.0, 0.3
        ),
    ),
    equation="X_theta = rho + s (b - rho) sin + (h - rho) cos, Z_theta = s (b - rho) cos - (h - rho) sin",
    signature="grows with |theta|; the onset comes earlier",
    sentence="the corners are rounded to {radius_over_half_width:.1%} of the half width and roll",
    acts={"housner": on_housner},
    static_test="push the block over slowly and read force over rotation",
    source="Lagrange's equation of a body rolling on arcs: models/housner/reference/equation.py",
)
