"""`rocking simulate`: what it says of a run, and what the file says."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner, Result

from models.base import STATUS, UNANSWERED
from models.errors import InputError
from rocking.commands import app
from study.history import NOT_VALID

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
        (2.5, "rocking", "events, rocked)"),
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


def test_every_ending_that_is_no_answer_has_a_sentence() -> None:
    assert set(NOT_VALID) == {STATUS[k] for k in UNANSWERED}


def test_a_gauge_of_a_recording_far_from_the_block_is_told() -> None:
    with xr.open_dataset(shaken(1.0)) as stored:
        recording = stored.load()
    about = {"units": "m", "quantity": "displacement", "position_z": 16.0}
    recording["gauge"] = ("time", 0.001 * np.sin(recording["time"].values), about)
    recording.to_netcdf("with_gauge.nc")
    result = rocking("simulate", "block.toml", "--motion", "with_gauge.nc", "--out", "h.nc")
    assert "warning: channel gauge lies 16 m from" in result.stderr, result.output


def test_a_motion_of_arrays() -> None:
    import rocking as names

    time = 0.01 * np.arange(200)
    motion = names.Motion("table", 0.01, 3.0 * np.sin(6.0 * time))
    history = names.simulate("block.toml", motion, scale=0.5)
    np.testing.assert_allclose(history["base_acceleration_x"][:200], 1.5 * np.sin(6.0 * time), atol=1e-12)


@pytest.mark.parametrize(
    ("motion", "options", "said"),
    [
        ((1, 2), {}, "motion is of type tuple"),
        (np.zeros(5), {}, "motion is of type ndarray"),
        (None, {"duration": [1]}, r"duration is \[1\] s: give a positive time"),
        (None, {"duration": True}, "duration is True s"),
        (None, {"duration": 1.0, "scale": "2"}, "scale is '2': give a number"),
        (None, {"duration": 1.0, "scale": True}, "scale is True"),
    ],
)
def test_calls_with_odd_arguments_are_one_sentence(motion: Any, options: dict[str, Any], said: str) -> None:
    from rocking import simulate

    with pytest.raises(InputError, match=said):
        simulate("block.toml", motion, **options)


def test_a_recording_that_was_changed_is_checked() -> None:
    from rocking import read_recording, simulate

    time = 0.01 * np.arange(301)
    held = {"base_acceleration_x": ("time", np.sin(6.0 * time), {"units": "m s-2"})}
    held["rotation_1"] = ("time", 0.01 * np.sin(3.0 * time), {"units": "rad"})
    xr.Dataset(held, {"time": ("time", time, {"units": "s"})}).to_netcdf("run.nc")
    read = read_recording("run.nc")
    broken = replace(read, channels={**read.channels, "base_acceleration_x": np.full(301, np.nan)})
    with pytest.raises(InputError, match="recording run: channel base_acceleration_x holds values that are not finite"):
        simulate("block.toml", broken)


def test_a_pulse_longer_than_the_name_of_a_file() -> None:
    pulse = 'pulse = { shape = "sine", amplitude = "0.3 g", frequency = "2 Hz", name = "' + 250 * "x" + '" }'
    result = rocking("simulate", "block.toml", "--motion", pulse, "--out", "h.nc")
    assert result.exit_code == 0, result.output
