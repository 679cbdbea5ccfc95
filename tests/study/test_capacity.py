"""A study that would not fit says so before it starts, and nothing is written."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import psutil
import pytest
from hypothesis import given
from hypothesis import strategies as st

from models.errors import InputError
from study.run import run
from tests.grids.shapes import SHAPES, make_grid
from tests.study.plans import small_plan


@given(SHAPES, st.integers(1, 300))
def test_blocks_are_counted_without_being_made(shape: list[int], most: int) -> None:
    grid = make_grid(shape)
    rectangles = grid.new_rectangles([], most)
    blocks, coordinates = grid.count_blocks(most)
    assert blocks == len(rectangles)
    assert coordinates >= sum(len(values) for r in rectangles for values in r.coordinates.values())


def test_axes_beyond_memory_are_refused_before_anything_is_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(psutil, "virtual_memory", lambda: SimpleNamespace(available=4e8))
    plan = small_plan(pga="linspace = [0.1, 0.8, 1000000], unit = 'g'")
    with pytest.raises(InputError, match=r"1000000 points of pga need about 1\.5 GB of memory, 0\.4 GB are free"):
        run(plan, results=tmp_path)
    assert not list(tmp_path.iterdir())


def test_blocks_beyond_memory(
    tmp_path: Path, block_size: Callable[[int], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    block_size(1)
    monkeypatch.setattr(psutil, "virtual_memory", lambda: SimpleNamespace(available=60_000))
    with pytest.raises(InputError, match=r"168 blocks of 168 cells need about .* of memory"):
        run(small_plan(), results=tmp_path)
    assert not list(tmp_path.rglob("*.nc"))


def test_results_beyond_the_disk(
    tmp_path: Path, block_size: Callable[[int], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    block_size(24)
    monkeypatch.setattr(shutil, "disk_usage", lambda path: SimpleNamespace(free=2 * 8 * 168 - 1))
    with pytest.raises(InputError, match=r"168 cells need about .* on the disk"):
        run(small_plan(), results=tmp_path)
    monkeypatch.setattr(shutil, "disk_usage", lambda path: SimpleNamespace(free=2 * 8 * 168))
    assert run(small_plan(), results=tmp_path).computed == 7
