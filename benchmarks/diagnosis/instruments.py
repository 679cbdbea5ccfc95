"""From the true motion to what the instruments wrote: the benchmark's own, apart from the diagnosis.

A recorded rotation is, in this order:

    theta(t) + rotation_per_acceleration a(t), times (1 + gain), through a Butterworth low-pass, causal or run both
    ways (zero phase), read at (1 + rate) t - delay, plus an offset, plus a drift, through the logger's anti-alias
    filter (no phase shift), sampled, clipped at the saturation level, plus noise.

The recorded base acceleration is a / (1 + base_gain), through a causal first-order high-pass and a causal
second-order Butterworth low-pass, plus accelerometer_offset, through the same logger.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.signal import butter, sosfilt, sosfiltfilt

FloatArray = NDArray[np.float64]
Sensors = Mapping[str, Mapping[str, float]]

PASS_BAND = 0.42
"""Corner of the anti-alias filter over the sampling frequency."""


def base(acceleration: FloatArray, time_step: float, sensors: Sensors) -> FloatArray:
    """The horizontal accelerometer's signal (m s-2)."""
    signal = acceleration / (1.0 + sensors.get("base_gain", {}).get("gain", 0.0))
    filters = sensors.get("base_filter", {})
    if filters.get("high_pass_hz", 0.0) > 0.0:
        signal = causal(signal, time_step, 1, filters["high_pass_hz"], "highpass")
    if np.isfinite(filters.get("low_pass_hz", np.inf)):
        signal = causal(signal, time_step, 2, filters["low_pass_hz"], "lowpass")
    return signal + sensors.get("accelerometer_offset", {}).get("offset", 0.0)


def causal(signal: FloatArray, time_step: float, order: int, corner_hz: float, kind: str) -> FloatArray:
    """Through a Butterworth filter, from rest."""
    return np.asarray(sosfilt(butter(order, corner_hz, kind, fs=1.0 / time_step, output="sos"), signal))


def both_ways(signal: FloatArray, time_step: float, order: int, corner_hz: float, kind: str) -> FloatArray:
    """Through a Butterworth filter forwards and backwards."""
    return np.asarray(sosfiltfilt(butter(order, corner_hz, kind, fs=1.0 / time_step, output="sos"), signal))


def response(
    rotation: FloatArray, acceleration: FloatArray, time_step: float, sensors: Sensors, peak: float
) -> FloatArray:
    """The rotation sensor's signal (rad) on the same times; ``peak`` (rad) scales offset and saturation."""

    def of(name: str, parameter: str, null: float = 0.0) -> float:
        return sensors.get(name, {}).get(parameter, null)

    signal = rotation + of("cross_axis", "rotation_per_acceleration") * acceleration
    signal = signal * (1.0 + of("gain", "gain"))
    if np.isfinite(corner := of("filter", "corner_hz", np.inf)):
        through = both_ways if of("filter", "zero_phase") else causal
        signal = through(signal, time_step, round(of("filter", "order", 2.0)), corner, "lowpass")
    rate, delay = of("clock", "rate"), of("delay", "delay")
    if rate != 0.0 or delay != 0.0:
        time = time_step * np.arange(signal.size)
        read = np.clip((1.0 + rate) * time - delay, 0.0, time[-1])
        signal = CubicSpline(time, signal)(read)
    signal = signal + of("offset", "offset_over_peak") * peak
    signal = signal + of("drift", "rate") * time_step * np.arange(signal.size)
    return clip(signal, sensors, peak)


def clip(signal: FloatArray, sensors: Sensors, peak: float) -> FloatArray:
    """The signal within the saturation level."""
    level = sensors.get("saturation", {}).get("level_over_peak", np.inf) * peak
    return np.clip(signal, -level, level)


def logged(signal: FloatArray, time_step: float, sampling_hz: float, duration: float) -> FloatArray:
    """Anti-alias filtered without phase shift and sampled at ``sampling_hz`` over ``duration`` (s)."""
    smooth = both_ways(signal, time_step, 4, PASS_BAND * sampling_hz, "lowpass")
    time = time_step * np.arange(signal.size)
    return np.asarray(CubicSpline(time, smooth)(np.arange(round(duration * sampling_hz)) / sampling_hz))
