"""Which cells a model can advance side by side.

A call of a model takes arrays of parameters, but one motion, one time scale and one word of each option.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grids.targets import MOTION, SCALES
from models.model import Model

Coordinates = Mapping[str, NDArray[Any]]
"""Values ``(n,)`` by name of everything that varies, one element a cell."""
SCALING = tuple(parameter.name for parameter in SCALES)
"""Names of a plan that act on the motion and not on the model."""


def taken_once(model: Model, name: str) -> bool:
    """Whether a call of the model takes one value of ``name`` for all its lanes."""
    return name in (MOTION, "time_scale") or name in model.options


def is_value(model: Model, name: str) -> bool:
    """Whether ``name`` is a number that the model takes by lane: a parameter, its own or a mechanism's."""
    return name not in SCALING and not taken_once(model, name)


def like_cells(model: Model, cells: Coordinates, size: int) -> Iterator[tuple[dict[str, Any], NDArray[np.intp]]]:
    """The values that a call of the model takes once, and the indices of the cells that share them."""
    names = [name for name in cells if taken_once(model, name)]
    group = np.zeros(size, dtype=np.intp)
    levels: list[NDArray[Any]] = []
    for name in names:
        distinct, number = np.unique(cells[name], return_inverse=True)
        group = group * distinct.size + number
        levels.append(distinct)
    for g in np.unique(group):
        key: dict[str, Any] = {}
        rest = int(g)
        for name, distinct in zip(reversed(names), reversed(levels), strict=True):
            rest, k = divmod(rest, distinct.size)
            key[name] = distinct[k].item() if hasattr(distinct[k], "item") else distinct[k]
        yield key, np.flatnonzero(group == g)
