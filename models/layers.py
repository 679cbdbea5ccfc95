"""Rubber layers as the next rung of a ladder of models: what a rigid base, or joint, may have to be replaced by."""

from __future__ import annotations

from typing import Any

from models.base import MechanismParameter
from models.identification import Rung

LAYER_THICKNESS = 0.01
"""m, taken where nobody has measured a layer: with linear rubber only the height of what stands on it depends on it."""
COMPRESSIONS = (5e-5, 1e-2)
"""m, static compression of a layer between which its stiffness is looked for."""
DAMPING_RATIOS = (0.005, 0.4)
GRAVITY = 9.80665


def layer_parameters(joint: str) -> tuple[MechanismParameter, MechanismParameter]:
    """Stiffness and damping ratio of the layer at ``joint``."""
    return (
        MechanismParameter(
            f"{joint}_stiffness", f"k_{joint[0]}", "N m-2", f"force per metre of contact and compression, {joint}",
            0.0, low_open=True,
        ),
        MechanismParameter(
            f"{joint}_damping_ratio", f"xi_{joint[0]}", "1", f"damping ratio at the lowest frequency, {joint} layer",
            0.0, 1.0,
        ),
    )  # fmt: skip


BASE, TOP = layer_parameters("base"), layer_parameters("top")


def layer_ranges(gravity: float | None, **loads: tuple[float, float]) -> dict[str, tuple[float, float]]:
    """Where the parameters of layers are looked for: stiffness (N m-2) and damping ratio by name.

    ``loads``: mass (kg) on the layer and its length (m), by joint; its stiffness lies between those with which the
    mass compresses it by the most and by the least of `COMPRESSIONS`.
    """
    found = {}
    for joint, (mass, length) in loads.items():
        weight = mass * (GRAVITY if gravity is None else gravity)
        least, most = COMPRESSIONS
        found[f"{joint}_stiffness"] = weight / (length * most), weight / (length * least)
        found[f"{joint}_damping_ratio"] = DAMPING_RATIOS
    return found


def compliant(**given: Any) -> Rung:
    """The rung "the base is compliant": walls on rubber layers that lift."""
    return Rung(
        name="compliant_base",
        model="interface",
        equation="N = k times the compression, integrated over the share of the joint in contact; a dashpot beside it",
        sentence="the base is compliant, a layer of {base_stiffness:.3g} N/m² with {base_damping_ratio:.1%} damping",
        **given,
    )
