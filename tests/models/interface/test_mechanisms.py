"""Mechanisms of other families on a wall between two layers."""

import numpy as np
import pytest

from models.errors import InputError
from models.shaking import Shaking
from tests.models.interface.walls import MODEL, SHORT, wall

TIME = 0.01 * np.arange(151)
ACROSS, UP = 1.5 * np.sin(2 * np.pi * 1.3 * TIME), 2.0 * np.sin(2 * np.pi * 4.0 * TIME)


def channels(values, shaking):
    return MODEL.simulate({**SHORT, **values}, shaking).channels


@pytest.mark.parametrize("null", [{"pivot_inset.inset_over_half_width": 0.0}, {"vertical_acceleration.kappa": 0.0}])
def test_at_its_null_a_mechanism_changes_nothing(null) -> None:
    shaking = Shaking(0.01, ACROSS, UP)
    for name, expected in channels({}, shaking).items():
        np.testing.assert_array_equal(channels(null, shaking)[name], expected)


def test_an_inset_shortens_the_base_strip_at_equal_stiffness_per_metre() -> None:
    plain, inset = wall(SHORT), wall({**SHORT, "pivot_inset.inset_over_half_width": 0.2})
    assert inset.base_half_width[0] == pytest.approx(0.8 * plain.base_half_width[0])
    assert inset.base_stiffness[0] == plain.base_stiffness[0]
    assert inset.top_half_width[0] == plain.top_half_width[0]
    assert MODEL.derive({**SHORT, "pivot_inset.inset_over_half_width": 0.2})["static_compression_base"][
        0
    ] == pytest.approx(MODEL.derive(SHORT)["static_compression_base"][0] / 0.8)


def test_all_of_the_vertical_motion_as_a_mechanism_is_the_vertical_motion() -> None:
    acting = channels({}, Shaking(0.01, ACROSS, UP))
    left_out = Shaking(0.01, ACROSS, UP, vertical_acts=False)
    for name, found in channels({"vertical_acceleration.kappa": 1.0}, left_out).items():
        np.testing.assert_array_equal(found, acting[name])
    assert np.max(np.abs(channels({}, left_out)["rotation_1"] - acting["rotation_1"])) > 1e-6
    with pytest.raises(InputError, match="acts already"):
        channels({"vertical_acceleration.kappa": 0.5}, Shaking(0.01, ACROSS, UP))
