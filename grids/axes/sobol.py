"""A scrambled Sobol sample; doubling the count keeps the points that are there.

Sobol (USSR Comput. Math. Math. Phys. 7, 1967), scrambled after Owen.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from grids.axes.base import Axis, AxisKind, Request, count
from grids.axes.sample import BESIDE, read_sample
from models.errors import InputError


def _draw(choices: Sequence[int], count: int, seed: int) -> Any:
    from scipy.stats import qmc

    return qmc.Sobol(len(choices), scramble=True, seed=seed).random(count)


def check_power_of_two(request: Request, key: str) -> None:
    """Raise InputError for a count that is none."""
    size = count(request.table[key], 1, f"{request.where} {key}")
    if size & (size - 1):
        below = 1 << (size.bit_length() - 1)
        raise InputError(
            f"{request.where}: {key} = {size} is no power of two, without which the sample loses its "
            f"balance; give {below} or {2 * below}."
        )


def _read(request: Request) -> Axis:
    check_power_of_two(request, "sobol")
    return read_sample(request, "sobol", _draw)


KIND = AxisKind("sobol", BESIDE, _read)
