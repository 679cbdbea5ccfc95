"""The small cube that ships is one that today's commands read."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from models.errors import InputError
from study.open import open_study
from tests.study.cubes import EXAMPLE


def test_the_committed_cube_opens_and_maps() -> None:
    cube = open_study(EXAMPLE)
    onset = cube.rocking.onset_map(x="aspect_ratio", y="top_mass")
    # the more slender the wall, the earlier it rocks
    assert np.all(np.diff(onset.max("top_mass")) >= 0.0)
    assert EXAMPLE.stat().st_size < 1_000_000


@pytest.mark.parametrize("lazy", [False, True])
def test_outputs_by_name_suffice_for_maps(lazy: bool) -> None:
    whole = open_study(EXAMPLE)
    for named in ("peak_rotation", ["peak_rotation"], ("status", "peak_rotation")):
        with open_study(EXAMPLE, named, lazy=lazy) as cube:
            assert set(cube.data_vars) == {"peak_rotation", "status"}
            maps = [one.rocking.onset_map(x="aspect_ratio", y="top_mass") for one in (cube, whole)]
            xr.testing.assert_equal(*maps)
    for wrong in (["peak_rotaton"], "peak_rotaton"):
        with pytest.raises(InputError, match=r"has no output 'peak_rotaton'; did you mean 'peak_rotation'"):
            open_study(EXAMPLE, wrong, lazy=lazy)
