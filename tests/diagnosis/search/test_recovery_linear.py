"""Walls on linear layers: what no recording holds is carried, and effects are seen by the screen and recovered."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import models
from diagnosis import calibrate
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.setup import base_fit, measure
from diagnosis.search.candidates import candidates
from diagnosis.search.refit import Explanation
from diagnosis.search.screen import score
from grids.recordings.base import Recording
from tests.diagnosis import walls
from tests.diagnosis.made import TIME_STEP, motion
from tests.diagnosis.search.recovered import assert_recovered
from tests.diagnosis.walls import NOISE, TRUE

WALL = replace(walls.WALL, title="wall on linear rubber", model="interface_linear")
EFFECTS = {"pivot_inset.inset_over_half_width": 0.06, "tilt.tilt": 0.004}


@cache
def recorded(name: str, seed: int) -> Recording:
    base = motion(seed, pga=1.6)
    values = {**TRUE, name: EFFECTS[name]} if name else TRUE
    ran = models.get("interface_linear").simulate(values, base, duration=base.duration)
    assert ran.outputs["uplift_duration_base"] > 0.5
    # not the seed of the motion: noise that is what the base moves by reads as a sensor that feels its acceleration
    rng, channels = np.random.default_rng([seed, 1]), {"base_acceleration_x": base.horizontal}
    for rotation in ("rotation_1", "rotation_2"):
        true = np.asarray(ran.channels[rotation])
        channels[rotation] = true + NOISE * np.max(np.abs(true)) * rng.normal(size=true.size)
    return Recording(f"run_{seed}", TIME_STEP, base.time, channels)


@cache
def base(name: str) -> Explanation:
    return Explanation((), base_fit(WALL, measure(WALL, [recorded(name, 1)]), 0))


def test_layers_are_recovered_from_both_rotations() -> None:
    found = calibrate(WALL, [recorded("", 1)], profile=False)
    for name, true in TRUE.items():
        if name in found.parameters:
            value = found.parameters[name]
            assert abs(value.estimate - true) < value.high95 - value.low95, name
    assert found.misfit_per_sample < 1.2


def test_where_nothing_is_missing_nothing_stands_out() -> None:
    plain = base("")
    seen = score(linearise_about(plain.fitted), candidates(plain.measured, WALL))
    assert {"tilt", "pivot_inset", "delay", "gain"} <= {s.candidate.name for s in seen}
    assert max(s.statistic for s in seen) < 15.0


@pytest.mark.parametrize("name", EFFECTS)
def test_a_simulated_effect_is_seen_and_recovered(name: str) -> None:
    own = [c for c in candidates(base(name).measured, WALL) if c.name == name.partition(".")[0]]
    assert_recovered(base(name), own, EFFECTS[name])
