"""Samples of what was found, as an axis of a study."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from grids.plan import parse_plan
from models.errors import InputError

PLAN = """
[study]
name = "found"
model = "housner"
[motion]
pulse = {{ shape = "half_sine", amplitude = "0.5 g", duration = "0.5 s" }}
[parameters]
height = "1.8 m"
mass = 500
[samples]
from = "posterior.nc"
{more}
[axes]
pga = {{ values = [0.1, 0.2], unit = "g" }}
{axes}
"""
WIDTH, INSET = np.array([0.24, 0.25, 0.26]), np.array([0.02, 0.05, 0.08])


def write(folder: Path, **changes: tuple[np.ndarray, str]) -> None:
    held = {"width": (1e3 * WIDTH, "mm"), "pivot_inset.inset_over_half_width": (INSET, "1"), **changes}
    data = {name: ("sample", values, {"units": unit}) for name, (values, unit) in held.items()}
    xr.Dataset(data).to_netcdf(folder / "posterior.nc")


def test_samples_set_their_names_together_as_the_first_axis(tmp_path: Path) -> None:
    write(tmp_path)
    plan = parse_plan(PLAN.format(more="", axes=""), tmp_path)
    assert [axis.name for axis in plan.axes] == ["sample", "pga"] and plan.grid.size == 6
    np.testing.assert_allclose(plan.axes[0].sets["width"], WIDTH)
    np.testing.assert_allclose(plan.axes[0].sets["pivot_inset.inset_over_half_width"], INSET)
    fewer = parse_plan(PLAN.format(more="count = 2", axes=""), tmp_path)
    np.testing.assert_allclose(fewer.axes[0].sets["width"], WIDTH[:2])


@pytest.mark.parametrize(
    ("more", "axes", "changes", "said"),
    [
        ("count = 9", "", {}, "the file holds 3 samples"),
        ("", 'width = { values = ["0.2 m"] }', {}, "'width' is set by .samples. and by .axes. width"),
        ("", "sample = { sobol = 4, seed = 1, parameters = { restitution = [0.8, 0.9] } }", {}, "call that of .axes. "),
        ("", "", {"gain.gain": (INSET, "1")}, "gain"),
        ("", "", {"width": (-WIDTH, "m")}, "width"),
        ("", "", {"wdith": (WIDTH, "m")}, "width"),
        ("", "", {"width": (WIDTH, "kg")}, "kg"),
    ],
)
def test_refusals(tmp_path: Path, more: str, axes: str, changes: dict[str, tuple[np.ndarray, str]], said: str) -> None:
    write(tmp_path, **changes)
    with pytest.raises(InputError, match=said):
        parse_plan(PLAN.format(more=more, axes=axes), tmp_path)


def test_a_missing_file_is_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"\[samples\] from = 'posterior.nc'"):
        parse_plan(PLAN.format(more="", axes=""), tmp_path)
