"""A wall of which no recording holds all states, with a law of its layers, recorded without noise."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

import models
from diagnosis.data.measured import Measured
from diagnosis.fit.setup import measure
from grids.instruments import recorded as instrumented
from grids.instruments.base import Surroundings, Switched
from grids.recordings.base import Recording
from grids.specimen import Specimen
from models.piecewise import Part, simulate
from tests.diagnosis.made import TIME_STEP, motion
from tests.models.interface.carried import WALL as TRUE

HARDENING = {"hardening.beta2": 60.0}
WALL = Specimen("wall on rubber", "interface", TRUE, tolerance={"wall_height": 0.005})
MODEL = models.get("interface")
PEAK = 0.005
BASE = motion(1, pga=3.0)


@cache
def made(law: tuple[tuple[str, float], ...], begins: int = 0) -> Recording:
    """A recording without noise of a wall with a law, from a sample on."""
    parts = [Part(0, TRUE), Part(begins, {**TRUE, **dict(law)})] if begins else [Part(0, {**TRUE, **dict(law)})]
    ran = simulate(MODEL, parts, BASE, duration=BASE.duration)
    names = ("rotation_1", "rotation_2", "rotation_rate_1", "rotation_rate_2")
    channels = {name: np.asarray(ran.channels[name]) for name in names}
    return Recording("shake_1", TIME_STEP, BASE.time, {"base_acceleration_x": BASE.horizontal, **channels})


def seen(recording: Recording, instruments: Switched) -> Recording:
    """Without the rates, and as the instruments record it."""
    true = {name: recording.channels[name] for name in ("rotation_1", "rotation_2")}
    around = Surroundings(TIME_STEP, BASE.horizontal, PEAK)
    channels = instrumented(true, instruments, around)
    return replace(recording, channels={"base_acceleration_x": BASE.horizontal, **channels})


def measured_of(recording: Recording) -> Measured:
    """Its windows, levels of instruments over `PEAK`."""
    return measure(WALL, [recording], PEAK)
