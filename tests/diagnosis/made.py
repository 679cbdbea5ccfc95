"""Recordings made by the plain reference of the model, for tests of the diagnosis."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

import numpy as np
from scipy.signal import butter, sosfiltfilt

import models
from grids.instruments import moved, recorded
from grids.instruments.base import Surroundings
from grids.recordings.base import Recording
from grids.specimen import Specimen
from models.shaking import Shaking

TIME_STEP = 0.005
PEAK = 0.1
"""rad, over which levels of instruments are given."""
TRUE = {"width": 0.2505, "height": 1.795, "mass": 540.0}
SPECIMEN = Specimen(
    title="test block",
    model="housner",
    parameters={"width": 0.25, "height": 1.8, "mass": 540.0},
    tolerance={"width": 0.005, "height": 0.005},
)


def motion(seed: int, duration: float = 9.0, pga: float = 3.0) -> Shaking:
    """Noise between .6 and 6 Hz under an envelope."""
    rng = np.random.default_rng(seed)
    count = round(duration / TIME_STEP) + 1
    time = np.arange(count) * TIME_STEP
    band = butter(3, [0.6, 6.0], "band", fs=1.0 / TIME_STEP, output="sos")
    signal = sosfiltfilt(band, rng.normal(size=count)) * np.minimum(1.0, time) * np.exp(-time / duration)
    signal[-1] = signal[0] = 0.0
    return Shaking(TIME_STEP, signal * pga / np.max(np.abs(signal)))


@lru_cache(maxsize=32)
def _made(
    name: str, seed: int, effect: tuple[tuple[str, tuple[tuple[str, float], ...]], ...], noise: float
) -> Recording:
    mechanisms = {k: dict(v) for k, v in effect}
    measured = motion(seed)
    model = models.get("housner")
    of_wall = {f"{m}.{k}": v for m, values in mechanisms.items() for k, v in values.items() if m in model.mechanisms}
    ran = model.simulate(
        {**TRUE, **of_wall}, moved(measured, mechanisms), duration=measured.duration, integrator="reference"
    )
    true = {"rotation_1": np.ravel(ran.channels["rotation_1"])}
    around = Surroundings(TIME_STEP, measured.horizontal, PEAK)
    seen = recorded(true, mechanisms, around)["rotation_1"]
    rng = np.random.default_rng(seed + 1000)
    peak = float(np.max(np.abs(seen)))
    channels = {
        "base_acceleration_x": measured.horizontal + 0.003 * measured.pga * rng.normal(size=seen.size),
        "rotation_1": seen + noise * peak * rng.normal(size=seen.size),
    }
    return Recording(name, TIME_STEP, np.arange(seen.size) * TIME_STEP, channels)


def recording(
    name: str, seed: int, effect: Mapping[str, Mapping[str, float]] | None = None, noise: float = 0.01
) -> Recording:
    """The recording of a block with an effect, at 1 % noise of the peak."""
    frozen = tuple((k, tuple(v.items())) for k, v in (effect or {}).items())
    return _made(name, seed, frozen, noise)
