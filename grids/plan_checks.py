"""Checks over a whole plan: its size, its scales, and the model's own sentences about its cells."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grids.alike import is_value, like_cells
from grids.axes import Axis
from grids.motions import Motion
from models.errors import InputError
from models.model import Model

MOST_CELLS = 2_000_000_000
MOST_CHECKED = 200_000
MOST_REFINED = 5


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


def check_vertical(model: Model, vertical: bool | None) -> None:
    """Raise InputError where a vertical motion is asked for that the model leaves out."""
    if vertical and not model.takes_vertical:
        raise InputError(
            f"[motion] vertical = true, but model '{model.name}' is shaken horizontally only; "
            "set vertical = false or leave it out."
        )


def check_cells(model: Model, fixed: Mapping[str, float], axes: Sequence[Axis], options: Mapping[str, str]) -> None:
    """Raise InputError with the model's first sentence about a cell that has no meaning.

    ``options``: the words that do not vary. All cells are looked at up to 200 000 combinations of
    what reaches the model; of more, evenly spaced ones with all ends of the axes and every word.
    """
    along = [
        {name: v for name, v in axis.sets.items() if is_value(model, name) or name in model.options} for axis in axes
    ]
    picks = _picks(
        [axis.size if names else 1 for axis, names in zip(axes, along, strict=True)],
        [axis.name in model.options for axis in axes],
    )
    mesh = [index.ravel() for index in np.meshgrid(*picks, indexing="ij")] if picks else []
    size = math.prod(index.size for index in picks)
    cells: dict[str, NDArray[Any]] = {}
    for names, index in zip(along, mesh, strict=True):
        cells |= {name: column[index] for name, column in names.items()}
    constant = {name: value for name, value in fixed.items() if is_value(model, name)}
    for words, rows in like_cells(model, cells, size):
        values = {**constant, **{name: column[rows] for name, column in cells.items() if name not in words}}
        with np.errstate(all="ignore"):  # what is senseless may divide by zero before it is named
            sentences = model.check(values, {**options, **words})
        for sentence in sentences:
            raise InputError(sentence)


def check_refinable(model: Model, axes: Sequence[Axis]) -> None:
    """Raise InputError where cells have no neighbours between which a border of outcomes could run."""
    if all(output.name != "overturned" for output in model.outputs):
        raise InputError(f"[refine] follows onset and overturning, which model '{model.name}' has not; leave it out.")
    if not 2 <= sum(axis.size > 1 for axis in axes) <= MOST_REFINED:
        raise InputError(f"[refine] needs 2 to {MOST_REFINED} axes with several values; leave it out or change [axes].")
    for axis in axes:
        numbers = axis.points is None and axis.values.dtype.kind in "iuf"
        if not numbers or not np.all(np.diff(axis.values) > 0.0):
            raise InputError(
                f"[refine] needs axes of ascending numbers, '{axis.name}' is none: no border runs between its values; "
                "make a study of each, or leave [refine] out."
            )


def _picks(sizes: list[int], whole: list[bool]) -> list[NDArray[np.int64]]:
    """Indices along each axis whose product stays under the limit, ends included; those ``whole`` are not thinned."""
    kept = list(sizes)
    thinned = [k for k, all_of_it in enumerate(whole) if not all_of_it]
    while math.prod(kept) > MOST_CHECKED:
        longest = max(thinned, key=kept.__getitem__, default=None)
        if longest is None or kept[longest] <= 2:
            break
        kept[longest] = max(2, kept[longest] // 2)
    return [
        np.unique(np.linspace(0, size - 1, count).round().astype(np.int64))
        for size, count in zip(sizes, kept, strict=True)
    ]
