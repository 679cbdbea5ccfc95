"""The model behind the same plan files, cubes and commands as the others."""

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

from grids.plan import parse_plan
from models.errors import InputError
from rocking.commands import app
from study.check import check
from study.open import open_study
from study.run import run
from study.status import OUTSIDE_MODEL
from tests.study.cubes import assert_identical

PARAMETERS = """
wall_length = "0.72 m"
wall_height = "1.8 m"
wall_thickness = "0.138 m"
wall_density = "900 kg/m^3"
top_mass = "5 t"
top_length = "2 m"
top_height = "0.6 m"
layer_thickness = "10 mm"
layer_modulus = "4.5 MPa"
"""
PLAN = """
[study]
name = "linear"
model = "interface_linear"
[motion]
pulse = {{ shape = "sine", amplitude = "0.2 g", duration = "0.8 s" }}
[parameters]
{parameters}
[options]
{options}
[axes]
damping_ratio = {{ values = [0.0167, 0.0544, 0.1] }}
pga = {{ linspace = [0.05, 0.3, 6], unit = "g" }}
[outputs]
names = ["peak_rotation", "uplift_duration_base", "minimum_contact", "status"]
[run]
tail = "2 s"
block_seconds = {seconds}
"""
SPECIMEN = f"""
title = "wall"
model = "interface_linear"
[parameters]
{PARAMETERS}
damping_ratio = 0.0544
[initial]
rotation_1 = "0.8 deg"
rotation_2 = "0.8 deg"
"""


def text(seconds: float = 5.0, options: str = "") -> str:
    return PLAN.format(parameters=PARAMETERS, seconds=seconds, options=options)


def test_cubes_are_the_same_bits_for_any_block_size(tmp_path: Path) -> None:
    whole = run(parse_plan(text(), tmp_path), results=tmp_path / "whole", scheduler="synchronous")
    parts = run(parse_plan(text(1e-4), tmp_path), results=tmp_path / "parts", scheduler="threads")
    assert parts.blocks > whole.blocks == 1
    cube = open_study(whole.folder)
    assert_identical(open_study(parts.folder), cube)
    assert cube["status"].dims == ("damping_ratio", "pga")
    assert np.all(np.diff(cube["peak_rotation"], axis=1) > 0.0)
    assert np.all(cube["minimum_contact"].isin([0.5, 1.0]))
    # the frequencies are those of this model, with L in place of the height at rest
    assert cube["frequency_1"].values.ravel()[0] == pytest.approx(1.3507, abs=1e-3)


def test_cells_whose_joint_opens_completely_hold_no_numbers(tmp_path: Path) -> None:
    """They are outside these equations: counted apart, and neither standing nor overturned."""
    pulse = 'pulse = { shape = "sine", amplitude = "0.2 g", duration = "0.8 s" }'
    strong = text().replace(pulse, 'files = ["ridgecrest_2019_clc"]\nvertical = true')
    strong = strong.replace("0.05, 0.3, 6", "0.05, 0.77, 5").replace('"status"]', '"overturned"]')
    report = run(parse_plan(strong, tmp_path), results=tmp_path, scheduler="synchronous")
    cube = open_study(report.folder)
    outside = (cube["status"] == OUTSIDE_MODEL).values
    assert 0 < outside.sum() < outside.size
    for name in ("peak_rotation", "uplift_duration_base", "minimum_contact", "overturned"):
        np.testing.assert_array_equal(np.isnan(cube[name].values), outside, err_msg=name)
    assert np.all(cube["minimum_contact"].values[~outside] > 0.0)
    assert report.tally["outside_model"] == outside.sum()
    assert f"outside the model {outside.sum()}" in str(report)
    assert "equal bit for bit" in str(check(report.folder, cells=15, seed=1))


def test_options_of_the_full_model_are_no_options_here(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="dashpot"):
        parse_plan(text(options='dashpot = "B"'), tmp_path)
    parse_plan(text(options='joints = "both"'), tmp_path)


def test_plan_and_simulate_from_the_command_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("linear.toml").write_text(text())
    Path("wall.toml").write_text(SPECIMEN)
    runner = CliRunner()
    planned = runner.invoke(app, ["plan", "linear.toml"])
    assert planned.exit_code == 0 and "18" in planned.stdout
    for integrator in ("lanes", "reference"):
        words = ["simulate", "wall.toml", "--duration", "0.5", "--integrator", integrator, "--out", f"{integrator}.nc"]
        found = runner.invoke(app, words)
        assert found.exit_code == 0, found.output
    with xr.open_dataset("lanes.nc") as fast, xr.open_dataset("reference.nc") as slow:
        np.testing.assert_allclose(fast["rotation_1"], slow["rotation_1"], rtol=0, atol=1e-9)
        assert fast["contact_1"].values[0] == 0.5
        words = json.loads(fast.attrs["provenance"])["options"]
        assert (words["joints"], words["dashpot"], words["kinematics"]) == ("both", "A", "midpoint_held")
