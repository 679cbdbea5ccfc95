"""Two stacked blocks: every mechanism, simulated, is seen by the screen and recovered by its own refit."""

from __future__ import annotations

from functools import cache

import pytest

import models
from diagnosis.fit.setup import base_fit, measure
from diagnosis.search.refit import Explanation
from grids.instruments import INSTRUMENTS
from grids.recordings.base import Recording
from tests.diagnosis.search.recovered import (
    SENSORS,
    assert_directions,
    assert_recovered,
    own_candidates,
    simulated,
    true_value,
)
from tests.diagnosis.stacks import TRUE, WALL

EFFECTS: dict[str, dict[str, float]] = {
    "vertical_acceleration": {"kappa": 1.0},
    "pivot_inset": {"inset_over_half_width": 0.05},
    "tilt": {"tilt": 0.004},
    "eccentricity": {"offset_over_half_width": 0.04},
    "table_pitch": {"pitch_per_acceleration": 0.0003, "low_pass_hz": 8.0},
    "restitution": {"factor_on_housner": 0.95},
    "viscous_damping": {"rate": 0.15},
    "coulomb_damping": {"over_m_g_b": 0.02},
    **SENSORS,
}
NOT_HERE = {"integrated_displacement": "it acts on whole recordings, and blocks are compared in windows"}


def recorded(name: str, seed: int) -> Recording:
    return simulated("stacked", TRUE, {name: EFFECTS[name]}, seed, 6.0)


@cache
def base(name: str) -> Explanation:
    return Explanation((), base_fit(WALL, measure(WALL, [recorded(name, seed) for seed in (1, 2)]), 0))


def test_every_mechanism_of_stacks_and_their_sensors_is_here() -> None:
    assert set(EFFECTS) | set(NOT_HERE) == set(models.get("stacked").mechanisms) | set(INSTRUMENTS)


@pytest.mark.parametrize("name", EFFECTS)
def test_the_direction_of_the_score_is_a_finite_difference(name: str) -> None:
    assert_directions(base(name).fitted, own_candidates(base(name), WALL, name, EFFECTS[name]))


@pytest.mark.parametrize("name", EFFECTS)
def test_a_simulated_effect_is_seen_and_recovered(name: str) -> None:
    before = base(name)
    assert_recovered(before, own_candidates(before, WALL, name, EFFECTS[name]), true_value(before, name, EFFECTS[name]))
