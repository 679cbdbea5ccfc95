"""`rocking simulate`: what it says of a run, and what the file says."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner, Result

from rocking.commands import app

SPECIMEN = """
title = "a block"
model = "housner"
[parameters]
width = "0.4 m"
height = "1.6 m"
mass = "1 t"
"""


def rocking(*words: object) -> Result:
    return CliRunner().invoke(app, [str(word) for word in words])


@pytest.fixture(autouse=True)
def own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("block.toml").write_text(SPECIMEN)


def shaken(peak: float) -> Path:
    """A recording of a base that swings to ``peak`` (m s-2) for 2 s."""
    time = 0.01 * np.arange(301)
    base = np.where(time < 2.0, peak * np.sin(6.0 * time), 0.0)
    held = {"base_acceleration_x": ("time", base, {"units": "m s-2"})}
    xr.Dataset(held, {"time": ("time", time, {"units": "s"})}).to_netcdf("shake.nc")
    return Path("shake.nc")


@pytest.mark.parametrize(
    ("peak", "word", "said"),
    [
        (1.0, "rest", "0 events, at rest)"),
        (2.5, "rocking", "events, rocking)"),
        (9.0, "overturned", "events, overturned)"),
    ],
)
def test_what_became_of_the_block_is_said_and_written(peak: float, word: str, said: str) -> None:
    result = rocking("simulate", "block.toml", "--motion", shaken(peak), "--out", "h.nc")
    assert result.exit_code == 0 and said in result.stdout and "warning" not in result.stderr, result.output
    with xr.open_dataset("h.nc") as history:
        assert json.loads(history.attrs["outputs"])["status"] == word


def test_a_run_that_is_no_answer_is_told() -> None:
    result = rocking("simulate", "block.toml", "--motion", shaken(1e200), "--out", "h.nc")
    assert "warning: the run did not converge" in result.stderr and "not converged)" in result.stdout, result.output
    with xr.open_dataset("h.nc") as history:
        assert json.loads(history.attrs["outputs"])["status"] == "not_converged"


def test_a_gauge_of_a_recording_far_from_the_block_is_told() -> None:
    with xr.open_dataset(shaken(1.0)) as stored:
        recording = stored.load()
    about = {"units": "m", "quantity": "displacement", "position_z": 16.0}
    recording["gauge"] = ("time", 0.001 * np.sin(recording["time"].values), about)
    recording.to_netcdf("with_gauge.nc")
    result = rocking("simulate", "block.toml", "--motion", "with_gauge.nc", "--out", "h.nc")
    assert "warning: channel gauge lies 16 m from" in result.stderr, result.output
