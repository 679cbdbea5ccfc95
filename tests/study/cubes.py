"""The cube that ships, one whose answers are known, and cubes compared bit for bit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr

EXAMPLE = Path(__file__).resolve().parents[2] / "results" / "example.nc"


def assert_identical(one: xr.Dataset, two: xr.Dataset) -> None:
    """Data variables and coordinates equal in every bit, attributes of the variables too."""
    assert list(one.variables) == list(two.variables)
    for name in one.variables:
        a, b = one[name], two[name]
        assert a.dims == b.dims and a.dtype == b.dtype, name
        if a.dtype.kind in "OU":
            assert a.values.tolist() == b.values.tolist(), name
        else:
            assert a.values.tobytes() == b.values.tobytes(), name
        assert str(a.attrs) == str(b.attrs), name


def known_cube(random: np.random.Generator, shape: tuple[int, int, int] = (4, 5, 6)) -> xr.Dataset:
    """A cube of random outcomes over aspect_ratio, top_mass and pga (not sorted)."""
    status = random.choice(range(7), size=shape, p=[0.02, 0.4, 0.3, 0.22, 0.02, 0.02, 0.02])
    pga = random.permutation(np.linspace(1.0, 6.0, shape[2]))
    cube = xr.Dataset(
        {"status": (("aspect_ratio", "top_mass", "pga"), status.astype(np.int8))},
        coords={
            "aspect_ratio": np.linspace(0.1, 0.4, shape[0]),
            "top_mass": np.linspace(0.0, 4000.0, shape[1]),
            "pga": ("pga", pga, {"units": "m s-2", "long_name": "peak of the horizontal acceleration"}),
        },
    )
    cube["peak_rotation"] = cube["status"] * 0.1
    for name, unit in (("aspect_ratio", "1"), ("top_mass", "kg"), ("pga", "m s-2")):
        cube[name].attrs |= {"units": unit, "axis_of_study": "true"}
    return cube
