"""Trajectories for Morris screening: ``{ morris = 20, seed = 1, parameters = {...} }``.

``morris`` trajectories of D + 1 points on 4 levels (Morris, Technometrics 33, 1991). The levels are the quantiles
1/8, 3/8, 5/8, 7/8 of each distribution, so that unbounded ones have no infinite level.
"""

from __future__ import annotations

import numpy as np

from grids.axes.base import Axis, AxisKind, Request
from grids.axes.distributions import Shares
from grids.axes.sample import BESIDE, read_sample

LEVELS = 4


def draw(dimensions: int, count: int, seed: int) -> Shares:
    """Points ``(count (dimensions + 1), dimensions)``, trajectory by trajectory."""
    import SALib.sample.morris

    problem = {"num_vars": dimensions, "names": [str(k) for k in range(dimensions)], "bounds": [[0, 1]] * dimensions}
    points = SALib.sample.morris.sample(problem, count, num_levels=LEVELS, seed=seed)
    return np.asarray((np.rint(points * (LEVELS - 1)) + 0.5) / LEVELS)


def _read(request: Request) -> Axis:
    return read_sample(request, "morris", draw, least=2, design=True)


KIND = AxisKind("morris", BESIDE, _read)
