"""The fitted motion along the windows, with all that the model remembers on it, and runs from any of its samples."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.unknowns import instruments_of
from grids.instruments.staged import moved_in_stages, recorded_in_stages
from grids.instruments.windowed import moved_in_windows, recorded_in_windows
from models.base import FloatArray
from models.identification import Largest
from models.kinematics import ground_along
from models.observed import Observed
from models.piecewise import trajectories
from models.runs import Prescribed


@dataclass(frozen=True)
class Along:
    """The motion at ``point``, events as they are known to have been, before any sensor of the responses."""

    predictor: Predictor
    point: Point

    @cached_property
    def plain(self) -> dict[int, Mapping[str, FloatArray]]:
        """Observables (n, N) of the windows of each recording that has any, from their own starts."""
        m, found = self.predictor.measured, {}
        for r in range(len(m.recordings)):
            own = self.windows(r)
            if own.size:
                initial = {name: self.point.states[own, k] for k, name in enumerate(m.free)}
                initial |= {name: before[own] for name, before in (m.memory | self._starts).items()}
                found[r] = self.run(r, m.first[own], m.values.shape[2], initial)
        return found

    @cached_property
    def states(self) -> dict[str, FloatArray]:
        """The free states, leading and compared channels (W, N) by name."""
        m = self.predictor.measured
        leads = [lead.channel for lead in m.identification.leads]
        names = dict.fromkeys([*m.free, *leads, *m.channels])
        found = {name: np.zeros((len(m.windows), m.values.shape[2])) for name in names}
        for r, ran in self.plain.items():
            own = self.windows(r)
            ground = partial(ground_along, m.shakings[r], m.first[own], m.values.shape[2])
            sensed = m.sensed(ran, m.recordings[r].time_step, ground)
            for name in names:
                found[name][own] = sensed[name] if name in sensed else ran[name]
        return found

    @cached_property
    def remembered(self) -> dict[str, FloatArray]:
        """What else the motion has (W, N, ...) at each sample: memories, and what the model carries."""
        return self._memories() | self._carried()

    def windows(self, r: int) -> NDArray[np.intp]:
        """The windows of recording ``r``."""
        return np.flatnonzero(self.predictor.measured.recording_of == r)

    def observed(self, read: Callable[[Mapping[str, FloatArray]], FloatArray]) -> FloatArray:
        """What ``read`` makes of the observables of the motion (W, N)."""
        m = self.predictor.measured
        found = np.zeros((len(m.windows), m.values.shape[2]))
        for r, ran in self.plain.items():
            found[self.windows(r)] = read(ran)
        return found

    def at(self, window: NDArray[np.intp], sample: NDArray[np.intp]) -> dict[str, FloatArray]:
        """What a run starts from at samples ``sample`` (n,) of windows ``window`` (n,)."""
        own = {name: self.states[name] for name in self.predictor.measured.free} | self.remembered
        return {name: x[window, sample] for name, x in own.items()}

    def run(
        self, r: int, first: NDArray[np.int64], samples: int, initial: Mapping[str, FloatArray],
        push: FloatArray | None = None,
    ) -> Mapping[str, FloatArray]:  # fmt: skip
        """Observables (n, samples) of recording ``r`` from each of the samples ``first`` (n,) on.

        ``push``: base acceleration (m s-2) beside the recorded one, at its samples.
        """
        predictor, values = self.predictor, self.point.values
        m, recording = predictor.measured, predictor.measured.recordings[r]
        shaking = moved_in_stages(m.shakings[r], predictor.sets(instruments_of(values), recording), moved_in_windows)
        shaking = m.disturbed(shaking, r)
        if push is not None:
            shaking = replace(shaking, horizontal=shaking.horizontal + push)
        parts = predictor.parts(values, recording)
        instants = np.tile(np.array([part.first for part in parts[1:]], np.int64), (first.size, 1))
        # behind its window nothing of a run is compared: it need not be cut there
        own = self.windows(r)
        held = own[np.maximum(np.searchsorted(m.first[own], first, side="right") - 1, 0)]
        end = m.first[held] + np.array([m.windows[w].samples for w in held])
        instants = np.where(instants >= end[:, None], first[:, None] + samples, instants)
        initial = dict(initial) | {s: initial[of] for s, of in m.alike.items() if s not in initial}
        ran = trajectories(
            m.model, [part.values for part in parts], instants, shaking, first=first, samples=samples,
            initial=initial, options=predictor.options,
        )  # fmt: skip
        return m.identification.seen(ran)

    def recorded(self, window: NDArray[np.intp], sample: NDArray[np.intp], ran: Mapping[str, FloatArray]) -> FloatArray:
        """Channels (n, C, N) as recorded in windows of one recording: of ``ran`` from samples ``sample`` (n,) on."""
        predictor, m = self.predictor, self.predictor.measured
        r = int(m.recording_of[window[0]])
        recording, first, rows = m.recordings[r], m.first[window], np.searchsorted(self.windows(r), window)
        sets = predictor.sets(instruments_of(self.point.values), recording)
        ground = moved_in_stages(m.shakings[r], sets, moved_in_windows)
        start = np.asarray(recording.time_step * first[:, None], np.float64)
        base = ground_along(ground, first, m.values.shape[2])
        around = m.around(recording.time_step, base[0], start)
        held = Observed({c: partial(_spliced, self.plain[r], ran, c, rows, sample) for c in ran})
        channels = m.sensed(held, ground.time_step, lambda: base)
        found = recorded_in_stages(channels, sets, around, recorded_in_windows)
        return np.stack([found[c] for c in m.channels], axis=1)

    @cached_property
    def _starts(self) -> dict[str, FloatArray]:
        return self.predictor.carried(self.point)

    def _memories(self) -> dict[str, FloatArray]:
        """The declared memories (W, N) at every sample: that of the window's start, and what came since."""
        m = self.predictor.measured
        found = {}
        for one in m.identification.memories:
            before, signal = m.memory[one.name][:, None], self.states[one.channel]
            if isinstance(one, Largest):
                found[one.name] = np.maximum(before, np.maximum.accumulate(np.abs(signal), axis=1))
            else:
                changes = signal[:, 1:] * signal[:, :-1] < 0.0
                found[one.name] = before + np.pad(np.cumsum(changes, axis=1), ((0, 0), (1, 0)))
        return found

    def _carried(self) -> dict[str, FloatArray]:
        """What the model carries (W, N, ...) at every sample; by what acts at a window's start."""
        predictor, m = self.predictor, self.predictor.measured
        found: dict[str, FloatArray] = {}
        if not m.identification.carrying:
            return found
        every = np.arange(m.values.shape[2])
        for r, recording in enumerate(m.recordings):
            sets = predictor.sets(instruments_of(self.point.values), recording)
            shaking = moved_in_stages(m.shakings[r], sets, moved_in_windows)
            parts = predictor.parts(self.point.values, recording)
            begun = np.searchsorted([part.first for part in parts], m.first, side="right") - 1
            for k, part in enumerate(parts):
                own = np.flatnonzero((m.recording_of == r) & (begun == k))
                if not own.size:
                    continue
                ran = m.model.carry(
                    part.values, shaking,
                    Prescribed({name: self.states[name][own] for name in m.free}, every, m.first[own]),
                    initial={name: x[own] for name, x in self._starts.items()}, options=predictor.options,
                )  # fmt: skip
                for name, x in ran.items():
                    found.setdefault(name, np.zeros((len(m.windows), *x.shape[1:])))[own] = x
        return found


def _spliced(
    plain: Mapping[str, FloatArray], ran: Mapping[str, FloatArray], name: str, rows: NDArray[np.intp],
    sample: NDArray[np.intp],
) -> FloatArray:  # fmt: skip
    """``rows`` of ``plain`` with those of ``ran`` (n, N) in their place from ``sample`` (n,) on."""
    before, later = plain[name][rows], ran[name]
    index = np.arange(before.shape[1])[None, :] - sample[:, None]
    return np.where(index >= 0, np.take_along_axis(later, np.maximum(index, 0), axis=1), before)
