"""A building on bearings through the commands: a plan to a cube and a map, a specimen to a history."""

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner, Result

from grids.recordings import read_recording
from rocking.commands import app
from study.open import open_study
from tests.models.isolated.buildings import MODEL, two_tones

PLAN = """
[study]
name = "isolated_small"
model = "isolated"
[motion]
files = ["ridgecrest_2019_clc"]
component = "north"
[parameters]
total_mass = "300 t"
storey_stiffness = 3e8
storey_damping = 1e6
bearing_damping = 1.5e5
rubber_thickness = "0.1 m"
[axes]
levels = { values = [1, 6] }
bearing_stiffness = { geomspace = [1e6, 8e6, 3] }
"mullins.softening" = { values = [0.0, 0.5] }
pga = { values = [0.1, 0.4], unit = "g" }
[outputs]
names = ["peak_bearing_displacement", "peak_level_acceleration", "dissipated_energy"]
[run]
tail = "5 s"
"""
SPECIMEN = """
title = "a building"
model = "isolated"
[parameters]
levels = 3
total_mass = "300 t"
storey_stiffness = 3e8
storey_damping = 1e6
bearing_stiffness = 3e6
bearing_damping = 1.5e5
rubber_thickness = "0.1 m"
[options]
rubber_law = "bouc_wen"
[mechanisms.bouc_wen]
post_yield_ratio = 0.3
yield_compression = "5 mm"
[mechanisms.gain]
gain = 0.05
"""


def rocking(*words: object) -> Result:
    return CliRunner().invoke(app, [str(word) for word in words])


@pytest.fixture(autouse=True)
def current_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_a_plan_becomes_a_cube_and_a_map() -> None:
    Path("plan.toml").write_text(PLAN)
    outcome = rocking("plan", "plan.toml")
    assert outcome.exit_code == 0 and "24" in outcome.stdout, outcome.output
    outcome = rocking("run", "plan.toml", "--scheduler", "synchronous")
    assert outcome.exit_code == 0, outcome.output
    folder = Path("results/isolated_small")
    cube = open_study(folder)
    assert cube["status"].values.tolist() == np.full((2, 3, 2, 2), 2).tolist()
    # stiffer bearings move less and pass more on, softened ones pass less on
    displacement, acceleration = cube["peak_bearing_displacement"], cube["peak_level_acceleration"]
    assert np.all(acceleration.isel(bearing_stiffness=2) > acceleration.isel(bearing_stiffness=0))
    assert displacement.attrs["units"] == "m"
    assert cube["frequency_2"].dims == ("levels", "bearing_stiffness")
    assert np.isnan(cube["frequency_2"].isel(levels=0)).all()
    linear = cube.isel({"mullins.softening": 0})
    ratio = linear["peak_bearing_displacement"].isel(pga=1) / linear["peak_bearing_displacement"].isel(pga=0)
    np.testing.assert_allclose(ratio, 4.0, rtol=1e-9)
    outcome = rocking("check", folder, "--cells", 10)
    assert outcome.exit_code == 0, outcome.output
    outcome = rocking("map", folder)
    assert outcome.exit_code == 2 and "neither rocks nor overturns" in outcome.output
    outcome = rocking("map", folder, "--output", "peak_level_acceleration", "--x", "bearing_stiffness", "--y", "pga")
    assert outcome.exit_code == 0 and (folder / "peak_level_acceleration_map.png").stat().st_size > 5000, outcome.output
    values = cube.rocking.output_map(
        "peak_level_acceleration", "bearing_stiffness", "pga", levels=6, **{"mullins.softening": 0.5}
    )
    np.testing.assert_array_equal(values, acceleration.values[1, :, 1].T)


def test_a_specimen_becomes_a_history_that_reads_as_a_recording() -> None:
    Path("building.toml").write_text(SPECIMEN)
    outcome = rocking(
        "simulate", "building.toml", "--motion", "ridgecrest_2019_clc", "--out", "h.nc", "--figure", "h.png",
        "--duration", 15,
    )  # fmt: skip
    assert outcome.exit_code == 0 and Path("h.png").exists(), outcome.output
    with xr.open_dataset("h.nc") as history:
        assert json.loads(history.attrs["provenance"])["options"] == {"rubber_law": "bouc_wen"}
    recording = read_recording("h.nc")
    assert recording.channels["level_acceleration_x"].shape == recording.channels["level_displacement_x"].shape
    assert recording.channels["level_displacement_x"].shape[0] == len(recording.levels) == 3
    values = {"levels": 3.0, "total_mass": 3e5, "storey_stiffness": 3e8, "storey_damping": 1e6,
              "bearing_stiffness": 3e6, "bearing_damping": 1.5e5, "bouc_wen.post_yield_ratio": 0.3,
              "bouc_wen.yield_compression": 0.005}  # fmt: skip
    again = MODEL.simulate(values, recording.shaking(False))
    np.testing.assert_allclose(
        recording.channels["level_displacement_x"], again.channels["level_displacement_x"], atol=1e-12
    )


def test_a_pull_and_release() -> None:
    text = SPECIMEN + '[initial]\nbearing_displacement = "50 mm"\n'
    Path("building.toml").write_text(text)
    outcome = rocking("simulate", "building.toml", "--duration", 5, "--out", "h.nc")
    assert outcome.exit_code == 0, outcome.output
    moved = read_recording("h.nc").channels["level_displacement_x"]
    np.testing.assert_array_equal(moved[:, 0], 0.05)
    Path("building.toml").write_text(text.replace("bearing_displacement", "rotation_1"))
    outcome = rocking("simulate", "building.toml", "--duration", 5, "--out", "h.nc")
    assert outcome.exit_code == 2 and "no state of model 'isolated'" in outcome.output


def test_a_law_that_acts_in_compression_only_is_refused() -> None:
    Path("plan.toml").write_text(PLAN.replace('"mullins.softening"', '"permanent_set.rate"'))
    outcome = rocking("plan", "plan.toml")
    assert outcome.exit_code == 2 and "'permanent_set' does not act on model 'isolated'" in " ".join(
        outcome.output.split()
    )


def test_a_law_axis() -> None:
    shaking, words = two_tones(), ("linear", "bouc_wen")
    values = {"total_mass": 3e5, "bearing_stiffness": 3e6, "bearing_damping": 1e5, "bouc_wen.post_yield_ratio": 0.2}
    found = [
        MODEL.evaluate(values, shaking, np.ones(1), outputs=["peak_bearing_displacement"], tail=1.0,
                       options={"rubber_law": word})["peak_bearing_displacement"][0]
        for word in words
    ]  # fmt: skip
    plain = {k: v for k, v in values.items() if "." not in k}
    alone = MODEL.evaluate(plain, shaking, np.ones(1), outputs=["peak_bearing_displacement"], tail=1.0)
    assert found[0] == alone["peak_bearing_displacement"][0] != found[1]
