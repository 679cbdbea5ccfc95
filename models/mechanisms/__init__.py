"""The catalogue of physics that a base model may leave out, one file a mechanism."""

from __future__ import annotations

from typing import Any, TypeVar

from models.base import Mechanism, Values
from models.errors import InputError
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

Coefficients = TypeVar("Coefficients")


def acting_on(model: str) -> dict[str, Mechanism]:
    """The mechanisms that act on ``model``, in the form that they have there."""
    found = {name: mechanism.on(model) for name, mechanism in MECHANISMS.items()}
    return {name: form for name, form in found.items() if form is not None}


def applied(model: str, coefficients: Coefficients, values: Values) -> Coefficients:
    """What the mechanisms that ``values`` switch on (as ``mechanism.parameter``) make of a model's coefficients."""
    switched: dict[str, dict[str, Any]] = {}
    for key, value in values.items():
        mechanism, dot, parameter = key.partition(".")
        if dot:
            switched.setdefault(mechanism, {})[parameter] = value
    for name in MECHANISMS:
        if name in switched:
            form = MECHANISMS[name].on(model)
            if form is None:
                raise InputError(f"the mechanism {name} does not act on the model {model}: leave it out")
            coefficients = form.acts[model](coefficients, {**form.nulls, **switched[name]})
    return coefficients
