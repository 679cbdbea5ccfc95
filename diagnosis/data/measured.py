"""What was measured, arranged by windows: the arrays that every prediction is compared with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.noise import base_noise, response_noise, smooth
from diagnosis.data.windows import SMOOTHING, Window, cut
from grids.recordings.base import CHANNELS, REQUIRED, FloatArray, Recording
from models.errors import InputError
from models.model import Model
from models.shaking import Shaking

RATE_WIDTH = 0.04
"""s on either side of a window's start over which its rate is estimated."""
NOT_COMPARED = ("contact_1", "contact_2")


@dataclass(frozen=True)
class Measured:
    """W windows of some recordings, C channels, at most N samples a window.

    ``values`` and ``mask`` (W, C, N); ``sigma`` (W, C); ``base`` (W, N), the measured base acceleration;
    ``states`` (W, S), the model's states at the windows' starts as the measurement suggests;
    ``memory``: what happened before each window (W,), for laws with a memory.
    ``reference_peak``: largest rotation_1 (rad) of the first recording.
    """

    model: Model
    recordings: tuple[Recording, ...]
    shakings: tuple[Shaking, ...]
    base_noise: tuple[float, ...]
    windows: tuple[Window, ...]
    channels: tuple[str, ...]
    values: FloatArray
    mask: NDArray[np.bool_]
    sigma: FloatArray
    base: FloatArray
    states: FloatArray
    state_size: FloatArray
    memory: dict[str, FloatArray]
    reference_peak: float

    @property
    def recording_of(self) -> NDArray[np.int64]:
        return np.array([w.recording for w in self.windows], np.int64)

    @property
    def first(self) -> NDArray[np.int64]:
        return np.array([w.first for w in self.windows], np.int64)

    @property
    def count(self) -> FloatArray:
        """Samples compared in each window, all channels together (W,)."""
        return np.asarray(self.mask.sum(axis=(1, 2)), np.float64)

    def cut_again(self, windows: tuple[Window, ...]) -> Measured:
        """The same starts with other lengths."""
        return replace(self, windows=windows, **gather(self.recordings, windows, self.channels))

    def times(self, window: int) -> FloatArray:
        """Times (N,) of a window's samples, in s."""
        cutout = self.windows[window]
        step = self.recordings[cutout.recording].time_step
        return np.asarray((cutout.first + np.arange(self.values.shape[2])) * step, np.float64)


def arrange(
    model: Model, recordings: Sequence[Recording], vertical: bool, reference_peak: float | None = None
) -> Measured:
    """Cut the recordings in windows; channels are compared that all of them hold (see `left_out`).

    Raises InputError when nothing can be compared.
    """
    states: tuple[str, ...] = model.states
    for state in states:
        if _channel(state) not in CHANNELS:
            raise InputError(
                f"calibration and diagnosis of model {model.name} are not offered yet: its motion starts from "
                f'{state}, which no recording holds; describe the wall as one block (model = "housner"), or simulate.'
            )
    observed = [q.name for q in model.observables if q.name not in NOT_COMPARED]
    channels = tuple(c for c in observed if all(c in r.channels for r in recordings))
    if not channels:
        raise InputError(
            f"no channel of {model.name} ({', '.join(observed)}) is in every recording: record rotation_1 at least."
        )
    for state in states:
        lacking = [r.name for r in recordings if _channel(state) not in r.channels]
        if lacking:
            raise InputError(
                f"{_channel(state)} is missing in {', '.join(lacking)}: model {model.name} cannot start a window "
                "without it; record or map it."
            )
    lead = channels[0]
    windows: list[Window] = []
    for k, recording in enumerate(recordings):
        if model.chaotic:
            windows += cut(recording.channels[lead], response_noise(recording, lead), recording.time_step, k)
        else:
            windows.append(Window(k, 0, recording.time.size))
    if not windows:
        raise InputError(
            f"{lead} never rises above 8 times its noise in {', '.join(r.name for r in recordings)}: "
            "nothing can be compared; shake harder, or measure with less noise."
        )
    shaken_up = vertical or all("base_acceleration_z" in r.channels for r in recordings)
    start = np.stack([_start(recordings, windows, state) for state in states], axis=1)
    peak = float(np.max(np.abs(smooth(recordings[0].channels[lead], recordings[0].time_step, SMOOTHING))))
    return Measured(
        model=model,
        recordings=tuple(recordings),
        shakings=tuple(r.shaking(shaken_up, vertical_acts=vertical) for r in recordings),
        base_noise=tuple(base_noise(r) for r in recordings),
        windows=tuple(windows),
        channels=channels,
        **gather(recordings, windows, channels),
        states=start,
        state_size=np.maximum(np.std(start, axis=0), 1e-12),
        memory=_memory(recordings, windows, channels),
        reference_peak=peak if reference_peak is None else reference_peak,
    )


