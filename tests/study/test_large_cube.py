"""A cube larger than the memory it may take is assembled, counted, mapped and exported; lazy is what eager is."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import dask
import numpy as np
import pytest
import xarray as xr

import study.export
from benchmarks.faults.commands import environment
from study.export import export
from study.open import open_study
from study.run import run
from tests.study.plans import small_plan


@pytest.mark.slow
def test_no_step_holds_the_cube_in_memory(tmp_path: Path) -> None:
    """The peak of memory, measured in a process of its own, rises by less than two fifths of the cube in any step."""
    command = [sys.executable, "-m", "tests.study.large_cube", str(tmp_path), "1400"]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=environment())
    found = json.loads(done.stdout)
    assert found["bytes"] > 150e6
    assert max(found["grown"].values()) < found["bytes"] / 2.5, found


def test_a_lazy_cube_holds_no_numbers_until_it_is_asked(tmp_path: Path) -> None:
    folder = run(small_plan(), results=tmp_path).folder
    whole = open_study(folder)
    with open_study(folder, lazy=True) as lazy, dask.config.set(scheduler="synchronous"):
        assert all(values.chunks is not None for values in lazy.data_vars.values())
        xr.testing.assert_identical(lazy.compute(), whole)
        for ask in (
            lambda cube: cube.rocking.overturning_map(x="aspect_ratio", y="top_mass"),
            lambda cube: cube.rocking.output_map("peak_rotation", x="aspect_ratio", y="pga"),
            lambda cube: cube.rocking.slices("impacts", x="pga"),
        ):
            xr.testing.assert_identical(ask(lazy), ask(whole))


@pytest.mark.parametrize("rows", [1, 5, 8, 30, 10_000])
def test_a_table_in_parts_is_the_whole_table(rows: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = run(small_plan(), results=tmp_path).folder
    cube = open_study(folder)
    whole = export(cube, tmp_path / "whole.csv").read_text()
    monkeypatch.setattr(study.export, "ROWS_AT_ONCE", rows)
    assert export(open_study(folder, lazy=True), tmp_path / "parts.csv").read_text() == whole
    assert len(whole.splitlines()) == 1 + cube["status"].size


def test_a_lazy_cube_is_exported_to_the_same_numbers(tmp_path: Path) -> None:
    folder = run(small_plan(), results=tmp_path).folder
    path = export(open_study(folder, lazy=True), tmp_path / "part.nc", at={"top_mass": "1 t"})
    expected = open_study(folder).sel(top_mass=1000.0)
    found = xr.open_dataset(path).load()
    for name in expected.data_vars:
        np.testing.assert_array_equal(found[name].values, expected[name].values)
