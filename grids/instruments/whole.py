"""Sensor mechanisms on whole records: what the base really did, and what was written down."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from grids.instruments.base import Channels, Surroundings
from models.base import Mechanism
from models.shaking import Shaking

Switched = Mapping[str, Mapping[str, float]]
"""Parameter values by mechanism, as in `Specimen.mechanisms`; other mechanisms are passed over."""


def switched_on(mechanisms: Switched) -> list[tuple[Mechanism, dict[str, float]]]:
    from grids.instruments import INSTRUMENTS

    return [(s, {**s.nulls, **mechanisms[name]}) for name, s in INSTRUMENTS.items() if name in mechanisms]


def moved(shaking: Shaking, mechanisms: Switched) -> Shaking:
    """The motion that the base makes when ``shaking`` is what its accelerometers say."""
    for sensor, values in switched_on(mechanisms):
        if "base" in sensor.acts:
            shaking = sensor.acts["base"](shaking, values)
    return shaking


def recorded(channels: Channels, mechanisms: Switched, time_step: float, measured_base: np.ndarray) -> Channels:
    """Channels ``(n_times,)`` as the instruments record them, from the true ones.

    ``measured_base`` (n_times,) in m s-2 is what the accelerometer of the base says. Values before the
    first sample are those of the first sample, after the last those of the last.
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
        time = np.arange(count) * time_step
        found = {k: np.interp((1.0 + rate) * time - lag, time, x) for k, x in found.items()}
    around = Surroundings(time_step, measured_base)
    for sensor, values in switched:
        if "response" in sensor.acts:
            found = dict(sensor.acts["response"](found, values, around))
    return found
