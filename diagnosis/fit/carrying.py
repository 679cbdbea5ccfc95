"""States at the windows' starts that no recording holds, carried there along the measured motion.

The model runs from rest through the whole recording with the measured states prescribed: smoothed, and freed of what
the instruments add to them. What it is asked for at the windows' starts, such as how far a layer is compressed and what
it remembers, then depends on the parameters but not on the states that are free in the windows. So the windows stay
independent of one another, and nothing has to run again while only those states, or probes of the base motion, vary.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.measured import Measured
from diagnosis.data.noise import smooth
from grids.instruments.base import Surroundings
from grids.instruments.staged import Sets, recorded_in_stages
from grids.instruments.windowed import recorded_in_windows
from grids.recordings.base import REQUIRED, Recording
from models.base import FloatArray
from models.identification import NARROWEST, State
from models.piecewise import Part, begun_at
from models.shaking import Shaking

KEPT = 512
"""Settings that are kept: those of one linearisation and of the steps after it, several times over."""
ROUNDS = 3
"""Corrections of the motion by what the instruments add to it; each leaves a share of the last, their own size."""


@dataclass(frozen=True)
class Setting:
    """The base as it moved along a recording, the wall's values from sample to sample, and the instruments likewise."""

    shaking: Shaking
    parts: Sequence[Part]
    sets: Sets

    @property
    def key(self) -> tuple[Any, ...]:
        wall = tuple((part.first, *sorted(part.values.items())) for part in self.parts)
        instruments = tuple(
            (first, *((name, *sorted(values.items())) for name, values in sorted(switched.items())))
            for first, switched in self.sets
        )
        return wall, instruments


Kept = OrderedDict[tuple[Any, ...], tuple[Recording, dict[str, FloatArray]]]
"""Arrays by name, with the recording: else its id could become another's."""


class Carrying:
    """Carried states, kept by the recording and the setting that they belong to."""

    def __init__(self) -> None:
        self.kept: Kept = OrderedDict()
        self.motions: Kept = OrderedDict()

    def at(
        self,
        marks: NDArray[np.int64],
        measured: Measured,
        recording: Recording,
        settings: Sequence[Setting],
        options: Mapping[str, str],
    ) -> dict[str, FloatArray]:
        """Carried states (P, k, ...) by name of P settings, at samples ``marks`` (k,)."""
        keys = [(id(recording), marks.tobytes(), *setting.key) for setting in settings]
        new = {key: one for key, one in zip(keys, settings, strict=True) if key not in self.kept}
        together: dict[tuple[float, int], list[tuple[Any, ...]]] = {}
        for key, one in new.items():
            together.setdefault((one.shaking.time_step, one.shaking.horizontal.size), []).append(key)
        for alike in together.values():
            found = carried(marks, measured, recording, [new[key] for key in alike], options, self.motions)
            for k, key in enumerate(alike):
                self.kept[key] = recording, {name: x[k] for name, x in found.items()}
        each = []
        for key in keys:
            self.kept.move_to_end(key)
            each.append(self.kept[key][1])
        for kept in (self.kept, self.motions):
            while len(kept) > KEPT:
                kept.popitem(last=False)
        whole = max(each, key=len)
        # what cannot stand carries nothing
        return {name: np.stack([one.get(name, np.full(x.shape, np.nan)) for one in each]) for name, x in whole.items()}


