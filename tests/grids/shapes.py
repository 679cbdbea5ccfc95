"""Grids of any shape, and the cells that rectangles of them cover."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from grids.axes import Axis
from grids.grid import Grid, Rectangle

SHAPES = st.lists(st.integers(1, 7), min_size=1, max_size=5)


def make_grid(shape: list[int], apart: frozenset[str] = frozenset()) -> Grid:
    """A grid of axes of these sizes, cells of those ``apart`` in rectangles of their own."""
    return Grid(tuple(Axis(f"a{d}", 0.1 * np.arange(n), "1", "") for d, n in enumerate(shape)), apart)


def flat_indices(grid: Grid, rectangle: Rectangle) -> np.ndarray:
    """Cells of a rectangle, counted with the last axis fastest."""
    if not grid.axes:
        return np.zeros(1, dtype=int)
    mesh = np.meshgrid(*grid.positions(rectangle), indexing="ij")
    return np.ravel_multi_index([index.ravel() for index in mesh], grid.shape)


def cover(grid: Grid, rectangles: list[Rectangle]) -> np.ndarray:
    """How often each cell lies in one of the rectangles."""
    counts = np.zeros(grid.size, dtype=int)
    for rectangle in rectangles:
        flat = flat_indices(grid, rectangle)
        assert flat.size == rectangle.size
        np.add.at(counts, flat, 1)
    return counts