def left_out(recordings: Sequence[Recording]) -> dict[str, tuple[str, ...]]:
    """Responses that only some recordings hold, so that none is compared by them; with those that lack them."""
    held = dict.fromkeys(c for r in recordings for c in r.responses if c not in NOT_COMPARED)
    lacking = {c: tuple(r.name for r in recordings if c not in r.channels) for c in held}
    return {c: names for c, names in lacking.items() if names}


def gather(recordings: Sequence[Recording], windows: Sequence[Window], channels: Sequence[str]) -> dict[str, Any]:
    """Values, mask, noise and base motion of the windows, padded to the longest one."""
    longest = max(w.samples for w in windows)
    shape = (len(windows), len(channels), longest)
    values, mask = np.zeros(shape), np.zeros(shape, bool)
    sigma, base = np.ones(shape[:2]), np.zeros((shape[0], longest))
    noise = {(k, c): response_noise(r, c) for k, r in enumerate(recordings) for c in channels}
    for w, window in enumerate(windows):
        recording = recordings[window.recording]
        part = slice(window.first, window.first + window.samples)
        for c, name in enumerate(channels):
            values[w, c, : window.samples] = recording.channels[name][part]
            mask[w, c, : window.samples] = True
            sigma[w, c] = noise[window.recording, name]
        last = min(window.first + longest, recording.time.size)
        base[w, : last - window.first] = recording.channels[REQUIRED][window.first : last]
    return {"values": values, "mask": mask, "sigma": sigma, "base": base}


def _channel(state: str) -> str:
    """The channel that a state, or its derivative, is read from."""
    return state.replace("_rate", "")


def _start(recordings: Sequence[Recording], windows: Sequence[Window], state: str) -> FloatArray:
    """A state at the windows' starts, from a parabola through the samples around them.

    A rate is the slope of its rotation in recordings that do not hold the rate itself.
    """
    found = np.empty(len(windows))
    for w, window in enumerate(windows):
        recording = recordings[window.recording]
        derivative = state not in recording.channels
        channel = _channel(state) if derivative else state
        step, signal = recording.time_step, recording.channels[channel]
        reach = max(3, round(RATE_WIDTH / step))
        low, high = max(0, window.first - reach), min(signal.size, window.first + reach + 1)
        fit = np.polynomial.polynomial.polyfit((np.arange(low, high) - window.first) * step, signal[low:high], 2)
        found[w] = fit[1] if derivative else fit[0]
    return found


def _memory(
    recordings: Sequence[Recording],
    windows: Sequence[Window],
    channels: Sequence[str],
) -> dict[str, FloatArray]:
    """Largest rotation and number of impacts before each window, from the smoothed measurement."""
    memory: dict[str, FloatArray] = {}
    if "rotation_1" not in channels:
        return memory
    peaks, impacts = [], []
    for k, recording in enumerate(recordings):
        signal = smooth(recording.channels["rotation_1"], recording.time_step, SMOOTHING)
        level = 2.0 * response_noise(recording, "rotation_1")
        side = np.where(signal > level, 1, np.where(signal < -level, -1, 0))
        held = side[np.maximum.accumulate(np.where(side != 0, np.arange(side.size), 0))]
        crossed = np.cumsum(np.concatenate([[0], (held[1:] != held[:-1]) & (held[:-1] != 0)]))
        largest = np.maximum.accumulate(np.abs(signal))
        for window in windows:
            if window.recording == k:
                peaks.append(largest[window.first])
                impacts.append(crossed[window.first])
    memory["peak_rotation_1"] = np.array(peaks, float)
    memory["impacts"] = np.array(impacts, float)
    return memory
