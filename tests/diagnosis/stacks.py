"""Two stacked blocks, and one that rocks on a wall, with simulated recordings of both."""

from __future__ import annotations

from functools import cache

import numpy as np

import models
from grids.recordings.base import Recording
from grids.specimen import Specimen
from models.shaking import Shaking
from tests.diagnosis.made import TIME_STEP, motion

REST = {"wall_mass": 800.0, "top_mass": 400.0, "top_length": 0.6, "top_height": 0.5}
TRUE = {"wall_length": 0.602, "wall_height": 1.995, **REST}
WALL = Specimen(
    title="two blocks",
    model="stacked",
    parameters={"wall_length": 0.6, "wall_height": 2.0, **REST},
    tolerance={"wall_length": 0.005, "wall_height": 0.005},
)
NOISE = 0.01
"""Of each rotation's peak."""
ON_TOP = {
    "wall_length": 0.354, "wall_height": 1.41, "wall_mass": 458.0, "top_mass": 200.0, "top_length": 0.236,
    "top_height": 0.93,
}  # fmt: skip
STILL = 1.5
"""s, that tell sensors' noise from what a model gets wrong."""


@cache
def recorded(seed: int) -> Recording:
    """Both rotations with white noise of 1 % of their peaks."""
    base = motion(seed, pga=6.0)
    ran = models.get("stacked").simulate(TRUE, base, duration=base.duration)
    rng = np.random.default_rng(seed + 1000)  # not the one that made the motion: noise would go with it
    channels = {"base_acceleration_x": base.horizontal}
    for name in ("rotation_1", "rotation_2"):
        true = ran.channels[name]
        channels[name] = true + NOISE * np.max(np.abs(true)) * rng.normal(size=true.size)
    return Recording(f"run_{seed}", TIME_STEP, base.time, channels)


@cache
def rocking_on_top(seed: int, both: bool) -> Recording:
    """A block on a wall after `STILL` at rest: ``both`` rotations, or the wall's alone."""
    strong = motion(seed, duration=7.0, pga=4.5).horizontal
    base = Shaking(TIME_STEP, np.concatenate([np.zeros(round(STILL / TIME_STEP)), strong]))
    ran = models.get("stacked").simulate(ON_TOP, base, duration=base.duration)
    rng = np.random.default_rng(seed)
    channels = {"base_acceleration_x": base.horizontal}
    for name in ("rotation_1", "rotation_2")[: 1 + both]:
        rotation = np.asarray(ran.channels[name])
        channels[name] = rotation + 0.01 * np.max(np.abs(rotation)) * rng.normal(size=rotation.size)
    return Recording(f"run_{seed}", TIME_STEP, base.time, channels)
