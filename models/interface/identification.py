"""What a diagnosis needs to know of walls on rubber layers that lift: rotations lead, the rest is carried."""

from __future__ import annotations

import numpy as np

from models.identification import Exposure, Force, Identification, Lead, Port, State, WindowLengths
from models.interface.layered import FREE, LayeredWall
from models.unknown_forces import DEPENDENCES, PHASES, couples, over_largest_base, over_largest_rate, over_reach

PROPERTIES = ("stiffness", "layer_modulus", "damping", "damping_ratio")


def _of_layer(joint: str) -> tuple[Exposure, Exposure]:
    """What may have changed the layer of a joint, both layers where ``joint`` is empty."""
    before, after = (f"{joint}_", f"_{joint}") if joint else ("", "")
    of = tuple(f"{before}{name}" for name in PROPERTIES)
    which = f"the {joint} layer" if joint else "either layer"
    return (
        Exposure("strain", f"largest strain of {which} so far", f"peak_strain{after}", of),
        Exposure("closings", f"closings of {which} so far", f"impacts{after}", of, summed=True),
    )


def _jumps(wall: LayeredWall, couple_1: float, couple_2: float) -> dict[str, float]:
    """Jumps of both angular velocities by an impulse that resists, of the generalised forces given, upright.

    Bodies that a bonded joint ties together turn as one, and what it ties to the ground stays.
    """
    height = float((wall.height_1 + wall.top_thickness_in_height).item())
    m2, h2 = float(wall.mass_2.item()), float(wall.centre_2.item())
    lower = float((wall.inertia_1 + wall.mass_1 * wall.centre_1**2).item()) + m2 * height**2
    mass = np.array([[lower, m2 * height * h2], [m2 * height * h2, float(wall.inertia_2.item()) + m2 * h2**2]])
    free = FREE[wall.joints][:2, :]
    free = free[:, np.any(free != 0.0, axis=0)]
    jumps = -free @ np.linalg.solve(free.T @ mass @ free, free.T @ [couple_1, couple_2])
    return {"rotation_rate_1": float(jumps[0]), "rotation_rate_2": float(jumps[1])}


def _on_the_block(wall: LayeredWall) -> dict[str, float]:
    height = float((wall.height_1 + wall.top_thickness_in_height).item())
    return _jumps(wall, height, float(wall.centre_2.item()))


BASE = Port("base", lambda seen: seen["rotation_1"], lambda wall, at: _jumps(wall, 1.0, 0.0))
TOP = Port("top", lambda seen: seen["rotation_2"] - seen["rotation_1"], lambda wall, at: _jumps(wall, -1.0, 1.0))
BLOCK = Port("block", lambda seen: seen["displacement_2_x"], lambda wall, at: _on_the_block(wall))
"""A couple in either joint (N m s), a horizontal force on the upper block (N s)."""


FORCES = (
    *couples(BASE, where=" in the base"),
    *couples(TOP, "_top", " in the top joint"),
    Force("viscous_damping_block", "force on the upper block with its velocity", BLOCK, over_largest_rate),
    Force("stiffness_block", "force on the upper block with its displacement", BLOCK, over_reach),
    Force("base_motion", "force on the upper block with the base acceleration", BLOCK, over_largest_base),
)

IDENTIFICATION = Identification(
    leads=(Lead("rotation_1", 1, "base"), Lead("rotation_2", 2, "top")),
    states=(
        State("rotation_1", "rotation_1"),
        State("rotation_2", "rotation_2"),
        State("displacement_z_1", at_rest=lambda d: -d["static_compression_base"]),
        State("displacement_z_2", at_rest=lambda d: -d["static_compression_top"]),
        State("rotation_rate_1", "rotation_1", rate=True),
        State("rotation_rate_2", "rotation_2", rate=True),
        State("velocity_z_1"),
        State("velocity_z_2"),
    ),
    windows=WindowLengths(
        shortest=0.8,
        aim=1.5,
        longest=3.0,
        quiet=1.0,
        smoothing=0.1,
        carrying=0.13,
        unit=lambda d: 1.0 / d["frequency_1"],
    ),
    chaotic=False,
    elastic=True,
    coordinates=("base_stiffness", "top_stiffness", "layer_modulus", "base_layer_modulus", "top_layer_modulus"),
    whole={"bouc_wen.exponent": (1.0, 2.0)},
    carrying=True,
    forces=FORCES,
    dependences=DEPENDENCES,
    phases=PHASES,
    exposures=(*_of_layer("base"), *_of_layer("top"), *_of_layer("")),
)
