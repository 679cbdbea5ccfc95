"""The sample from which Sobol indices are computed: ``{ saltelli = 256, seed = 1, parameters = {...} }``.

2 (D + 1) points for each of ``saltelli`` base points of D parameters (Saltelli, Comput. Phys. Comm. 145, 2002), the
base points a scrambled Sobol sequence; doubling the count keeps the points that are there.
"""

from __future__ import annotations

from collections.abc import Sequence

from grids.axes.base import Axis, AxisKind, Request
from grids.axes.distributions import Shares
from grids.axes.sample import BESIDE, read_sample
from grids.axes.sobol import check_power_of_two
from models.errors import InputError


def draw(choices: Sequence[int], count: int, seed: int) -> Shares:
    """Points ``(count (2 D + 2), D)`` of D parameters, in the order that SALib takes them in."""
    import SALib.sample.sobol

    dimensions = len(choices)
    problem = {"num_vars": dimensions, "names": [str(k) for k in range(dimensions)], "bounds": [[0, 1]] * dimensions}
    points: Shares = SALib.sample.sobol.sample(problem, count, calc_second_order=True, seed=seed)
    return points


def _read(request: Request) -> Axis:
    check_power_of_two(request, "saltelli")
    table = request.table.get("parameters")
    if isinstance(table, dict) and len(request.targets.flatten(table)) < 2:
        raise InputError(f"{request.where}: Sobol indices tell parameters apart; give at least two in parameters.")
    return read_sample(request, "saltelli", draw, least=2, design=True)


KIND = AxisKind("saltelli", BESIDE, _read)
