"""A cube's auxiliary coordinates: the model's constants (alpha, R, p ...) at every cell.

They are derived over the whole product of the axes that reach the model, a part of it at a time, and
an axis is left out only where every cell says so: a law of the rubber in the middle of its axis, or the
mechanism that only one of the laws uses, cannot be missed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grids.alike import is_value, like_cells
from grids.axes import Axis
from grids.plan import Plan
from models.base import FloatArray
from models.model import Model
from study.labels import Coordinate, describe

MOST_AT_ONCE = 1 << 16
"""Cells derived in one call; it bounds the memory, not the result."""


def derived_coordinates(plan: Plan, model: Model) -> list[Coordinate]:
    """The derived constants, each over only the axes on which it depends anywhere."""
    axes = [axis for axis in plan.axes if any(_reaches(model, name) for name in axis.sets)]
    folded = _folded(plan, model, axes, [np.arange(axis.size) for axis in axes])
    found = []
    for quantity in model.derived:
        values = folded[quantity.name]
        dims = tuple(axis.name for axis, size in zip(axes, values.shape, strict=True) if size > 1)
        shape = [size for size in values.shape if size > 1]
        found.append(Coordinate(quantity.name, dims, values.reshape(shape), describe(quantity)))
    return found


def _reaches(model: Model, name: str) -> bool:
    """Whether a name of a plan is a parameter or an option of the model, not of the motion."""
    return is_value(model, name) or name in model.options


def _folded(plan: Plan, model: Model, axes: Sequence[Axis], positions: list[NDArray[np.intp]]) -> dict[str, FloatArray]:
    """Constants over the product of positions of the axes, of length 1 along those on which they do not depend."""
    sizes = [index.size for index in positions]
    if math.prod(sizes) <= MOST_AT_ONCE:
        return {name: _without_constant_axes(v) for name, v in _derive(plan, model, axes, positions).items()}
    along = sizes.index(max(sizes))
    halves = np.array_split(positions[along], 2)
    first, second = (_folded(plan, model, axes, [*positions[:along], h, *positions[along + 1 :]]) for h in halves)
    return {name: _joined(first[name], second[name], along, [h.size for h in halves]) for name in first}


def _without_constant_axes(values: FloatArray) -> FloatArray:
    for k in range(values.ndim):
        first = values.take([0], axis=k)
        if np.all((values == first) | (np.isnan(values) & np.isnan(first))):
            values = first
    return values


def _joined(one: FloatArray, two: FloatArray, along: int, sizes: Sequence[int]) -> FloatArray:
    """Two folded arrays, one behind the other along an axis on which they had these lengths."""
    if one.shape == two.shape and one.shape[along] == 1 and np.array_equal(one, two, equal_nan=True):
        return one
    shape = np.maximum(one.shape, two.shape).tolist()
    parts = []
    for values, size in zip((one, two), sizes, strict=True):
        shape[along] = size
        parts.append(np.broadcast_to(values, shape))
    return np.concatenate(parts, axis=along)


def _derive(
    plan: Plan, model: Model, axes: Sequence[Axis], positions: Sequence[NDArray[np.intp]]
) -> dict[str, FloatArray]:
    """Constants over the product of positions of the axes, in full."""
    shape = tuple(index.size for index in positions)
    size = math.prod(shape)
    mesh = [index.ravel() for index in np.meshgrid(*positions, indexing="ij")] if axes else []
    cells: dict[str, NDArray[Any]] = {
        name: np.full(size, value) for name, value in plan.fixed.items() if is_value(model, name)
    }
    for axis, index in zip(axes, mesh, strict=True):
        cells |= {name: points[index] for name, points in axis.sets.items() if _reaches(model, name)}
    found = {quantity.name: np.empty(size) for quantity in model.derived}
    for words, rows in like_cells(model, cells, size):
        values = {name: column[rows] for name, column in cells.items() if name not in words}
        derived = model.derive(values, {**plan.options, **words})
        for name, column in found.items():
            column[rows] = derived[name]
    return {name: column.reshape(shape) for name, column in found.items()}
