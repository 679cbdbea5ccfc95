"""A wall on rubber whose layers a laboratory does not know, and simulated recordings of it."""

from __future__ import annotations

from functools import cache

import numpy as np

import models
from diagnosis.data.measured import Measured
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Predictor
from diagnosis.fit.unknowns import fixed_values, of_specimen
from diagnosis.fit.whitening import sensor_noise_only
from grids.recordings.base import Recording
from grids.specimen import Specimen
from tests.diagnosis.made import TIME_STEP, motion

KNOWN = {
    "wall_length": 0.72, "wall_mass": 161.0, "top_mass": 5000.0, "top_length": 0.72, "top_height": 0.6,
    "layer_thickness": 0.01,
}  # fmt: skip
LAYERS = {"base_stiffness": 4.0e7, "top_stiffness": 4.6e7, "base_damping": 6.0e5, "top_damping": 5.0e5}
TRUE = {**KNOWN, **LAYERS, "wall_height": 1.806}
WALL = Specimen(
    title="wall on rubber",
    model="interface",
    parameters={**KNOWN, "wall_height": 1.8},
    tolerance={"wall_height": 0.005},
    calibrate={name: (value / 2.5, value * 2.5) for name, value in LAYERS.items()},
)
NOISE = 0.01
"""Of each rotation's peak."""
MAXWELL = {"maxwell.arm_stiffness_ratio": 0.6, "maxwell.relaxation_time": 0.1}


@cache
def recorded(seed: int, law: tuple[tuple[str, float], ...] = ()) -> Recording:
    """Both rotations with white noise, of the wall with a law of its layers or another mechanism."""
    base = motion(seed, pga=3.0)
    ran = models.get("interface").simulate({**TRUE, **dict(law)}, base, duration=base.duration)
    rng = np.random.default_rng(seed)
    channels = {"base_acceleration_x": base.horizontal}
    for name in ("rotation_1", "rotation_2"):
        true = np.asarray(ran.channels[name])
        channels[name] = true + NOISE * np.max(np.abs(true)) * rng.normal(size=true.size)
    return Recording(f"run_{seed}", TIME_STEP, base.time, channels)


def misfit(measured: Measured) -> Misfit:
    """Of the specimen against white noise of the sensors."""
    unknowns = of_specimen(WALL, measured.model)
    predictor = Predictor(measured, coordinates=("base_stiffness", "top_stiffness"))
    return Misfit(predictor, sensor_noise_only(predictor), unknowns, fixed_values(WALL))
