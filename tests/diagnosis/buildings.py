"""A body on rubber, and simulated tests of it."""

from __future__ import annotations

import numpy as np

import models
from grids.recordings.base import Recording
from grids.specimen import Specimen
from models.shaking import Shaking

STEP, COUNT = 0.02, 2200
BODY = {"levels": 1.0, "total_mass": 1.0, "rubber_thickness": 0.2}
BEARINGS = {"bearing_stiffness": 14.0, "bearing_damping": 0.5}
SPECIMEN = Specimen(
    title="a body on rubber", model="isolated", parameters=BODY,
    calibrate={"bearing_stiffness": (2.0, 60.0), "bearing_damping": (0.05, 5.0)},
)  # fmt: skip


def made(name: str, peak: float, seed: int, **laws: float) -> Recording:
    """A simulated test with 1 % noise; the base has energy from .15 to 4 Hz."""
    rng = np.random.default_rng(seed)
    time = STEP * np.arange(COUNT)
    frequency = np.fft.rfftfreq(COUNT, STEP)
    spectrum = np.fft.rfft(rng.normal(size=COUNT)) * (frequency > 0.15) * np.exp(-0.5 * (frequency / 2.0) ** 2)
    envelope = np.clip(time - 5.0, 0.0, 5.0) / 5.0 * np.exp(-np.clip(time - 30.0, 0.0, None) / 5.0)
    base = np.fft.irfft(spectrum, COUNT) * envelope
    base *= peak / np.max(np.abs(base))
    ran = models.get("isolated").simulate({**BODY, **BEARINGS, **laws}, Shaking(STEP, base), duration=time[-1])
    x = np.asarray(ran.channels["level_displacement_x"])
    x = x + 0.01 * np.std(x) * rng.normal(size=x.shape)
    levels = tuple(str(level) for level in range(x.shape[0]))
    return Recording(name, STEP, time, {"base_acceleration_x": base, "level_displacement_x": x}, levels)
