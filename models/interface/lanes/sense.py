"""Runs whose numbers have no sense, or were taken in steps too coarse for the rubber."""

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
BEYOND = 1.15
"""Times the compression that a layer cannot reach."""
SAME_EDGE, SAME_TIME = 0.15, 0.1
"""Of two runs in different steps: compressions, over what cannot be reached, and instants of overturning (s)."""


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


def pressed(wall: LayeredWall, table: FloatArray) -> NDArray[np.bool_]:
    """Lanes (n,) of which an edge was compressed by more than `BEYOND` what a law of its layer can be.

    Rubber that locks stiffens so steeply that a step sized for the wall at rest may throw it into the lock, from where
    it comes back with energy that nothing has given. Shaken hard, layers with a low lock strain go as far in any step,
    for the law goes on along its tangent; and so does every edge on which a wall has fallen.
    """
    return _compressed(wall, table) > BEYOND


def agree(wall: LayeredWall, coarse: FloatArray, fine: FloatArray, within: float) -> NDArray[np.bool_]:
    """Lanes (n,) whose runs in two steps overturn the same bodies ``within`` some time (s) or, if none, press alike."""
    first, second = (table[:, [r.R_OVER_1, r.R_OVER_2]] for table in (coarse, fine))
    upright = np.isnan(first) & np.isnan(second)
    together = np.abs(first - second) <= within
    alike = np.abs(_compressed(wall, coarse) - _compressed(wall, fine)) <= SAME_EDGE
    return np.asarray(np.all(upright | together, axis=1) & (alike | ~np.all(upright, axis=1)))


def _compressed(wall: LayeredWall, table: FloatArray) -> FloatArray:
    """Largest compression of an edge over what a law of its layer can be (n,); 0 where no law has a limit."""
    found = np.zeros(wall.size)
    for joint, column in (("base", r.R_EDGE_B), ("top", r.R_EDGE_T)):
        for law, p in wall.laws_at(joint) if joint in wall.rubber_joints else ():
            found = np.fmax(found, table[:, column] / law.limit(p))
    return found
