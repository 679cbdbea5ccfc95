"""From the parameters a user gives to the coefficients of walls on layers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from models.base import FloatArray, Values
from models.errors import InputError
from models.interface import modes
from models.interface.layered import LayeredWall
from models.rubber import LAWS
from models.walls import bodies, lanes_shape

JOINTS = ("base", "top")
OF_THE_BASE = frozenset({
    "sliding", "one_sided_stiffness", "degradation", "bonded_layer", "wall_flexibility", "added_stiffness",
    "viscous_damping", "coulomb_damping",
})  # fmt: skip
"""Mechanisms whose forces act between the wall and its base."""


def assemble(values: Values, options: Mapping[str, str], vertical: bool, size: int | None = None) -> LayeredWall:
    """The walls of the parameters alone, without mechanisms; ``values`` broadcast to ``(n,)``.

    k = modulus x wall thickness / layer thickness, and from a damping ratio xi the dashpot
    c = 2 xi k/omega_1, omega_1 the lowest circular frequency at rest, gravity included.
    """
    joints = options["joints"]
    with_rubber = JOINTS if joints == "both" else (joints,)
    shape = lanes_shape(values, size)
    two = bodies(values, size)
    zero = np.zeros(shape)

    def value(name: str) -> FloatArray:
        return np.broadcast_to(np.asarray(values[name], dtype=np.float64), shape).copy()

    def at_joint(name: str, joint: str) -> FloatArray | None:
        """A layer's quantity at one joint: under its own name, else under the one for both."""
        for key in (f"{joint}_{name}", name):
            if key in values:
                return value(key)
        return None

    thickness: dict[str, FloatArray] = dict.fromkeys(JOINTS, zero)
    stiffness: dict[str, FloatArray] = dict.fromkeys(JOINTS, zero)
    for joint in with_rubber:
        thickness[joint] = _needed(at_joint("layer_thickness", joint), joint, "layer_thickness")
        given = at_joint("stiffness", joint)
        if given is None:
            modulus = _needed(at_joint("layer_modulus", joint), joint, "layer_modulus")
            if "wall_thickness" not in values:
                raise InputError(
                    f"the modulus of the {joint} layer needs wall_thickness (m): give it, or {joint}_stiffness (N m-2)"
                )
            given = modulus * value("wall_thickness") / thickness[joint]
        stiffness[joint] = given
    wall = LayeredWall(
        mass_1=two.mass_1,
        inertia_1=two.inertia_1,
        centre_1=two.half_height_1,
        height_1=2.0 * two.half_height_1,
        mass_2=two.mass_2,
        inertia_2=two.inertia_2,
        centre_2=two.half_height_2,
        top_thickness_in_height=thickness["top"],
        base_half_width=two.half_length_1,
        top_half_width=two.half_joint,
        base_stiffness=stiffness["base"],
        top_stiffness=stiffness["top"],
        base_damping=zero,
        top_damping=zero,
        base_thickness=thickness["base"],
        top_thickness=thickness["top"],
        gravity=two.gravity,
        offset=zero,
        vertical_factor=np.ones(shape) if vertical else zero,
        joints=joints,
        toe_held=options["kinematics"] == "toe_held",
        clip=options["dashpot"] == "B",
    )
    damping = {joint: at_joint("damping", joint) for joint in with_rubber}
    if any(c is None for c in damping.values()):
        lowest = modes.at_rest(wall).squares[:, 0]
        with np.errstate(invalid="ignore"):
            omega = np.sqrt(lowest)
        for joint in with_rubber:
            if damping[joint] is None:
                ratio = _needed(at_joint("damping_ratio", joint), joint, "damping_ratio")
                damping[joint] = 2.0 * ratio * stiffness[joint] / omega
    changes: dict[str, Any] = {f"{joint}_damping": c for joint, c in damping.items()}
    return wall.replace(**changes)


def _needed(found: FloatArray | None, joint: str, name: str) -> FloatArray:
    if found is None:
        other = "top" if joint == "base" else "base"
        raise InputError(
            f"the {joint} layer has no {name}: give {name} (both layers) or {joint}_{name}; "
            f"if there is no rubber at the {joint}, set joints = '{other}' in [options]"
        )
    return found


def complete(wall: LayeredWall, options: Mapping[str, str]) -> LayeredWall:
    """The walls with the rubber laws that ``options`` name; raises InputError for what does not go together."""
    for joint in wall.rubber_joints:
        option = f"{joint}_rubber_law"
        word = options["rubber_law"] if options[option] == "same" else options[option]
        if word == "as_given":
            continue
        if word != "linear" and not any(key.startswith(f"{word}.") for key in wall.laws):
            raise InputError(f"the rubber law of the {joint} layer is {word}; give {word}.{LAWS[word].parameters[0]}")
        wall = wall.only_law(joint, word)
    if wall.effects is not None and np.any(np.isfinite(wall.effects.friction) & np.isfinite(wall.effects.shear_base)):
        raise InputError(
            "sliding and interface_shear both give way along the base and do not act together: leave one out, or give "
            "interface_shear.shear_over_normal_top alone"
        )
    frozen = wall.effects is not None and np.any(wall.effects.frozen_base + wall.effects.frozen_top)
    if frozen and any(wall.laws_at(joint) for joint in wall.rubber_joints):
        raise InputError(
            "contact_length mixes the contact with the frozen one of linear rubber: leave the rubber's law out, or it"
        )
    if wall.effects is not None and wall.joints == "top" and (lost := OF_THE_BASE & set(wall.effects.parts)):
        raise InputError(
            f"{', '.join(sorted(lost))} acts on the rubber of the base, and joints = 'top' has none there: leave it out"
        )
    for joint in wall.rubber_joints:
        for law, p in wall.laws_at(joint):
            if refused := law.refusal(p):
                raise InputError(f"in the {joint} layer {law.name}.{refused}")
    return wall
