"""The catalogue of physics that a base model may leave out, one file a mechanism."""

from __future__ import annotations

from models.base import Mechanism
from models.mechanisms import (
    added_stiffness,
    bouc_wen,
    bounce,
    coulomb_damping,
    crushing,
    degradation,
    eccentricity,
    flexible_joint,
    hardening,
    maxwell,
    mullins,
    payne,
    permanent_set,
    pivot_inset,
    quadratic_damping,
    restitution,
    rounded_corner,
    sliding,
    table_pitch,
    tilt,
    velocity_restitution,
    vertical_acceleration,
    viscous_damping,
    wall_flexibility,
)

MECHANISMS: dict[str, Mechanism] = {
    module.MECHANISM.name: module.MECHANISM
    for module in (
        vertical_acceleration,
        sliding,
        pivot_inset,
        rounded_corner,
        crushing,
        tilt,
        eccentricity,
        flexible_joint,
        added_stiffness,
        table_pitch,
        restitution,
        velocity_restitution,
        bounce,
        viscous_damping,
        coulomb_damping,
        quadratic_damping,
        degradation,
        hardening,
        maxwell,
        bouc_wen,
        mullins,
        permanent_set,
        payne,
        wall_flexibility,
    )
}
"""In the order in which they act on a model's coefficients."""


def acting_on(model: str) -> dict[str, Mechanism]:
    """The mechanisms that act on ``model``, in the form that they have there."""
    found = {name: mechanism.on(model) for name, mechanism in MECHANISMS.items()}
    return {name: form for name, form in found.items() if form is not None}
