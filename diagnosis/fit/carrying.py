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
from models.identification import NARROWEST
from models.piecewise import Part, begun_at
from models.shaking import Shaking

KEPT = 512
"""Settings that are kept: those of one linearisation and of the steps after it, several times over."""
ROUNDS = 3
"""Corrections of the motion by what the instruments add to it; each leaves a share of the last, their own size."""


@dataclass(frozen=True)
class Setting:
    """The wall's values from sample to sample of a recording, and the instruments likewise."""

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


class Carrying:
    """Carried states, kept by the recording and the setting that they belong to."""

    def __init__(self) -> None:
        self.kept: OrderedDict[tuple[Any, ...], tuple[Recording, dict[str, FloatArray]]] = OrderedDict()

    def at(
        self,
        marks: NDArray[np.int64],
        measured: Measured,
        recording: Recording,
        shaking: Shaking,
        settings: Sequence[Setting],
        options: Mapping[str, str],
    ) -> dict[str, FloatArray]:
        """Carried states (P, k, ...) by name of P settings that share the ``shaking``, at samples ``marks`` (k,)."""
        keys = [(id(recording), marks.tobytes(), *setting.key) for setting in settings]
        new = {key: one for key, one in zip(keys, settings, strict=True) if key not in self.kept}
        if new:
            found = carried(marks, measured, recording, shaking, list(new.values()), options)
            for k, key in enumerate(new):
                # with the recording: else its id could become another's
                self.kept[key] = recording, {name: x[k] for name, x in found.items()}
        each = []
        for key in keys:
            self.kept.move_to_end(key)
            each.append(self.kept[key][1])
        while len(self.kept) > KEPT:
            self.kept.popitem(last=False)
        whole = max(each, key=len)
        # what cannot stand carries nothing
        return {name: np.stack([one.get(name, np.full(x.shape, np.nan)) for one in each]) for name, x in whole.items()}


def carried(
    marks: NDArray[np.int64],
    measured: Measured,
    recording: Recording,
    shaking: Shaking,
    settings: Sequence[Setting],
    options: Mapping[str, str],
) -> dict[str, FloatArray]:
    """The same, run."""
    lanes = len(settings)
    motion = _motion(measured, recording, shaking.time_step, [setting.sets for setting in settings])
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
        ran = measured.model.carry(
            values, begun_at(shaking, begin), {name: x[:, begin:] for name, x in motion.items()}, wanted - begin,
            first=np.zeros(lanes, np.int64), initial=initial, options=options,
        )  # fmt: skip
        initial = {} if last else {name: x[:, -1] for name, x in ran.items()}
        for name, x in ran.items():
            found.setdefault(name, []).append(x[:, : inside.size])
    return {name: np.concatenate(x, axis=1)[:, back] for name, x in found.items()}


def _motion(
    measured: Measured, recording: Recording, time_step: float, sets: Sequence[Sets]
) -> dict[str, FloatArray]:  # fmt: skip
    """The free states along a recording, (1, samples) where all settings share them, else (P, samples)."""
    each = [_freed(measured, recording, one) for one in (sets if any(one != sets[0] for one in sets) else sets[:1])]
    width = measured.lengths.carrying if measured.lengths else NARROWEST
    found = {}
    for state in measured.identification.free:
        if state.name not in measured.free:
            continue
        slope = state.rate and state.name not in recording.channels
        name = state.channel if slope or not state.rate else state.name
        rows = [smooth(channels[name], recording.time_step, width, slope) for channels in each]
        # per sample of the recording: the clock of the responses may run on another step
        found[state.name] = np.stack(rows) * (recording.time_step / time_step if slope else 1.0)
    return found | {name: found[of] for name, of in measured.alike.items() if name not in found}


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
