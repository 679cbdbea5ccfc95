"""The largest rotations of a run that ends at any instant, also while a body still moves outwards."""

from __future__ import annotations

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st

from models.shaking import Shaking
from models.stacked.model import MODEL
from tests.models.stacked.walls import random_wall
from tests.models.strategies import SEEDS, random_motion

OUTWARDS = {
    "wall_length": 0.7259, "wall_height": 2.0, "wall_mass": 1000.0, "top_mass": 2452.7558, "top_length": 0.7248,
    "top_height": 0.6983,
}  # fmt: skip
TIME = 0.01 * np.arange(131)
PULSE = Shaking(0.01, 3.0 * np.sin(2.0 * np.pi * TIME) * (TIME < 0.8))


def peaks_hold(values: dict[str, float], shaking: Shaking, scale: float, duration: float) -> None:
    here, there = (
        MODEL.simulate(values, shaking, scale=scale, duration=duration, integrator=integrator)
        for integrator in MODEL.integrators
    )
    near = MODEL.simulate(values, shaking, scale=scale * (1.0 + 1e-7), duration=duration)
    for body in ("1", "2"):
        peak = here.outputs[f"peak_rotation_{body}"]
        assert peak >= abs(here.outputs[f"residual_rotation_{body}"])
        assert peak >= np.max(np.abs(here.channels[f"rotation_{body}"]))
        if not here.outputs["overturned"]:
            # after dozens of impacts a stack that makes much of a change of the motion by 1e-7 makes much of any step
            grown = abs(near.outputs[f"peak_rotation_{body}"] - peak)
            expected = there.outputs[f"peak_rotation_{body}"]
            np.testing.assert_allclose(peak, expected, rtol=1e-4, atol=1e-7 + grown)


@given(st.integers(1, 130))
@example(130)
@settings(max_examples=4)
def test_a_pulse_that_is_cut_short(samples: int) -> None:
    peaks_hold(OUTWARDS, PULSE, 1.0, 0.01 * samples)


@given(SEEDS)
@example(262145)
@settings(max_examples=4)
def test_random_walls_and_durations(seed: int) -> None:
    rng = np.random.default_rng(seed)
    values, shaking = random_wall(rng), random_motion(rng, duration=3.0)
    onset = float(MODEL.derive(values)["onset_acceleration"][0])
    peaks_hold(values, shaking, onset * float(rng.uniform(1.2, 3.0)), 0.01 * int(rng.integers(1, 200)))
