"""Levels of a recording go by their numbers: in any order, not all of them, none twice and none without a number."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray

from grids.recordings import read_recording
from grids.recordings.levels import level_by_level, level_of
from models.errors import InputError

TIME = 0.01 * np.arange(100)
BASE = np.sin(3.0 * TIME)


def stored(folder: Path, levels: Sequence[float | str] | None) -> Path:
    """A recording of two levels, the second of which moves twice as far."""
    rows = np.stack([BASE, 2.0 * BASE])
    data = xarray.Dataset(
        {
            "base_acceleration_x": ("time", BASE, {"units": "m s-2"}),
            "level_displacement_x": (("level", "time"), rows, {"units": "m"}),
        },
        coords={"time": ("time", TIME, {"units": "s"})} | ({} if levels is None else {"level": list(levels)}),
    )
    path = folder / "run.nc"
    data.to_netcdf(path)
    return path


@pytest.mark.parametrize(
    ("levels", "names"),
    [(None, ("0", "1")), ([3.0, 1.0], ("3", "1")), (["05", "2"], ("5", "2"))],
)
def test_a_row_is_of_the_level_that_the_file_says(
    levels: Sequence[float | str] | None, names: tuple[str, str], tmp_path: Path
) -> None:
    found = read_recording(stored(tmp_path, levels))
    assert found.levels == names
    split = level_by_level(found).channels
    np.testing.assert_array_equal(split[f"level_displacement_x_{names[0]}"], BASE)
    np.testing.assert_array_equal(split[f"level_displacement_x_{names[1]}"], 2.0 * BASE)


@pytest.mark.parametrize(
    ("levels", "said"),
    [
        ([1.0, 1.0], "level 1 stands twice in 1, 1: give every level"),
        ([0.0, 1.5], "level '1.5' is no whole number from 0: number"),
        ([0.0, -1.0], "level '-1' is no whole number"),
        ([0.0, np.nan], "level 'nan' is no whole number"),
        (["slab", "roof"], "level 'slab' is no whole number"),
    ],
)
def test_levels_without_a_number_of_their_own_are_refused(
    levels: Sequence[float | str], said: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=f"recording run.nc: {said}"):
        read_recording(stored(tmp_path, levels))


@pytest.mark.parametrize("over", [(), ("time",)])
def test_levels_over_another_dimension_are_refused(over: tuple[str, ...], tmp_path: Path) -> None:
    path = stored(tmp_path, None)
    with netCDF4.Dataset(path, "a") as data:
        data.createVariable("level", "f8", over)[...] = 3.0
    with pytest.raises(InputError, match=r"recording run.nc: level is over .*; it belongs over \('level',\)"):
        read_recording(path)


def test_levels_of_another_type_are_refused(tmp_path: Path) -> None:
    path = stored(tmp_path, None)
    with netCDF4.Dataset(path, "a") as data:
        data.createVariable("level", "S1", ("level",))[:] = np.array([b"0", b"1"])
    with pytest.raises(InputError, match=r"level holds .*, not numbers; number the levels from 0"):
        read_recording(path)


def mapped(written: Callable[[str, str], Path], *levels: str) -> Path:
    columns = "".join(f'level_displacement_x_{k} = {{ column = "x", unit = "m" }}\n' for k in levels)
    base = 'base_acceleration_x = { column = "a", unit = "m/s2" }\n'
    written("run.toml", f'time_step = "0.01 s"\n[columns]\n{base}{columns}')
    return written("run.csv", "a,x\n" + "".join(f"{a},{2.0 * a}\n" for a in BASE))


def test_the_roof_alone_is_the_roof(written: Callable[[str, str], Path]) -> None:
    found = read_recording(mapped(written, "3"))
    assert found.levels == ("3",)
    assert set(level_by_level(found).channels) == {"base_acceleration_x", "level_displacement_x_3"}


def test_two_columns_of_one_level_are_refused(written: Callable[[str, str], Path]) -> None:
    with pytest.raises(InputError, match=r"recording run.csv: level 0 stands twice in 0, 0: give every level"):
        read_recording(mapped(written, "0", "00"))


def test_only_channels_by_level_are_of_a_level() -> None:
    assert level_of("level_displacement_x_11") == 11
    assert level_of("level_displacement_x") is level_of("rotation_1") is None
