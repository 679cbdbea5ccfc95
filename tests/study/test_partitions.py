"""Axes that choose joints, laws and dashpots, and buildings of several heights: the same bits in any blocks."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import models
import study.run
from grids.plan import parse_plan
from study.check import check
from study.open import open_study
from study.run import run
from tests.study.cubes import assert_identical

RUBBER = """
[study]
name = "pieces"
model = "interface"
[motion]
pulse = { shape = "sine", amplitude = "0.2 g", duration = "0.8 s" }
[parameters]
wall_length = 1.2
wall_height = 1.8
wall_thickness = 0.138
wall_density = 900
top_mass = 5000
top_length = 2.0
top_height = 0.6
layer_thickness = 0.01
damping_ratio = 0.05
mullins.softening = 0.4
[axes]
layer_modulus = { values = [4, 8], unit = "MPa" }
rubber_law = { values = ["linear", "mullins"] }
pga = { values = [0.05, 0.3, 0.6], unit = "g" }
joints = { values = ["both", "base"] }
dashpot = { values = ["B", "A"] }
[outputs]
names = ["peak_rotation", "dissipated_energy", "impacts"]
[run]
tail = "1 s"
"""
BUILDING = """
[study]
name = "pieces"
model = "isolated"
[motion]
pulse = { shape = "sine", amplitude = "0.2 g", duration = "1.5 s" }
[parameters]
total_mass = "300 t"
storey_stiffness = 3e8
storey_damping = 1e6
bearing_damping = 1.5e5
rubber_thickness = "0.1 m"
bouc_wen = { post_yield_ratio = 0.3, yield_compression = "5 mm" }
[axes]
levels = { values = [1, 6, 2] }
bearing_stiffness = { geomspace = [1e6, 8e6, 5] }
rubber_law = { values = ["bouc_wen", "linear"] }
pga = { values = [0.1, 0.4], unit = "g" }
[outputs]
names = ["peak_bearing_displacement", "peak_level_acceleration", "dissipated_energy"]
[run]
tail = "3 s"
"""
STUDIES = {
    "interface": (RUBBER, "peak_rotation", ("rubber_law", "joints", "dashpot"), {"kinematics": "toe_held"}),
    "isolated": (BUILDING, "peak_bearing_displacement", ("rubber_law", "levels"), {}),
}  # fmt: skip


@pytest.fixture(scope="module", params=STUDIES)
def whole(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, xr.Dataset]:
    """A study in as few blocks as its words allow."""
    plan = parse_plan(STUDIES[request.param][0], Path())
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(study.run, "cells_per_block", lambda plan, sample, workers: 10**6)
        report = run(plan, results=tmp_path_factory.mktemp("whole"), scheduler="synchronous")
    assert report.failed == 0 and report.blocks == 1
    # every cell again, in a random order and so beside other lanes
    assert not check(report.folder, cells=plan.grid.size, seed=1).differing
    return request.param, open_study(report.folder)


@pytest.mark.parametrize(("cells", "scheduler"), [(1, "threads"), (5, "synchronous"), (16, "threads")])
def test_the_same_bits_in_any_blocks(
    whole: tuple[str, xr.Dataset], tmp_path: Path, block_size: Callable[[int], None], cells: int, scheduler: str
) -> None:
    model, cube = whole
    block_size(cells)
    report = run(parse_plan(STUDIES[model][0], Path()), results=tmp_path, scheduler=scheduler, workers=2)
    assert report.failed == 0 and report.blocks >= cube["status"].size / cells
    assert_identical(open_study(report.folder), cube)


def test_every_word_matters_and_the_others_are_recorded(whole: tuple[str, xr.Dataset]) -> None:
    """A comparison of bits is worth something only where the words change them."""
    model, cube = whole
    _, output, varied, held = STUDIES[model]
    for name in varied:
        first, second = (cube[output].isel({name: k}) for k in (0, 1))
        assert np.any(first.values != second.values), name
    values = cube.rocking.provenance["values"]
    options = {name: entry["value"] for name, entry in values.items() if name in models.get(model).options}
    assert held.items() <= options.items() and not set(varied) & options.keys()
