"""What bounds the motion of a passive body, to tell runs that diverged."""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.runs import Request

CREATED = 0.1
"""Share of the energy in reach that a run may seem to gain without work: far above what steps leave."""


def impulse(request: Request) -> FloatArray:
    """Scale times the integral of |a| + |a_z| over the shaking (n,) in m s-1: the velocity that it can give."""
    shaking = request.shaking
    size = np.abs(shaking.horizontal) + (0.0 if shaking.vertical is None else np.abs(shaking.vertical))
    return np.asarray(np.abs(request.scale) * size.sum() * shaking.time_step)
