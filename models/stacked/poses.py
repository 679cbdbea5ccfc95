"""Where both blocks are, for `models.kinematics`."""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.observed import Observed
from models.stacked.stack import Stack


def poses(stack: Stack, trace: FloatArray) -> Observed:
    """Poses ``(n, samples)`` of both blocks for `Model.poses`.

    A pivot p of a body in its own axes, now at P, puts the middle of its underside at P - Rot(theta) p.
    """
    q1, q2 = np.moveaxis(trace[..., :2], -1, 0)
    base = np.where(q1 >= 0.0, 1.0, -1.0) * stack.base_pivot[:, None]
    top = np.where(q2 >= 0.0, 1.0, -1.0) * stack.top_pivot[:, None]
    height, both = stack.height_1[:, None], q1 + q2

    def lane(values: FloatArray) -> FloatArray:
        return np.asarray(values[:, None] + np.zeros_like(q1))

    return Observed(
        {
            "underside_1_x": lambda: base * (1.0 - np.cos(q1)),
            "underside_1_z": lambda: base * np.sin(q1),
            "underside_1_height": lambda: np.zeros_like(q1),
            # the middle of the base, the joint's pivot seen from there, the middle of the block seen from the pivot
            "underside_2_x": lambda: (
                base * (1.0 - np.cos(q1)) + top * np.cos(q1) + height * np.sin(q1) - top * np.cos(both)
            ),
            "underside_2_z": lambda: (
                base * np.sin(q1) - top * np.sin(q1) + height * (np.cos(q1) - 1.0) + top * np.sin(both)
            ),
            "underside_2_height": lambda: height + np.zeros_like(q1),
            "mass_1": lambda: lane(stack.mass_1),
            "centre_1_x": lambda: lane(stack.shift_1),
            "centre_1_z": lambda: lane(stack.centre_1),
            "mass_2": lambda: lane(stack.mass_2),
            "centre_2_x": lambda: lane(stack.shift_2),
            "centre_2_z": lambda: lane(stack.centre_2),
        }
    )
