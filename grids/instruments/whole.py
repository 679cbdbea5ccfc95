"""Instruments on whole records: what the base really did, and what was recorded."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grids.instruments.base import Channels, Surroundings, Switched
from grids.instruments.catalogue import switched_on
from models.base import FloatArray
from models.shaking import Shaking


def moved(shaking: Shaking, mechanisms: Switched) -> Shaking:
    """The motion that the base makes when ``shaking`` is what its accelerometers read."""
    for sensor, values in switched_on(mechanisms):
        if "base" in sensor.acts:
            shaking = sensor.acts["base"](shaking, values)
    return shaking


def recorded(channels: Channels, mechanisms: Switched, around: Surroundings) -> Channels:
    """Channels ``(..., n_times)`` as the instruments record them, from the true ones.

    ``around`` on the clock of the base; what a sensor reads of it comes as late as all else. Values before the first
    sample are those of the first sample, after the last those of the last.
    """
    rate, lag = 0.0, 0.0
    switched = switched_on(mechanisms)
    for sensor, values in switched:
        if "clock" in sensor.acts:
            more_rate, more_lag = sensor.acts["clock"](values)
            rate, lag = rate + more_rate, lag + more_lag
    found = dict(channels)
    if rate or lag:
        count = next(iter(found.values())).shape[-1]
        time = np.arange(count) * around.time_step
        at = (1.0 + rate) * time - lag

        def late(x: FloatArray) -> FloatArray:
            return np.asarray(np.apply_along_axis(lambda row: np.interp(at, time, row), -1, x))

        found = {k: late(x) for k, x in found.items()}
        around = replace(around, base_acceleration=late(around.base_acceleration))
    for sensor, values in switched:
        for where in ("response", "whole"):
            if where in sensor.acts:
                found = dict(sensor.acts[where](found, values, around))
    return found
