"""The product of the axes: its cells, and hyper-rectangles of cells that are computed together."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grids.axes.base import Axis
from models.errors import InputError

IndexArray = NDArray[np.int64]


@dataclass(frozen=True)
class Rectangle:
    """Cells that are the product of some values of each axis, in the order of the dimensions.

    ``coordinates`` holds the values themselves (floats in SI, ints, words), so a rectangle keeps
    its meaning when the axes of a study grow; it turns into JSON and back unchanged.
    """

    coordinates: Mapping[str, tuple[Any, ...]]

    @property
    def size(self) -> int:
        return math.prod(len(values) for values in self.coordinates.values())

    def as_json(self) -> dict[str, list[Any]]:
        return {name: list(values) for name, values in self.coordinates.items()}

    @classmethod
    def from_json(cls, table: Mapping[str, Sequence[Any]]) -> Rectangle:
        return cls({name: tuple(values) for name, values in table.items()})


@dataclass(frozen=True, eq=False)
class Grid:
    """Cells over ``axes``; the last axis varies fastest in a flat index, as in numpy.

    ``apart`` names the axes that a rectangle holds at one value each as far as possible, because
    cells that differ there cannot be computed side by side (another record, another formulation).
    """

    axes: tuple[Axis, ...]
    apart: frozenset[str] = frozenset()

    @property
    def dims(self) -> tuple[str, ...]:
        return tuple(axis.name for axis in self.axes)

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(axis.size for axis in self.axes)

    @property
    def size(self) -> int:
        return math.prod(self.shape)

    def coordinates(self, flat: Iterable[int] | IndexArray) -> dict[str, NDArray[Any]]:
        """The values ``(n,)`` of every varied name at cells given by flat index ``(n,)``."""
        indices = np.asarray(flat, dtype=np.int64)
        if not self.axes:
            return {}
        along = np.unravel_index(indices, self.shape)
        return {
            name: values[index]
            for axis, index in zip(self.axes, along, strict=True)
            for name, values in axis.sets.items()
        }

    def positions(self, rectangle: Rectangle) -> tuple[IndexArray, ...]:
        """Where the rectangle lies: one index array for each axis, for `numpy.ix_`."""
        return tuple(
            np.array([index[value] for value in rectangle.coordinates[name]], dtype=np.int64)
            for name, index in self._index.items()
        )

    def points(self, rectangle: Rectangle) -> dict[str, list[Any]]:
        """What the rectangle's cells set, axis by axis, with what cases and samples set.

        Two rectangles of one study hold the same cells if and only if these are equal.
        """
        positions = self.positions(rectangle)
        return {
            name: values[index].tolist()
            for axis, index in zip(self.axes, positions, strict=True)
            for name, values in axis.sets.items()
        }

    def count_blocks(self, most_cells: int) -> tuple[int, int]:
        """How many rectangles of at most ``most_cells`` all cells make, and how many coordinates they hold in all."""
        counts = list(self.shape)
        pieces = _pieces(counts, most_cells, [axis.name in self.apart for axis in self.axes])
        blocks = math.prod(pieces)
        return blocks, blocks * sum(-(-count // n) for count, n in zip(counts, pieces, strict=True))

    def new_rectangles(self, done: Sequence[Rectangle], most_cells: int) -> list[Rectangle]:
        """The cells outside ``done``, each once, in rectangles of at most ``most_cells``.

        ``done``: any rectangles of this grid that share no cell; where there are none those found are nearly equal in
        size. Raises InputError for others.
        """
        covered: list[tuple[IndexArray, ...]] = []
        for rectangle in done:
            if tuple(rectangle.coordinates) != self.dims:
                raise InputError(
                    f"the finished blocks vary {', '.join(rectangle.coordinates)}, the plan varies "
                    f"{', '.join(self.dims)}; use another study name."
                )
            try:
                covered.append(self.positions(rectangle))
            except KeyError as error:
                raise InputError(
                    f"the finished blocks hold the axis value {error.args[0]!r}, which the plan does not; "
                    "put it back or use another study name."
                ) from None
        left = _outside(self.shape, covered)
        cells = sum(math.prod(len(index) for index in product) for product in left)
        if cells + sum(rectangle.size for rectangle in done) != self.size:
            raise InputError("the finished blocks share cells; start the study anew.")
        return [rectangle for product in left for rectangle in self._split(list(map(np.array, product)), most_cells)]

    @cached_property
    def _index(self) -> dict[str, dict[Any, int]]:
        return {axis.name: {v: i for i, v in enumerate(axis.values.tolist())} for axis in self.axes}

    def _split(self, indices: list[IndexArray], most_cells: int) -> Iterator[Rectangle]:
        """The product of ``indices`` cut into boxes, the axes ``apart`` first, then the outermost."""
        if most_cells < 1:
            raise InputError(f"a block of {most_cells} cells; give at least 1.")
        counts = [index.size for index in indices]
        if 0 in counts:
            return
        pieces = _pieces(counts, most_cells, [axis.name in self.apart for axis in self.axes])
        parts = [
            [axis.values[p] for p in np.array_split(index, k)]
            for axis, index, k in zip(self.axes, indices, pieces, strict=True)
        ]
        for number in np.ndindex(*pieces):
            yield Rectangle(
                {axis.name: tuple(part[i].tolist()) for axis, part, i in zip(self.axes, parts, number, strict=True)}
            )


def _pieces(counts: list[int], most_cells: int, first: list[bool]) -> list[int]:
    """Into how many pieces to cut each axis so that no box exceeds ``most_cells``."""
    pieces = [1] * len(counts)
    rest = math.prod(counts)
    for d in sorted(range(len(counts)), key=lambda d: not first[d]):
        if rest <= most_cells:
            break
        rest //= counts[d]
        longest = most_cells // rest
        pieces[d] = counts[d] if longest == 0 else -(-counts[d] // longest)
        rest *= -(-counts[d] // pieces[d])
    return pieces


Product = tuple[tuple[int, ...], ...]
"""Positions along each axis whose product is a set of cells."""


def _outside(shape: tuple[int, ...], covered: Sequence[tuple[IndexArray, ...]]) -> list[Product]:
    """The cells of ``shape`` in none of the products ``covered``, as few products as the order of axes gives.

    Along the first axis positions are taken together after which the same cells of the other axes are left.
    """
    holders: list[dict[int, set[int]]] = [{} for _ in shape]
    for number, product in enumerate(covered):
        for along, index in zip(holders, product, strict=True):
            for i in index.tolist():
                along.setdefault(i, set()).add(number)

    @cache
    def left(axis: int, among: frozenset[int]) -> tuple[Product, ...]:
        if axis == len(shape):
            return () if among else ((),)
        if not among:
            return (tuple(tuple(range(size)) for size in shape[axis:]),)
        positions: dict[tuple[Product, ...], list[int]] = {}
        for i in range(shape[axis]):
            rest = left(axis + 1, among.intersection(holders[axis].get(i, ())))
            positions.setdefault(rest, []).append(i)
        return tuple((tuple(own), *product) for rest, own in positions.items() for product in rest)

    return list(left(0, frozenset(range(len(covered)))))
