"""Where the wall and the block on top are, for `models.kinematics`."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from models.base import FloatArray
from models.interface.layered import LayeredWall
from models.interface.modes import static_state
from models.observed import Observed
from models.placing import masses


def poses(wall: LayeredWall, state: FloatArray) -> Observed:
    """Poses ``(n, m)`` of the wall and of the block for `Model.poses`, counted from rest under their own weight."""
    t1, t2, z1, z2 = np.moveaxis(state[:, :, :4], 2, 0)
    x1 = x2 = np.zeros_like(t1)
    if wall.effects is not None and state.shape[2] == 16:
        x1, x2 = np.moveaxis(state[:, :, 8:10], 2, 0)
    toe = 1.0 if wall.toe_held else 0.0

    def lane(values: FloatArray) -> FloatArray:
        return values[:, None]

    def rest(coordinate: int) -> FloatArray:
        return lane(static_state(wall)[:, coordinate])

    def foot() -> FloatArray:
        return np.asarray(x1 + toe * np.sign(t1) * lane(wall.base_half_width) * (1.0 - np.cos(t1)))

    def joint() -> tuple[FloatArray, FloatArray]:
        turn = t2 - t1
        along = x2 + toe * np.sign(turn) * lane(wall.top_half_width) * (1.0 - np.cos(turn))
        return along, lane(wall.height_1 + wall.top_thickness_in_height) + z2

    def block_x() -> FloatArray:
        along, upper = joint()
        return np.asarray(foot() + along * np.cos(t1) + upper * np.sin(t1))

    def block_z() -> FloatArray:
        along, upper = joint()
        level = lane(wall.height_1 + wall.top_thickness_in_height) + rest(3)
        return np.asarray(z1 - rest(2) - along * np.sin(t1) + upper * np.cos(t1) - level)

    return Observed(
        {
            "underside_1_x": foot,
            "underside_1_z": lambda: z1 - rest(2),
            "underside_1_height": lambda: np.zeros_like(t1),
            "underside_2_x": block_x,
            "underside_2_z": block_z,
            "underside_2_height": lambda: lane(wall.height_1 + wall.top_thickness_in_height) + rest(3) + 0.0 * t1,
            **of_bodies(wall, t1),
        }
    )


def of_bodies(wall: LayeredWall, like: FloatArray) -> dict[str, Callable[[], FloatArray]]:
    """Masses and mass centres of both bodies for `Model.poses`, in the shape of ``like`` (n, m)."""
    middle = np.zeros(wall.size)
    beside = middle if wall.effects is None else wall.effects.top_offset
    return masses(like, (wall.mass_1, middle, wall.centre_1), (wall.mass_2, beside, wall.centre_2))
