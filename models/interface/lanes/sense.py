"""Runs whose numbers have no sense."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray
from models.interface.lanes import rows as r
from models.interface.layered import LayeredWall
from models.lanes.sense import CREATED, impulse
from models.runs import Request

SIZES = 10.0
"""Of the wall, by which no layer opens or is compressed."""


def diverged(wall: LayeredWall, request: Request, table: FloatArray) -> NDArray[np.bool_]:
    """Lanes (n,) of the results ``table`` that are not numbers, far too large, or have gained energy without work.

    In reach is m v^2/2 of the shaking's impulse, and the weight times half the width of the base, more than lifts a
    wall onto its toe. Of walls that overturned only sizes are asked.
    """
    places = table[:, [r.R_END_Z1, r.R_END_Z2, r.R_EDGE_B, r.R_EDGE_T]]
    size = SIZES * (wall.height_1 + wall.base_half_width)
    reach = wall.mass * (
        0.5 * impulse(request) ** 2 + wall.gravity * np.maximum(wall.base_half_width, wall.top_half_width)
    )
    over = ~np.isnan(table[:, [r.R_OVER_1, r.R_OVER_2]]).all(axis=1)
    sound = over | (table[:, [r.R_LOST_B, r.R_LOST_T]].sum(axis=1) >= -CREATED * reach)
    return np.asarray(~(np.all(np.abs(places) <= size[:, None], axis=1) & sound))