def carried(
    marks: NDArray[np.int64],
    measured: Measured,
    recording: Recording,
    settings: Sequence[Setting],
    options: Mapping[str, str],
    motions: Kept,
) -> dict[str, FloatArray]:
    """The same of settings whose bases move over the same samples, run."""
    lanes = len(settings)
    motion = _motion(measured, recording, settings, motions)
    at, back = np.unique(marks, return_inverse=True)
    firsts = [part.first for part in settings[0].parts]
    found: dict[str, list[FloatArray]] = {}
    initial: dict[str, FloatArray] = {}
    for j, (begin, end) in enumerate(pairwise([*firsts, recording.time.size])):
        inside = at[(at >= begin) & (at < end)]
        last = j + 1 == len(firsts)
        wanted = inside if last else np.append(inside, end)
        if not wanted.size:
            break
        values = {name: np.array([s.parts[j].values[name] for s in settings]) for name in settings[0].parts[j].values}
        begun = {id(s.shaking): begun_at(s.shaking, begin) for s in settings}
        ahead = {name: x[:, begin:] for name, x in motion.items()}
        ran = measured.model.carry(
            values, [begun[id(s.shaking)] for s in settings], ahead, wanted - begin,
            first=np.zeros(lanes, np.int64), initial=initial, options=options,
        )  # fmt: skip
        if not ran:  # from here on none of the settings stands
            break
        initial = {} if last else {name: x[:, -1] for name, x in ran.items()}
        for name, x in ran.items():
            found.setdefault(name, []).append(x[:, : inside.size])
    return {name: _to_the_end(np.concatenate(x, axis=1), at.size)[:, back] for name, x in found.items()}


def _to_the_end(states: FloatArray, marks: int) -> FloatArray:
    """States (P, k, ...) at the first of the marks, nan at the others."""
    return np.pad(states, [(0, 0), (0, marks - states.shape[1]), *[(0, 0)] * (states.ndim - 2)], constant_values=np.nan)


def _motion(
    measured: Measured, recording: Recording, settings: Sequence[Setting], motions: Kept
) -> dict[str, FloatArray]:  # fmt: skip
    """The free states along a recording, (1, samples) where all settings share them, else (P, samples)."""
    keys = [(id(recording), setting.key[1]) for setting in settings]
    for key, one in zip(keys, settings, strict=True):
        if key not in motions:
            motions[key] = recording, _smoothed(measured, recording, one.sets)
        motions.move_to_end(key)
    each = [motions[key][1] for key in (keys if len(set(keys)) > 1 else keys[:1])]
    # per sample of the recording: the clock of the responses may run on another step
    quicker = recording.time_step / settings[0].shaking.time_step
    found = {}
    for state in measured.identification.free:
        if state.name in measured.free:
            rows = np.stack([states[state.name] for states in each])
            found[state.name] = rows * quicker if _slope(state, recording) else rows
    return found | {name: found[of] for name, of in measured.alike.items() if name not in found}


def _slope(state: State, recording: Recording) -> bool:
    """Whether a state is the slope of a channel."""
    return state.rate and state.name not in recording.channels


def _smoothed(measured: Measured, recording: Recording, sets: Sets) -> dict[str, FloatArray]:
    """The free states (samples,) by name, per s of the recording's clock."""
    channels = _freed(measured, recording, sets)
    width = measured.lengths.carrying if measured.lengths else NARROWEST
    found = {}
    for state in measured.identification.free:
        if state.name in measured.free:
            slope = _slope(state, recording)
            name = state.channel if slope or not state.rate else state.name
            found[state.name] = smooth(channels[name], recording.time_step, width, slope)
    return found


def _freed(measured: Measured, recording: Recording, sets: Sets) -> dict[str, FloatArray]:
    """The channels of the free states (samples,) without what the instruments add, their clock left as it is."""
    free = measured.identification.free
    names = dict.fromkeys(n for state in free for n in (state.channel, state.name) if n in recording.channels)
    seen = {name: recording.channels[name][None] for name in names}
    if not any(switched for _, switched in sets):
        return {name: x[0] for name, x in seen.items()}
    around = Surroundings(
        recording.time_step, recording.channels[REQUIRED][None], measured.reference_peak, np.zeros((1, 1))
    )
    true = seen
    for _ in range(ROUNDS):
        again = recorded_in_stages(true, sets, around, recorded_in_windows)
        true = {name: x + (seen[name] - again[name]) for name, x in true.items()}
    return {name: x[0] for name, x in true.items()}
