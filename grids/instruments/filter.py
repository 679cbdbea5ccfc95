"""A causal Butterworth filter in the response channels.

The filter acts on the signal taken as linear between samples, so that a corner above the Nyquist
frequency of the recording keeps its meaning. In windows it is applied in two parts: its delay of slow signals,
as a clock error, and the filter advanced by that delay. So a window that starts at a recorded peak
starts at the peak of the motion too, and what came before its first sample is the parabola through
the first samples.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from grids.instruments.base import Channels, Surroundings
from models.base import FloatArray, Mechanism, MechanismParameter, Values

Kind = Literal["lowpass", "highpass"]
LEAD_IN = 0.2
"""s of parabola before the first sample."""
FITTED = 8
"""Samples through which the parabola is laid."""


class Discrete(NamedTuple):
    """A filter for an input linear between samples: its polynomials in z^-1, and what it makes of a constant one."""

    numerator: NDArray[np.float64]
    denominator: NDArray[np.float64]
    steady: float


@lru_cache(maxsize=4096)
def discrete(corner_hz: float, order: int, kind: Kind, time_step: float) -> Discrete:
    """The Butterworth filter for samples ``time_step`` (s) apart."""
    from scipy.signal import butter, cont2discrete, ss2tf, tf2ss

    numerator, denominator = butter(order, 2.0 * np.pi * corner_hz, btype=kind, analog=True, output="ba")
    a, b, c, d, _ = cont2discrete(tf2ss(numerator, denominator), time_step, method="foh")
    rows, poles = ss2tf(a, b, c, d)
    unit = np.linalg.solve(np.eye(a.shape[0]) - a, b[:, 0])
    return Discrete(rows[0], poles, float(c[0] @ unit + d[0, 0]))


@lru_cache(maxsize=64)
def backwards(few: int, count: int) -> NDArray[np.float64]:
    """Takes ``few`` samples to the ``count`` before them (few, count) on the parabola through them."""
    bend = np.linalg.pinv(np.vander(np.arange(few), 3, increasing=True).astype(float))
    return np.asarray((np.vander(np.arange(-count, 0), 3, increasing=True).astype(float) @ bend).T)


def stages(values: Values) -> list[tuple[float, int, Kind]]:
    order = round(float(values["order"]))
    found: list[tuple[float, int, Kind]] = []
    if np.isfinite(values["corner_hz"]):
        found.append((float(values["corner_hz"]), order, "lowpass"))
    if values["high_pass_hz"] > 0.0:
        found.append((float(values["high_pass_hz"]), order, "highpass"))
    return found


def run(system: Discrete, signal: FloatArray, time_step: float) -> FloatArray:
    """Output of the filter for signals (..., samples), each led in by its own parabola."""
    from scipy.signal import lfilter

    count = int(np.ceil(LEAD_IN / time_step))
    few = min(FITTED, signal.shape[-1])
    whole = np.concatenate([signal[..., :few] @ backwards(few, count), signal], axis=-1)
    first = whole[..., :1]
    passed = lfilter(system.numerator, system.denominator, whole - first, axis=-1) + system.steady * first
    return np.asarray(passed)[..., count:]


def delay(values: Values) -> float:
    """Delay (s) of slow signals: b_1/omega_c with b_1 the linear coefficient of the Butterworth polynomial."""
    found = 0.0
    for corner, order, kind in stages(values):
        if kind == "lowpass":
            # the poles lie on the unit circle: the coefficient is the sum of -Re(poles)
            poles = sum(np.sin(np.pi * (2 * k + 1) / (2 * order)) for k in range(order))
            found += poles / (2.0 * np.pi * corner)
    return float(found)


def respond(channels: Channels, values: Values, around: Surroundings) -> Channels:
    for corner, order, kind in stages(values):
        system = discrete(corner, order, kind, around.time_step)
        channels = {name: run(system, x, around.time_step) for name, x in channels.items()}
    return channels


def respond_in_windows(channels: Channels, values: Values, around: Surroundings) -> Channels:
    advance = delay(values) / around.time_step
    filtered = respond(channels, values, around)
    return {name: shifted(x, advance) for name, x in filtered.items()} if advance else filtered


def shifted(signal: FloatArray, advance: float) -> FloatArray:
    """The signal read ``advance`` samples later; the last value is held. nan between samples that are not finite."""
    from scipy.interpolate import CubicSpline

    index = np.arange(signal.shape[-1])
    at, finite = np.minimum(index + advance, index[-1]), np.isfinite(signal)
    found = np.asarray(CubicSpline(index, np.where(finite, signal, 0.0), axis=-1)(at))
    low, high = np.floor(at).astype(int), np.ceil(at).astype(int)
    return np.where(finite[..., low] & finite[..., high], found, np.nan)


MECHANISM = Mechanism(
    name="filter",
    effect_class="filter",
    parameters=(
        MechanismParameter(
            "corner_hz", "f_c", "Hz", "corner of the low-pass of the response channels", 0.5, 60.0,
            null=np.inf, fit_inverse=True,
        ),
        MechanismParameter("order", "n_f", "1", "order of the Butterworth filter", 1.0, 4.0, null=2.0, shape=True),
        MechanismParameter(
            "high_pass_hz", "f_h", "Hz", "corner of a high-pass of the response channels", 0.0, 5.0, shape=True
        ),
    ),
    equation="recorded = causal Butterworth low-pass (corner_hz, order) of true, every response channel",
    signature="at impacts and above the corner; a lag of all channels",
    sentence="the response channels went through a causal low-pass of order {order:.0f} at {corner_hz:.3g} Hz",
    sentences={
        "high_pass_hz": "the response channels went through a causal high-pass of order {order:.0f} at "
        "{high_pass_hz:.3g} Hz"
    },
    acts={"response": respond, "lag": delay, "windowed": respond_in_windows},
    static_test="look up the filter settings of the logger",
    source="anti-alias and display filters of loggers",
)  # fmt: skip
