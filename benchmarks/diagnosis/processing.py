"""What is done to recordings before they reach a diagnosis: filtering, corrections, other sensors, coarse sampling.

Each of `PROCESSED` takes the recorded channels, noise and all, and gives those of a file. Sizes are drawn within the
ranges here; none is larger than laboratories have it.

    zero_phase        the rotation through a low-pass of 12 to 30 Hz forwards and backwards, order 2 or 4 each way
    zero_phase_all    every channel alike, 20 to 40 Hz
    moving_mean       the rotation averaged over 10 to 30 ms around each sample
    frames            the rotation seen in 60 to 120 frames a second whose instants scatter by .5 ms, lines between
    resolution        the rotation in whole steps of .2 to .5 % of its peak
    line_removed      the line of least squares taken off the rotation
    mean_removed      the mean of each record taken off the base acceleration
    base_corrected    the base acceleration through a high-pass of .05 to .1 Hz forwards and backwards, order 2
    gyroscope         the rotation integrated from a rate with white noise and a zero off by .02 % of its peak
    jitter            the rotation read .3 ms early or late at random
    louder            the rotation's noise three to six times as large from the middle of each recording on
    table_resonance   the base moves at 20 to 30 Hz too, a tenth of its acceleration, and the record does not show it
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid
from scipy.signal import detrend

from benchmarks.diagnosis.instruments import both_ways

FloatArray = NDArray[np.float64]
Process = Callable[[FloatArray, float, np.random.Generator], FloatArray]
"""(channel, sampling frequency in Hz, generator) -> channel."""


@dataclass(frozen=True)
class Processing:
    """What becomes of the rotation and of the horizontal base acceleration; None: nothing.

    ``named_rightly``: effects of the catalogue whose name is a right answer where nothing else is there.
    """

    rotation: Process | None = None
    base: Process | None = None
    named_rightly: tuple[str, ...] = ()
    alike: bool = False
    """Whether the same draw acts on both."""

    def __call__(
        self, channels: Mapping[str, FloatArray], sampling_hz: float, rng: np.random.Generator
    ) -> dict[str, FloatArray]:
        found = dict(channels)
        seed = int(rng.integers(2**32))
        for k, (name, process) in enumerate((("rotation_1", self.rotation), ("base_acceleration_x", self.base))):
            if process is not None:
                own = np.random.default_rng([seed, 0 if self.alike else k])
                found[name] = process(found[name], sampling_hz, own)
        return found


def _both_ways(low: float, high: float, kind: str, orders: tuple[int, ...]) -> Process:
    def process(signal: FloatArray, sampling_hz: float, rng: np.random.Generator) -> FloatArray:
        return both_ways(signal, 1.0 / sampling_hz, int(rng.choice(orders)), rng.uniform(low, high), kind)

    return process


def _moving_mean(signal: FloatArray, sampling_hz: float, rng: np.random.Generator) -> FloatArray:
    half = max(1, round(0.5 * sampling_hz * rng.uniform(0.01, 0.03)))
    padded = np.pad(signal, half, mode="edge")
    return np.convolve(padded, np.full(2 * half + 1, 1.0 / (2 * half + 1)), "valid")


def _frames(signal: FloatArray, sampling_hz: float, rng: np.random.Generator) -> FloatArray:
    time = np.arange(signal.size) / sampling_hz
    frame = np.arange(0.0, time[-1], 1.0 / rng.uniform(60.0, 120.0))
    seen = np.interp(frame + 5e-4 * rng.normal(size=frame.size), time, signal)
    return np.interp(time, frame, seen)


def _resolution(signal: FloatArray, sampling_hz: float, rng: np.random.Generator) -> FloatArray:
    step = rng.uniform(0.002, 0.005) * float(np.max(np.abs(signal)))
    return np.asarray(step * np.round(signal / step))


def _gyroscope(signal: FloatArray, sampling_hz: float, rng: np.random.Generator) -> FloatArray:
    rate = np.gradient(signal, 1.0 / sampling_hz)
    width = max(1, round(0.02 * sampling_hz))  # without the noise of the rotation
    peak = float(np.max(np.abs(np.convolve(rate, np.full(width, 1.0 / width), "same"))))
    read = rate + 0.01 * peak * rng.normal(size=rate.size) + 2e-4 * peak * float(rng.choice([-1.0, 1.0]))
    return np.asarray(signal[0] + cumulative_trapezoid(read, dx=1.0 / sampling_hz, initial=0.0))


def _jitter(signal: FloatArray, sampling_hz: float, rng: np.random.Generator) -> FloatArray:
    time = np.arange(signal.size) / sampling_hz
    return np.interp(time + 3e-4 * rng.normal(size=time.size), time, signal)


def _louder(signal: FloatArray, sampling_hz: float, rng: np.random.Generator) -> FloatArray:
    noise = float(np.median(np.abs(np.diff(signal)[: signal.size // 20]))) / 0.954  # of two samples, at rest
    more = noise * np.sqrt(rng.uniform(3.0, 6.0) ** 2 - 1.0) * rng.normal(size=signal.size)
    return signal + np.where(np.arange(signal.size) < signal.size // 2, 0.0, more)


def _resonant(signal: FloatArray, sampling_hz: float, rng: np.random.Generator) -> FloatArray:
    """The record without what the table did; so that is added here, with the sign turned."""
    around = np.convolve(np.abs(signal), np.full(round(0.2 * sampling_hz), 1.0 / round(0.2 * sampling_hz)), "same")
    phase = 2.0 * np.pi * (rng.uniform(20.0, 30.0) * np.arange(signal.size) / sampling_hz + rng.uniform())
    return np.asarray(signal - 0.1 * around * np.sin(phase))


def _without_line(signal: FloatArray, sampling_hz: float, rng: np.random.Generator) -> FloatArray:
    return np.asarray(detrend(signal))


def _without_mean(signal: FloatArray, sampling_hz: float, rng: np.random.Generator) -> FloatArray:
    return np.asarray(signal - signal.mean())


_ZERO = ("accelerometer_offset", "base_filter")
PROCESSED = {
    "zero_phase": Processing(_both_ways(12.0, 30.0, "lowpass", (2, 4)), named_rightly=("filter",)),
    "zero_phase_all": Processing(
        *2 * (_both_ways(20.0, 40.0, "lowpass", (2, 4)),), named_rightly=("filter", "base_filter"), alike=True
    ),
    "moving_mean": Processing(_moving_mean, named_rightly=("filter",)),
    "frames": Processing(_frames, named_rightly=("filter", "delay")),
    "resolution": Processing(_resolution),
    "line_removed": Processing(_without_line, named_rightly=("drift", "offset")),
    "mean_removed": Processing(base=_without_mean, named_rightly=_ZERO),
    "base_corrected": Processing(base=_both_ways(0.05, 0.1, "highpass", (2,)), named_rightly=_ZERO),
    "gyroscope": Processing(_gyroscope, named_rightly=("drift", "offset")),
    "jitter": Processing(_jitter),
    "louder": Processing(_louder),
    "table_resonance": Processing(base=_resonant),
}
