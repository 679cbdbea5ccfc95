"""A scrambled Sobol sample; doubling the count keeps the points that are there.

Sobol (USSR Comput. Math. Math. Phys. 7, 1967), scrambled after Owen.
"""

from __future__ import annotations

from typing import Any

from grids.axes.base import Axis, AxisKind, Request, count
from grids.axes.sample import BESIDE, read_sample
from models.errors import InputError


def _draw(dimensions: int, count: int, seed: int) -> Any:
    from scipy.stats import qmc

    return qmc.Sobol(dimensions, scramble=True, seed=seed).random(count)


def _read(request: Request) -> Axis:
    size = count(request.table["sobol"], 1, f"{request.where} sobol")
    if size & (size - 1):
        below = 1 << (size.bit_length() - 1)
        raise InputError(
            f"{request.where}: sobol = {size} is no power of two, without which the sample loses its "
            f"balance; give {below} or {2 * below}."
        )
    return read_sample(request, "sobol", _draw)


KIND = AxisKind("sobol", BESIDE, _read)
