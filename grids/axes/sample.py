"""What all samples share: several parameters drawn together.

``{ <kind> = count, seed = 1, parameters = { width = ["0.2 m", "0.5 m"], layer_modulus = { range = [1, 20],
unit = "MPa", spacing = "log" }, restitution = { normal = [0.9, 0.02], truncated = [0.8, 1] } } }``; the distributions
stand in `grids.axes.distributions`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from grids.axes.base import Axis, Design, Request, count
from grids.axes.distributions import Shares, read_distribution
from models.errors import InputError

BESIDE = ("seed", "parameters")
Draw = Callable[[Sequence[int], int, int], Shares]


def read_sample(request: Request, key: str, draw: Draw, *, least: int = 1, design: bool = False) -> Axis:
    """The axis of ``draw(choices, count, seed)`` -> points ``(n, parameters)`` in [0, 1].

    ``choices``: how many words each parameter has to choose from, 0 of numbers.

    ``design``: the points are those of a sensitivity analysis, which finds them again in `Axis.design`.
    """
    size = count(request.table[key], least, f"{request.where} {key}")
    seed = request.table.get("seed")
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        given = "is missing" if seed is None else f"= {seed!r}"
        raise InputError(
            f"{request.where}: seed {given}; give a whole number from 0, so that the sample can be repeated."
        )
    table = request.table.get("parameters")
    if not isinstance(table, dict) or not table:
        raise InputError(f"{request.where}: give parameters = {{ name = [low, high], ... }} to sample.")
    entries = request.targets.flatten(table)
    quantiles = {name: read_distribution(request, name, entry) for name, entry in entries.items()}
    found = [(request.targets.find(name, request.where), entry) for name, entry in entries.items()]
    choices = [len(entry) if target.words and isinstance(entry, list) else 0 for target, entry in found]
    shares = draw(choices, size, seed)
    points: dict[str, NDArray[np.generic]] = {
        name: quantile(shares[:, column]) for column, (name, quantile) in enumerate(quantiles.items())
    }
    plan = Design(key, shares, tuple(choices)) if design else None
    long_name = f"{key.replace('_', ' ')} sample"
    return Axis(request.own_name(), np.arange(shares.shape[0]), "1", long_name, points, plan)
