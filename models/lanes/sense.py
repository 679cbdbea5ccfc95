"""What bounds the motion of a passive body, to tell runs that diverged."""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.runs import Request

CREATED = 0.1
"""Share of the energy in reach that a run may seem to gain without work: far above what steps leave."""


def impulse(request: Request) -> FloatArray:
    """Scale times the integral of |a| + |a_z| over the shaking (n,) in m s-1: the velocity that it can give."""
    sizes = [
        np.abs(one.horizontal).sum() + (0.0 if one.vertical is None else np.abs(one.vertical).sum())
        for one in request.shakings.each
    ]
    return np.asarray(np.abs(request.scale) * np.array(sizes)[request.shakings.of] * request.shaking.time_step)
