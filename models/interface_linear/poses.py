"""Where the wall and the block on top are, for `models.kinematics`."""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.interface.layered import LayeredWall
from models.interface.poses import of_bodies
from models.interface_linear.equation import lever
from models.interface_linear.equation import rest as of_rest
from models.observed import Observed


def poses(wall: LayeredWall, state: FloatArray) -> Observed:
    """Poses ``(n, m)`` of the wall and of the block for `Model.poses`, counted from rest under their own weight."""
    t1, _, z1, z2 = np.moveaxis(state[:, :, :4], 2, 0)
    level = lever(wall)[:, None]

    def rest(coordinate: int) -> FloatArray:
        return np.asarray(of_rest(wall)[:, coordinate, None])

    return Observed(
        {
            "underside_1_x": lambda: np.zeros_like(t1),
            "underside_1_z": lambda: z1 - rest(2),
            "underside_1_height": lambda: np.zeros_like(t1),
            "underside_2_x": lambda: level * t1,
            "underside_2_z": lambda: z1 + z2 - rest(2) - rest(3),
            "underside_2_height": lambda: level + rest(3) + 0.0 * t1,
            **of_bodies(wall, t1),
        }
    )
