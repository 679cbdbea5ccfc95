"""Simulations under the measured base motion of a recording, whatever the ending of its file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray

import rocking
from grids.specimen import parse_specimen
from models.errors import InputError

SPECIMEN = parse_specimen(
    'title = "block"\nmodel = "housner"\n[parameters]\nwidth = 0.25\nheight = 1.1\nmass = 120.0\n'
)
TIME = 0.01 * np.arange(60)
BASE = np.sin(20.0 * TIME)
COLUMNS = """
time_step = "0.01 s"
[columns]
base_acceleration_x = { column = "a", unit = "m/s2" }
inclino = { column = "r", unit = "rad" }
[channels.inclino]
quantity = "rotation"
"""


def stored(path: Path) -> Path:
    """A recording of a placed rotation."""
    if path.suffix.lower() in (".csv", ".txt"):
        path.with_suffix(".toml").write_text(COLUMNS)
        path.write_text("a,r\n" + "".join(f"{a},{0.01 * a}\n" for a in BASE))
        return path
    channels = {
        "base_acceleration_x": ("time", BASE, {"units": "m s-2"}),
        "inclino": ("time", 0.01 * BASE, {"units": "rad", "quantity": "rotation"}),
    }
    data = xarray.Dataset(channels, coords={"time": ("time", TIME, {"units": "s"})})
    data.to_netcdf(path, engine="netcdf4")
    return path


@pytest.mark.parametrize("name", ["run.nc", "run.nc4", "run.NC", "run.cdf", "run.csv", "run.CSV", "run.txt"])
def test_a_recording_is_one_by_what_it_holds(name: str, tmp_path: Path) -> None:
    found = rocking.simulate(SPECIMEN, stored(tmp_path / name), duration=0.3)
    assert found["inclino"].attrs["quantity"] == "rotation"
    assert found["base_acceleration_x"].attrs["between_samples"] == "band_limited"


@pytest.mark.parametrize("name", ["run.csv", "run.toml"])
def test_a_description_that_is_not_utf_8_is_named(name: str, tmp_path: Path) -> None:
    stored(tmp_path / "run.csv")
    (tmp_path / "run.toml").write_bytes('title = "Größe"'.encode("latin-1") + COLUMNS.encode())
    with pytest.raises(InputError, match=r"run.toml is not UTF-8 text; save it as UTF-8"):
        rocking.simulate(SPECIMEN, tmp_path / name)


def test_a_recording_is_one_wherever_it_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By a path into the data folder as by its own: the same samples, between them the same motion."""
    (tmp_path / "runs").mkdir()
    own = rocking.simulate(SPECIMEN, stored(tmp_path / "runs" / "run.nc"), duration=0.3)
    monkeypatch.setenv("ROCKING_DATA", str(tmp_path))
    assert rocking.simulate(SPECIMEN, "runs/run.nc", duration=0.3).equals(own)


def test_what_a_motion_cannot_be_asked_for_is_refused() -> None:
    motion = rocking.read_motion("ridgecrest_2019_clc")
    with pytest.raises(InputError, match="was read with its component: leave 'north' out"):
        rocking.simulate(SPECIMEN, motion, component="north")
    assert rocking.simulate(SPECIMEN, motion, duration="300 ms").sizes["time"] == round(0.3 / motion.time_step) + 1
