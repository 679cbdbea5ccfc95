"""What the windows of recordings hold and start from, read off the recordings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from diagnosis.data.noise import response_levels, response_noise
from diagnosis.data.smoothing import smooth
from diagnosis.data.windows import Window
from grids.recordings.base import REQUIRED, FloatArray, Recording
from models.errors import InputError
from models.identification import Identification, Largest, State, WindowLengths

RATE_WIDTH = 0.04
"""s on either side of a window's start over which its rate is estimated."""


def gather(recordings: Sequence[Recording], windows: Sequence[Window], channels: Sequence[str]) -> dict[str, Any]:
    """Values, mask, noise and base motion of the windows, padded to the longest one."""
    longest = max(w.samples for w in windows)
    shape = (len(windows), len(channels), longest)
    values, mask = np.zeros(shape), np.zeros(shape, bool)
    sigma, base = np.ones(shape[:2]), np.zeros((shape[0], longest))
    noise = {(k, c): response_levels(r, c) for k, r in enumerate(recordings) for c in channels}
    for w, window in enumerate(windows):
        recording = recordings[window.recording]
        part = slice(window.first, window.first + window.samples)
        for c, name in enumerate(channels):
            values[w, c, : window.samples] = recording.channels[name][part]
            mask[w, c, : window.samples] = True
            lost = recording.lost.get(name, np.zeros(0, np.intp)) - window.first
            mask[w, c, lost[(lost >= 0) & (lost < window.samples)]] = False
            if name in recording.places and recording.places[name].order:  # a difference over both neighbours
                mask[w, c, 0] = False
                mask[w, c, window.samples - 1] &= window.first + window.samples < recording.time.size
            sigma[w, c] = noise[window.recording, name][window.first + window.samples // 2]
        last = min(window.first + longest, recording.time.size)
        base[w, : last - window.first] = recording.channels[REQUIRED][window.first : last]
    return {"values": values, "mask": mask, "sigma": sigma, "base": base}


def refuse_moved(recordings: Sequence[Recording]) -> None:
    """Raise InputError where channels of one name are read at different places: one place is taken for all."""
    first: dict[str, Recording] = {}
    for recording in recordings:
        for name, place in recording.places.items():
            known = first.setdefault(name, recording)
            if known.places[name] != place:
                raise InputError(
                    f"{name} is the {known.places[name].meaning}, in {known.name}, and the {place.meaning}, in "
                    f"{recording.name}: give it another name in one of them."
                )


def refuse_dead(recordings: Sequence[Recording], channels: Sequence[str]) -> None:
    """Raise InputError where a channel reads the same throughout."""
    for recording in recordings:
        for channel in dict.fromkeys(channels):
            values = recording.channels[channel]
            if np.ptp(values) == 0.0:
                raise InputError(
                    f"{channel} of {recording.name} reads {values[0]:g} throughout: a sensor that is dead, or nothing "
                    "that moved; leave out the recording, or the channel where no window starts from it."
                )


def start_of(recordings: Sequence[Recording], windows: Sequence[Window], state: State) -> FloatArray:
    """A state at the windows' starts, from a parabola through the samples around them.

    A rate is the slope of its coordinate in recordings that do not hold the rate itself.
    """
    found = np.empty(len(windows))
    for w, window in enumerate(windows):
        recording = recordings[window.recording]
        slope = state.rate and state.name not in recording.channels
        signal = recording.channels[state.channel if slope or not state.rate else state.name]
        step = recording.time_step
        reach = max(3, round(RATE_WIDTH / step))
        low, high = max(0, window.first - reach), min(signal.size, window.first + reach + 1)
        fit = np.polynomial.polynomial.polyfit((np.arange(low, high) - window.first) * step, signal[low:high], 2)
        found[w] = fit[1] if slope else fit[0]
    return found


def smoothed(recording: Recording, channel: str, lengths: WindowLengths) -> FloatArray:
    """A channel by the filter that finds its peaks."""
    return smooth(recording.channels[channel], recording.time_step, lengths.smoothing)


def memories(
    recordings: Sequence[Recording],
    windows: Sequence[Window],
    declared: Identification,
    lengths: WindowLengths,
) -> dict[str, FloatArray]:
    """The declared memories before each window (W,), from the smoothed measurement."""
    memory = {}
    for one in declared.memories:
        so_far = []
        for recording in recordings:
            signal = smoothed(recording, one.channel, lengths)
            level = 2.0 * response_noise(recording, one.channel)
            so_far.append(_largest(signal) if isinstance(one, Largest) else _sign_changes(signal, level))
        memory[one.name] = np.array([so_far[w.recording][w.first] for w in windows], float)
    return memory


def _largest(signal: FloatArray) -> FloatArray:
    return np.maximum.accumulate(np.abs(signal))


def _sign_changes(signal: FloatArray, level: float) -> FloatArray:
    """Number of changes of sign so far (n_times,), of values beyond ``level``."""
    side = np.where(signal > level, 1, np.where(signal < -level, -1, 0))
    held = side[np.maximum.accumulate(np.where(side != 0, np.arange(side.size), 0))]
    return np.cumsum(np.concatenate([[0], (held[1:] != held[:-1]) & (held[:-1] != 0)])).astype(np.float64)
