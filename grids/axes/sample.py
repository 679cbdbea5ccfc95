"""What Latin hypercube and Sobol samples share: several numbers drawn together in a box.

``{ <kind> = count, seed = 1, parameters = { width = ["0.2 m", "0.5 m"],
layer_modulus = { range = [1, 20], unit = "MPa", spacing = "log" } } }``; uniform in the value, or
in its logarithm.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grids.axes.base import Axis, Request, bounded, count
from grids.targets import MOTION
from grids.units import factor_to_si, to_si
from models.errors import InputError

BESIDE = ("seed", "parameters")


def read_sample(request: Request, key: str, draw: Any) -> Axis:
    """The axis of ``draw(dimensions, count, seed)`` -> points ``(count, dimensions)`` in [0, 1)."""
    size = count(request.table[key], 1, f"{request.where} {key}")
    seed = request.table.get("seed")
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        given = "is missing" if seed is None else f"= {seed!r}"
        raise InputError(
            f"{request.where}: seed {given}; give a whole number from 0, so that the sample can be repeated."
        )
    table = request.table.get("parameters")
    if not isinstance(table, dict) or not table:
        raise InputError(f"{request.where}: give parameters = {{ name = [low, high], ... }} to sample.")
    ranges = {name: _scale(request, name, entry) for name, entry in request.targets.flatten(table).items()}
    unit_points = draw(len(ranges), size, seed)
    points: dict[str, NDArray[Any]] = {}
    for column, (name, (low, high, log)) in enumerate(ranges.items()):
        share = unit_points[:, column]
        points[name] = low * (high / low) ** share if log else low + (high - low) * share
    return Axis(request.own_name(), np.arange(size), "1", f"{key.replace('_', ' ')} sample", points)


def _scale(request: Request, name: str, entry: object) -> tuple[float, float, bool]:
    where = f"{request.where} {name}"
    table: Mapping[str, Any] = entry if isinstance(entry, dict) else {"range": entry}
    if unknown := set(table) - {"range", "unit", "spacing"}:
        raise InputError(f"{where}: {sorted(unknown)[0]!r} is not known; known: range, unit, spacing.")
    ends, spacing = table.get("range"), table.get("spacing", "linear")
    if spacing not in ("linear", "log"):
        raise InputError(f"{where}: spacing = {spacing!r}; write 'linear' or 'log'.")
    if name == MOTION or request.targets.find(name, where).words:
        raise InputError(f"{where}: a sample draws numbers; give words an axis of their own.")
    if not isinstance(ends, list) or len(ends) != 2:
        raise InputError(f"{where} = {entry!r}; give [low, high].")
    target = request.targets.find(name, where)
    unit = table.get("unit")
    low, high = (
        to_si(end, target.unit, where)
        if unit is None or isinstance(end, str)
        else to_si(end, "1", where) * factor_to_si(str(unit), target.unit, where)
        for end in ends
    )
    if not low < high:
        raise InputError(f"{where} = {ends}: low must be below high; swap or separate them.")
    if spacing == "log" and low <= 0.0:
        raise InputError(f"{where}: a log spacing starts above zero, not at {low:.6g}; raise it or use linear.")
    bounded(np.array([low, high]), target, where)
    return low, high, spacing == "log"
