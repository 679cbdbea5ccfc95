"""Hyper-rectangles cover each cell exactly once, whatever the shape and however a study grew."""

from __future__ import annotations

import json
import random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grids.axes import Axis
from grids.grid import Grid, Rectangle
from models.errors import InputError
from tests.grids.shapes import SHAPES, cover, flat_indices, make_grid


@given(SHAPES, st.integers(1, 3000), st.sets(st.integers(0, 4)))
def test_a_partition_holds_each_cell_once(shape: list[int], most: int, apart: set[int]) -> None:
    grid = make_grid(shape, frozenset(f"a{d}" for d in apart))
    rectangles = grid.new_rectangles([], most)
    assert np.all(cover(grid, rectangles) == 1)
    assert max(r.size for r in rectangles) <= most


@given(st.integers(100, 100_000), st.integers(100, 100_000))
def test_rectangles_of_one_axis_are_balanced(cells: int, most: int) -> None:
    sizes = [r.size for r in make_grid([cells]).new_rectangles([], most)]
    assert max(sizes) - min(sizes) <= 1
    assert len(sizes) == -(-cells // most)


@given(SHAPES, st.data())
def test_an_extension_holds_the_new_cells_once(shape: list[int], data: st.DataObject) -> None:
    grid = make_grid(shape)
    axes = []
    for axis in grid.axes:
        kept = data.draw(st.lists(st.integers(0, axis.size - 1), min_size=1, unique=True))
        axes.append(Axis(axis.name, axis.values[kept], "1", ""))
    old = Grid(tuple(axes))
    most = data.draw(st.integers(1, 500))
    done = [Rectangle.from_json(json.loads(json.dumps(r.as_json()))) for r in old.new_rectangles([], most)]
    new = grid.new_rectangles(done, data.draw(st.integers(1, 500)))
    assert np.all(cover(grid, [*done, *new]) == 1)


@given(st.lists(st.lists(st.integers(1, 4), min_size=3, max_size=3), min_size=2, max_size=5))
def test_a_study_extended_again_and_again(steps: list[list[int]]) -> None:
    done: list[Rectangle] = []
    shape = [0, 0, 0]
    for step in steps:
        shape = [max(a, b) for a, b in zip(shape, step, strict=True)]
        grid = make_grid(shape)
        done += grid.new_rectangles(done, 7)
        assert np.all(cover(grid, done) == 1)


@given(SHAPES, st.integers(1, 40), st.integers(1, 500), st.randoms(use_true_random=False))
def test_any_blocks_that_are_left_are_completed(shape: list[int], most: int, again: int, random: random.Random) -> None:
    grid = make_grid(shape)
    done = [r for r in grid.new_rectangles([], most) if random.random() < 0.5]
    assert np.all(cover(grid, [*done, *grid.new_rectangles(done, again)]) == 1)


def test_an_extension_takes_cells_together() -> None:
    """A finished grid cut in many blocks leaves one rectangle for each axis that grew, not one a block."""
    old = make_grid([4, 5, 6]).new_rectangles([], 7)
    assert len(make_grid([6, 5, 9]).new_rectangles(old, 1000)) == 2


def test_coordinates_follow_numpy_order() -> None:
    grid = make_grid([3, 4])
    found = grid.coordinates([0, 5, 11])
    assert np.allclose(found["a0"], [0.0, 0.1, 0.2])
    assert np.allclose(found["a1"], [0.0, 0.1, 0.3])


def test_cases_set_several_names_and_keep_their_rectangle() -> None:
    case = Axis(
        "case",
        np.array(["A", "B"], object),
        "1",
        "",
        {"width": np.array([0.2, 0.3]), "mass": np.array([1.0, 2.0])},
    )
    grid = Grid((case, Axis("pga", np.array([1.0, 2.0, 3.0]), "m s-2", "")))
    assert grid.coordinates([4]).keys() == {"width", "mass", "pga"}
    assert grid.coordinates([4])["mass"] == 2.0
    second = grid.new_rectangles([], 3)[1]
    assert second.coordinates["case"] == ("B",)
    assert grid.points(second) == {"width": [0.3], "mass": [2.0], "pga": [1.0, 2.0, 3.0]}


def test_what_cannot_be_computed_together_lies_in_rectangles_apart() -> None:
    grid = make_grid([40, 3, 50], frozenset({"a1"}))
    assert all(len(r.coordinates["a1"]) == 1 for r in grid.new_rectangles([], 2000))


def test_no_axes_is_one_cell() -> None:
    grid = Grid(())
    (only,) = grid.new_rectangles([], 10)
    assert grid.size == only.size == 1
    assert flat_indices(grid, only).tolist() == [0]


@pytest.mark.parametrize(
    ("done", "words"),
    [
        ([Rectangle({"a0": (5.0,), "a1": (0.0,)})], "5.0"),
        ([Rectangle({"a0": (0.0,)})], "vary a0"),
        ([Rectangle({"a0": (0.0, 0.1), "a1": (0.0,)}), Rectangle({"a0": (0.1,), "a1": (0.0, 0.1)})], "share cells"),
    ],
)
def test_blocks_of_another_grid_are_refused(done: list[Rectangle], words: str) -> None:
    with pytest.raises(InputError, match=words):
        make_grid([3, 3]).new_rectangles(done, 10)
