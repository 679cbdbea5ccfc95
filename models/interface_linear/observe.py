"""Observable channels from the state of many walls at once, linear as the equations are."""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.interface.layered import LayeredWall
from models.interface_linear.equation import lever

ROUNDING = 1e-12
"""A joint held at the switch (over its size) counts as pressing in full."""


def observe(wall: LayeredWall, state: FloatArray) -> dict[str, FloatArray]:
    """Observables ``(n, m)`` of states q, q' ``(n, m, 8)`` of n walls; see `declaration.OBSERVABLES`."""
    t1, t2, z1, z2, v1, v2, _, _ = np.moveaxis(state, 2, 0)

    def lane(values: FloatArray) -> FloatArray:
        return values[:, None]

    base, top = np.ones_like(t1), np.ones_like(t1)
    if wall.joints != "top":
        base = share(lane(wall.base_half_width) * np.abs(t1), z1)
    if wall.joints != "base":
        top = share(lane(wall.top_half_width) * np.abs(t2 - t1), z2)
    return {
        "rotation_1": t1,
        "rotation_2": t2,
        "rotation_rate_1": v1,
        "rotation_rate_2": v2,
        "displacement_1_x": lane(wall.centre_1) * t1,
        "displacement_2_x": lane(lever(wall)) * t1 + lane(wall.centre_2) * t2,
        "compression_base": -z1,
        "compression_top": -z2,
        "contact_1": base,
        "contact_2": top,
    }


def share(lift: FloatArray, z: FloatArray) -> FloatArray:
    """Share of a joint in contact as the model takes it: 1, 1/2 while z + b |r| > 0, 0 while z >= b |r|."""
    up = z + lift > ROUNDING * np.abs(z)
    return np.where(up, np.where(z >= lift, 0.0, 0.5), 1.0)
