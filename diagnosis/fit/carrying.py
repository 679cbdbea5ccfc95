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
from diagnosis.data.smoothing import smooth
from grids.instruments.staged import Sets, recorded_in_stages
from grids.instruments.windowed import recorded_in_windows
from grids.recordings.base import Recording
from models.base import FloatArray
from models.identification import NARROWEST, State
from models.piecewise import Part, begun_at
from models.runs import Prescribed
from models.shaking import Shaking, Shakings

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


@dataclass(frozen=True)
class Asked:
    """Settings along a recording, and the samples (k,) at which the states are asked for."""

    recording: Recording
    marks: NDArray[np.int64]
    settings: Sequence[Setting]


@dataclass(frozen=True)
class _Lane:
    """One setting along a recording."""

    recording: Recording
    marks: NDArray[np.int64]
    setting: Setting

    @property
    def firsts(self) -> tuple[int, ...]:
        """Samples at which the wall's values change."""
        return tuple(part.first for part in self.setting.parts)


Kept = OrderedDict[tuple[Any, ...], tuple[Recording, dict[str, FloatArray]]]
"""Arrays by name, with the recording: else its id could become another's."""


class Carrying:
    """Carried states, kept by the recording and the setting that they belong to."""

    def __init__(self) -> None:
        self.kept: Kept = OrderedDict()
        self.motions: Kept = OrderedDict()

    def at(
        self, asked: Sequence[Asked], measured: Measured, options: Mapping[str, str]
    ) -> list[dict[str, FloatArray]]:  # fmt: skip
        """Carried states (P, k, ...) by name of P settings of each recording, at its samples ``marks`` (k,)."""
        step = measured.model.step
        keys = [
            [(id(one.recording), step, one.marks.tobytes(), *setting.key) for setting in one.settings] for one in asked
        ]
        new = {
            key: _Lane(one.recording, one.marks, setting)
            for one, own in zip(asked, keys, strict=True)
            for key, setting in zip(own, one.settings, strict=True)
            if key not in self.kept
        }
        together: dict[tuple[Any, ...], list[tuple[Any, ...]]] = {}
        for key, lane in new.items():
            together.setdefault((lane.setting.shaking.time_step, *lane.firsts), []).append(key)
        for alike in together.values():
            found = _carried(measured, [new[key] for key in alike], options, self.motions)
            for key, states in zip(alike, found, strict=True):
                self.kept[key] = new[key].recording, states
        each = [[self._kept(key) for key in own] for own in keys]
        for kept in (self.kept, self.motions):
            while len(kept) > KEPT:
                kept.popitem(last=False)
        return [_stacked(own) for own in each]

    def _kept(self, key: tuple[Any, ...]) -> dict[str, FloatArray]:
        self.kept.move_to_end(key)
        return self.kept[key][1]


def _stacked(each: Sequence[dict[str, FloatArray]]) -> dict[str, FloatArray]:
    """States of several settings as one array; nan of what cannot stand, which carries nothing."""
    whole = max(each, key=len)
    return {name: np.stack([one.get(name, np.full(x.shape, np.nan)) for one in each]) for name, x in whole.items()}


