"""The catalogue of physics that a base model may leave out, one file a mechanism."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import Any, TypeVar

from models.base import Mechanism, Values
from models.errors import InputError, nearest
from models.mechanisms import (
    added_stiffness,
    bonded_layer,
    bounce,
    contact_length,
    coulomb_damping,
    crushing,
    degradation,
    eccentricity,
    flexible_joint,
    interface_shear,
    one_sided_stiffness,
    payne,
    pivot_inset,
    quadratic_damping,
    restitution,
    rounded_corner,
    sliding,
    table_force,
    table_pitch,
    tilt,
    velocity_restitution,
    vertical_acceleration,
    viscous_damping,
    wall_flexibility,
)
from models.rubber import ELEMENTS

MECHANISMS: tuple[Mechanism, ...] = (
    vertical_acceleration.MECHANISM,
    sliding.MECHANISM,
    pivot_inset.MECHANISM,
    rounded_corner.MECHANISM,
    crushing.MECHANISM,
    tilt.MECHANISM,
    eccentricity.MECHANISM,
    eccentricity.OF_TOP_MASS,
    flexible_joint.MECHANISM,
    contact_length.MECHANISM,
    added_stiffness.MECHANISM,
    added_stiffness.OF_WALL,
    one_sided_stiffness.MECHANISM,
    table_pitch.MECHANISM,
    restitution.MECHANISM,
    velocity_restitution.MECHANISM,
    bounce.MECHANISM,
    viscous_damping.MECHANISM,
    viscous_damping.OF_WALL,
    coulomb_damping.MECHANISM,
    quadratic_damping.MECHANISM,
    degradation.MECHANISM,
    degradation.OF_RUBBER,
    *(law.mechanism for law in ELEMENTS.values()),
    payne.MECHANISM,
    interface_shear.MECHANISM,
    bonded_layer.MECHANISM,
    wall_flexibility.MECHANISM,
    wall_flexibility.OF_TWO_HALVES,
    table_force.MECHANISM,
    table_force.OF_WALL,
)
"""In the order in which they act on a model's coefficients; one name stands twice where its equation has other
parameters on other models."""

Coefficients = TypeVar("Coefficients")


@cache
def acting_on(model: str) -> Mapping[str, Mechanism]:
    """The mechanisms that act on ``model``, by name."""
    return MappingProxyType({mechanism.name: mechanism for mechanism in MECHANISMS if model in mechanism.acts})


@cache
def names_on(model: str) -> frozenset[str]:
    """All that values may switch on in a model, as ``mechanism.parameter``."""
    return frozenset(f"{one.name}.{p.name}" for one in acting_on(model).values() for p in one.addressable(model))


def applied(model: str, coefficients: Coefficients, values: Values) -> Coefficients:
    """What the mechanisms that ``values`` switch on (as ``mechanism.parameter``) make of a model's coefficients."""
    switched: dict[str, dict[str, Any]] = {}
    for key, value in values.items():
        mechanism, dot, parameter = key.partition(".")
        if dot:
            switched.setdefault(mechanism, {})[parameter] = value
    acting = acting_on(model)
    for name in switched:
        if name not in acting:
            raise InputError(f"the mechanism {name} does not act on the model {model}: leave it out")
        for parameter in switched[name]:
            if f"{name}.{parameter}" not in names_on(model):
                known = [p.name for p in acting[name].addressable(model)]
                raise InputError(f"the mechanism {name} has no parameter '{parameter}'; {nearest(parameter, known)}")
    for name, form in acting.items():
        if name in switched:
            coefficients = form.acts[model](coefficients, {**form.nulls, **switched[name]})
    return coefficients
