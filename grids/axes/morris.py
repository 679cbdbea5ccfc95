"""Trajectories for Morris screening: ``{ morris = 20, seed = 1, parameters = {...} }``.

``morris`` trajectories of D + 1 points on 4 levels (Morris, Technometrics 33, 1991). The levels are the quantiles
1/8, 3/8, 5/8, 7/8 of each distribution, so that unbounded ones have no infinite level. Beside words there are as many
more as give every word the same number of levels: on 4 levels, the third of five words would never be drawn.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from grids.axes.base import Axis, AxisKind, Request
from grids.axes.distributions import Shares
from grids.axes.sample import BESIDE, read_sample

FEWEST = 4


def levels(choices: Sequence[int]) -> int:
    """The least even number of levels, from 4 on, that is a multiple of each number of words."""
    step = math.lcm(2, *(count for count in choices if count))
    return step * math.ceil(FEWEST / step)


def draw(choices: Sequence[int], count: int, seed: int) -> Shares:
    """Points ``(count (D + 1), D)`` of D parameters, trajectory by trajectory."""
    import SALib.sample.morris

    dimensions, steps = len(choices), levels(choices)
    problem = {"num_vars": dimensions, "names": [str(k) for k in range(dimensions)], "bounds": [[0, 1]] * dimensions}
    points = SALib.sample.morris.sample(problem, count, num_levels=steps, seed=seed)
    return np.asarray((np.rint(points * (steps - 1)) + 0.5) / steps)


def _read(request: Request) -> Axis:
    return read_sample(request, "morris", draw, least=2, design=True)


KIND = AxisKind("morris", BESIDE, _read)
