"""Checks over a whole plan: its size, its scales, and the model's own sentences about its cells."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grids.axes import Axis
from grids.motions import Motion
from grids.targets import SCALES
from models.base import Model
from models.errors import InputError

MOST_CELLS = 2_000_000_000
MOST_CHECKED = 200_000


def check_size(axes: Sequence[Axis]) -> None:
    """Raise InputError for more cells than any cube can hold."""
    size = math.prod(axis.size for axis in axes)
    if size > MOST_CELLS:
        longest = max(axes, key=lambda axis: axis.size)
        raise InputError(
            f"[axes] make {size:.3g} cells, more than {MOST_CELLS:.0e}; thin an axis "
            f"('{longest.name}' has {longest.size} values) or draw a sample."
        )


def check_scales(names: Collection[str], motions: Sequence[Motion]) -> None:
    """Raise InputError where the motion is scaled twice, or a silent one to a peak."""
    if {"pga", "motion_scale"} <= set(names):
        raise InputError("'pga' and 'motion_scale' both scale the motion; give one of them.")
    if "pga" in names:
        for motion in motions:
            if motion.pga == 0.0:
                raise InputError(f"motion '{motion.name}' is zero throughout; pga cannot scale it, use another.")


def check_cells(model: Model, fixed: Mapping[str, float], axes: Sequence[Axis]) -> None:
    """Raise InputError with the model's first sentence about a cell that has no meaning.

    All cells are looked at up to 200 000 combinations of the model's parameters; of more, evenly
    spaced ones with all ends of the axes.
    """
    outside = {scale.name for scale in SCALES}
    along = [
        {
            name: values
            for name, values in axis.sets.items()
            if name not in outside and np.issubdtype(values.dtype, np.floating)
        }
        for axis in axes
    ]
    picks = _picks([axis.size if names else 1 for axis, names in zip(axes, along, strict=True)])
    mesh = np.meshgrid(*picks, indexing="ij") if picks else []
    values: dict[str, Any] = {name: value for name, value in fixed.items() if name not in outside}
    for names, index in zip(along, mesh, strict=True):
        values |= {name: column[index.ravel()] for name, column in names.items()}
    with np.errstate(all="ignore"):  # what is senseless may divide by zero before it is named
        sentences = model.check(values)
    for sentence in sentences:
        raise InputError(sentence)


def _picks(sizes: list[int]) -> list[NDArray[np.int64]]:
    """Indices along each axis whose product stays under the limit, ends included."""
    kept = list(sizes)
    while math.prod(kept) > MOST_CHECKED:
        longest = kept.index(max(kept))
        kept[longest] = max(2, kept[longest] // 2)
        if max(kept) == 2:
            break
    return [
        np.unique(np.linspace(0, size - 1, count).round().astype(np.int64))
        for size, count in zip(sizes, kept, strict=True)
    ]
