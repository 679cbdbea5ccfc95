"""Cells in groups against cells one by one: every kind of axis, and the block store."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import models
from grids.plan import Plan, parse_plan
from study.evaluate import evaluate
from study.keys import Setting, block_key, motions_by_name
from study.open import open_study
from study.run import run
from study.store import BlockStore, DamagedBlock, write_whole
from tests.study.plans import small_plan

PLAN = """
[study]
name = "every_axis"
model = "housner"
[parameters]
height = "1.8 m"
mass = 500
[axes]
motion = { values = ["ridgecrest_2019_clc", "ridgecrest_2019_tow2"] }
formulation = { values = ["linear", "nonlinear"] }
wall = { cases = [
  { label = "thin", width = "0.3 m", top_mass = "1 t" },
  { label = "thick", width = "0.5 m", top_mass = "0 kg" },
] }
"pivot_inset.inset_over_half_width" = { values = [0, 0.1] }
time_scale = { values = [1.0, 0.7] }
pga = { values = [0.2, 0.4], unit = "g" }
[outputs]
names = ["peak_rotation", "impacts"]
[run]
tail = "2 s"
"""


@pytest.fixture(scope="module")
def plan() -> Plan:
    return parse_plan(PLAN, Path.cwd())


def test_groups_equal_single_runs_of_the_model(plan: Plan) -> None:
    setting, motions, model = Setting.of(plan), motions_by_name(plan), models.get("housner")
    cells = np.random.default_rng(1).permutation(plan.grid.size)[:24]
    at = plan.grid.coordinates(cells)
    found = evaluate(setting, motions, at)
    for k in range(cells.size):
        motion = motions[at["motion"][k]]
        alone = model.evaluate(
            {
                "height": 1.8,
                "mass": 500.0,
                "width": at["width"][k],
                "top_mass": at["top_mass"][k],
                "pivot_inset.inset_over_half_width": at["pivot_inset.inset_over_half_width"][k],
            },
            motion.time_scaled(at["time_scale"][k]).shaking(),
            np.array([at["pga"][k] / motion.pga]),
            outputs=("peak_rotation", "impacts"),
            tail=2.0,
            options={"formulation": at["formulation"][k]},
        )
        np.testing.assert_allclose(found["peak_rotation"][k], alone["peak_rotation"][0], rtol=1e-6)


def test_every_kind_of_axis_reaches_the_cube(plan: Plan, tmp_path: Path) -> None:
    cube = open_study(run(plan, results=tmp_path, scheduler="synchronous").folder)
    assert cube["peak_rotation"].dims == tuple(axis.name for axis in plan.axes)
    assert cube["width"].dims == ("wall",) and cube["width"].attrs["units"] == "m"
    assert list(cube["wall"].values) == ["thin", "thick"]
    assert list(cube["formulation"].values) == ["linear", "nonlinear"]
    assert cube["alpha"].dims == ("wall", "pivot_inset.inset_over_half_width")
    np.testing.assert_allclose(
        np.tan(cube["alpha"].sel(wall="thick")) * 1.8, 0.5 * (1.0 - cube["pivot_inset.inset_over_half_width"])
    )
    assert cube["record_pga"].dims == ("motion",)


def test_keys_tell_what_matters_and_nothing_else() -> None:
    plan = small_plan()
    (block,) = plan.grid.new_rectangles([], 10**6)
    key = block_key(plan, Setting.of(plan), block)
    longer = small_plan(name="other", pga="linspace = [0.1, 1.0, 10], unit = 'g'")
    assert block_key(longer, Setting.of(longer), block) == key
    for changes in (
        {"mass": "801 kg"},
        {"tail": "3 s"},
        {"motion": 'files = ["ridgecrest_2019_ccc"]'},
        {"outputs": '"impacts"'},
    ):
        other = small_plan(**changes)
        assert block_key(other, Setting.of(other), block) != key


def test_a_write_that_fails_leaves_nothing(tmp_path: Path) -> None:
    target = tmp_path / "block.nc"
    target.write_bytes(b"old")

    def write(path: Path) -> None:
        path.write_bytes(b"half")
        raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        write_whole(target, write)
    assert [p.name for p in tmp_path.iterdir()] == ["block.nc"] and target.read_bytes() == b"old"


def test_a_damaged_block_is_named(tmp_path: Path) -> None:
    store = BlockStore(tmp_path)
    values = np.arange(6.0).reshape(2, 3)
    store.write("key", {"x": np.arange(2.0), "word": np.array(["a", "b", "c"], dtype=object)}, {"out": values}, {})
    axes, outputs = store.read("key")
    assert axes == {"x": (0.0, 1.0), "word": ("a", "b", "c")}
    np.testing.assert_array_equal(outputs["out"], values)
    path = store.blocks / "key.nc"
    path.write_bytes(path.read_bytes()[:100])
    with pytest.raises(DamagedBlock, match="run again"):
        store.read("key")
