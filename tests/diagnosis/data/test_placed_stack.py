"""Two stacked blocks without a recorded rotation: gauges in both joints tell both."""

from __future__ import annotations

import numpy as np

import models
from diagnosis.fit.setup import measure
from grids.recordings.base import Recording
from grids.specimen import Specimen
from models.kinematics import Place
from tests.diagnosis.made import motion

WALL = {
    "wall_length": 0.6, "wall_height": 1.8, "wall_mass": 900.0, "top_mass": 700.0, "top_length": 0.5, "top_height": 0.4,
}  # fmt: skip
PLACES = {
    "base_left": Place("uplift", 1, -0.3),
    "base_right": Place("uplift", 1, 0.3),
    "joint_left": Place("uplift", 2, -0.25),
    "joint_right": Place("uplift", 2, 0.25),
}


def test_both_rotations_are_estimated_from_gauges_in_the_joints() -> None:
    shaking = motion(5, pga=6.0)
    ran = models.get("stacked").simulate(WALL, shaking, duration=shaking.duration)
    ground = shaking.horizontal, np.zeros_like(shaking.horizontal)
    rng = np.random.default_rng(0)
    channels = {"base_acceleration_x": shaking.horizontal}
    for name, place in PLACES.items():
        true = place.read(ran.channels, shaking.time_step, ground)
        channels[name] = true + 1e-5 * rng.normal(size=true.size)
    recording = Recording("run", shaking.time_step, ran.time, channels, places=PLACES)
    specimen = Specimen("stack", "stacked", WALL, tolerance={"wall_length": 0.01})
    measured = measure(specimen, [recording])
    assert measured.channels == tuple(PLACES)
    for name in ("rotation_1", "rotation_2"):
        error = measured.recordings[0].channels[name] - ran.channels[name]
        assert np.max(np.abs(ran.channels[name])) > 0.01
        assert np.max(np.abs(error)) < 2e-4
