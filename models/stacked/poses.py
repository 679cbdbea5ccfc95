"""Where both blocks are, for `models.kinematics`."""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.observed import Observed
from models.placing import masses
from models.stacked.stack import Stack


def poses(stack: Stack, trace: FloatArray) -> Observed:
    """Poses ``(n, samples)`` of both blocks for `Model.poses`.

    A pivot p of a body in its own axes, now at P, puts the middle of its underside at P - Rot(theta) p.
    """
    q1, q2 = np.moveaxis(trace[..., :2], -1, 0)
    base = np.where(q1 >= 0.0, 1.0, -1.0) * stack.base_pivot[:, None]
    top = np.where(q2 >= 0.0, 1.0, -1.0) * stack.top_pivot[:, None]
    height, both = stack.height_1[:, None], q1 + q2

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
            **masses(q1, (stack.mass_1, stack.shift_1, stack.centre_1), (stack.mass_2, stack.shift_2, stack.centre_2)),
        }
    )