def _carried(
    measured: Measured, lanes: Sequence[_Lane], options: Mapping[str, str], motions: Kept
) -> list[dict[str, FloatArray]]:
    """States (k, ...) by name of every lane at its marks; settings change at the same samples in all of them."""
    motion, row = _motion(measured, lanes, motions)
    at = np.unique(np.concatenate([lane.marks for lane in lanes]))
    firsts, longest = lanes[0].firsts, max(lane.recording.time.size for lane in lanes)
    shakings = [lane.setting.shaking for lane in lanes]
    found: dict[str, list[FloatArray]] = {}
    initial: dict[str, FloatArray] = {}
    for j, (begin, end) in enumerate(pairwise([*firsts, longest])):
        inside = at[(at >= begin) & (at < end)]
        last = j + 1 == len(firsts)
        wanted = inside if last else np.append(inside, end)
        if not wanted.size:
            break
        parts = [lane.setting.parts[j].values for lane in lanes]
        values = {name: np.array([part[name] for part in parts]) for name in parts[0]}
        begun = {id(shaking): begun_at(shaking, begin) for shaking in shakings}
        ends = np.clip([int(lane.marks.max()) - begin for lane in lanes], 0, int(wanted[-1]) - begin)
        ahead = {name: x[:, begin:] for name, x in motion.items()}
        ran = measured.model.carry(
            values, Shakings.of_lanes([begun[id(shaking)] for shaking in shakings]),
            Prescribed(ahead, wanted - begin, np.zeros(len(lanes), np.int64), row, ends),
            initial=initial, options=options,
        )  # fmt: skip
        if not ran:  # from here on none of the settings stands
            break
        initial = {} if last else {name: x[:, -1] for name, x in ran.items()}
        for name, x in ran.items():
            found.setdefault(name, []).append(x[:, : inside.size])
    whole = {name: _to_the_end(np.concatenate(x, axis=1), at.size) for name, x in found.items()}
    own = [np.searchsorted(at, lane.marks) for lane in lanes]
    return [{name: x[k, own[k]] for name, x in whole.items()} for k in range(len(lanes))]


def _to_the_end(states: FloatArray, marks: int) -> FloatArray:
    """States (P, k, ...) at the first of the marks, nan at the others."""
    return np.pad(states, [(0, 0), (0, marks - states.shape[1]), *[(0, 0)] * (states.ndim - 2)], constant_values=np.nan)


def _motion(
    measured: Measured, lanes: Sequence[_Lane], motions: Kept
) -> tuple[dict[str, FloatArray], NDArray[np.int64]]:  # fmt: skip
    """The free states along every recording, (r, samples) held beyond its end, and the row of each lane (n,)."""
    keys = [(id(lane.recording), lane.setting.key[1], lane.setting.shaking.time_step) for lane in lanes]
    for key, lane in zip(keys, lanes, strict=True):
        if key not in motions:
            motions[key] = lane.recording, _smoothed(measured, lane.recording, lane.setting)
        motions.move_to_end(key)
    distinct = list(dict.fromkeys(keys))
    each = [motions[key][1] for key in distinct]
    longest = max(x.size for states in each for x in states.values())
    found = {name: np.stack([_held(states[name], longest) for states in each]) for name in each[0]}
    found |= {name: found[of] for name, of in measured.alike.items() if name not in found}
    return found, np.array([distinct.index(key) for key in keys], np.int64)


def _held(states: FloatArray, samples: int) -> FloatArray:
    return states if states.size == samples else np.pad(states, (0, samples - states.size), mode="edge")


def _slope(state: State, recording: Recording) -> bool:
    """Whether a state is the slope of a channel."""
    return state.rate and state.name not in recording.channels


def _smoothed(measured: Measured, recording: Recording, setting: Setting) -> dict[str, FloatArray]:
    """The free states (samples,) by name; per sample of the recording: the clock of the responses may run otherwise."""
    channels = freed(measured, recording, setting)
    width = measured.lengths.carrying if measured.lengths else NARROWEST
    quicker = recording.time_step / setting.shaking.time_step
    found = {}
    for state in measured.identification.free:
        if state.name in measured.free:
            slope = _slope(state, recording)
            name = state.channel if slope or not state.rate else state.name
            states = smooth(channels[name], recording.time_step, width, slope)
            found[state.name] = states * quicker if slope else states
    return found


def freed(measured: Measured, recording: Recording, setting: Setting) -> dict[str, FloatArray]:
    """The channels of the free states (samples,) by name, without what the instruments add; their clock stays."""
    free = measured.identification.free
    names = dict.fromkeys(n for state in free for n in (state.channel, state.name) if n in recording.channels)
    seen = {name: recording.channels[name][None] for name in names}
    if not any(switched for _, switched in setting.sets):
        return {name: x[0] for name, x in seen.items()}
    base = setting.shaking.horizontal[None]
    around = measured.around(recording.time_step, base, np.zeros((1, 1)))
    true = seen
    for _ in range(ROUNDS):
        again = recorded_in_stages(true, setting.sets, around, recorded_in_windows)
        true = {name: x + (seen[name] - again[name]) for name, x in true.items()}
    return {name: x[0] for name, x in true.items()}
