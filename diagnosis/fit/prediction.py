"""From parameters and window states to what the sensors would have recorded in every window.

All windows, for many parameter points at once. Those that are sampled alike and in which the same things act run in one
call of the model, each lane under the motion of its recording's base, which carries the clock of the responses
(`grids.instruments.windowed`). Mechanisms with stages act in their intervals: a window before or after an instant runs
as it is then; one that holds it is cut there and goes on from its state (`models.piecewise`), and what instruments do
to it changes at that sample.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, partial

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.measured import Measured
from diagnosis.fit.carrying import Asked, Carrying, Setting
from diagnosis.fit.lanes import Lanes, Ways, held, together_along
from diagnosis.fit.through import run_through
from diagnosis.fit.unknowns import instruments_of, without_instruments
from grids.instruments.base import Switched
from grids.instruments.staged import Sets, moved_in_stages, recorded_in_stages
from grids.instruments.windowed import moved_in_windows, recorded_in_windows, same_base, samples_ahead
from grids.recordings.base import Recording
from grids.stages import Stage, changes, first_sample
from models.base import FloatArray
from models.identification import Rung
from models.observed import Observed
from models.piecewise import Part, trajectories
from models.shaking import Shaking, Shakings

Stages = Mapping[str, Sequence[Stage]]


@dataclass(frozen=True)
class Point:
    """One parameter setting (``mechanism.parameter`` for mechanisms) with the states (W, S) it starts from.

    ``coordinates``: names of values that are those of a fit (`Identification.coordinates`), not of the model; with a
    ``rung`` all are those of the model under it. ``stages``: of mechanisms, None: those of the predictor.
    """

    values: Mapping[str, float]
    states: FloatArray
    coordinates: tuple[str, ...] = ()
    rung: Rung | None = None
    stages: Stages | None = None


@dataclass(frozen=True)
class _Moves:
    """Windows of recording ``r``, and how its base moves for points with ``alike`` instruments, the sets with them."""

    r: int
    windows: NDArray[np.intp]
    alike: Sequence[tuple[Sequence[int], Sets]]
    grounds: Sequence[Shaking]

    @property
    def bases(self) -> dict[int, Shaking]:
        """The base's motion by point."""
        return {p: ground for (members, _), ground in zip(self.alike, self.grounds, strict=True) for p in members}


@dataclass(frozen=True)
class Predictor:
    """Predictions for the windows of ``measured``; ``stages`` by mechanism, of those that do not always act.

    ``coordinates``: which parameters a fit gives its points by what recordings tell better; ``rung``: the one on which
    the model stands where a fit gives the parameters of the model under it.
    """

    measured: Measured
    options: Mapping[str, str] = field(default_factory=dict)
    stages: Stages = field(default_factory=dict)
    coordinates: tuple[str, ...] = ()
    rung: Rung | None = None
    carrying: Carrying = field(default_factory=Carrying, repr=False, compare=False)

    def predict(
        self,
        points: Sequence[Point],
        shakings: Sequence[Shaking] | None = None,
        only: NDArray[np.bool_] | None = None,
    ) -> FloatArray:
        """Channels (P, W, C, N) of P points; ``shakings`` replace the measured ones.

        Meaningless but in windows ``only``, and behind the samples of a window. Events are as the law has them: where
        they are known as they were (`AsItWas`), linear about that motion.
        """
        m = self.measured
        points = self.declared(points)
        out = np.zeros((len(points), *m.values.shape))
        instruments = [instruments_of(p.values) for p in points]
        complete = self._complete(points)
        moves: list[_Moves] = []
        for r, recording in enumerate(m.recordings):
            windows = np.flatnonzero((m.recording_of == r) & (True if only is None else only))
            if not windows.size:
                continue
            alike = [
                (members, self.sets(instruments[members[0]], recording, points[members[0]].stages))
                for members in self._alike(points, instruments, recording)
            ]
            if m.stretches is not None:
                plain = (m.shakings if shakings is None else shakings)[r]
                for own, sets in alike:
                    shaken = moved_in_stages(plain, sets)
                    self._through(r, points, own, windows, shaken, complete, instruments, out)
                continue
            grounds = [moved_in_stages(m.shakings[r], sets, moved_in_windows) for _, sets in alike]
            moves.append(_Moves(r, windows, alike, grounds))
        carried = self._carried(moves, points, complete, instruments)
        together: dict[tuple[object, ...], list[Lanes]] = {}
        for one, at_start in zip(moves, carried, strict=True):
            recording = m.recordings[one.r]
            for (members, acting), ground in zip(one.alike, one.grounds, strict=True):
                shaking = ground if shakings is None else moved_in_stages(shakings[one.r], acting, moved_in_windows)
                # probes of the base are disturbances of the model: accelerometers are on the base as it moves
                shaking = m.disturbed(shaking, one.r)
                ways = [self._ways(recording, points[p].stages) for p in members]
                lanes = Lanes(one.r, one.windows, members, shaking, ground, ways, at_start)
                together.setdefault((recording.time_step, *lanes.kind), []).append(lanes)
        for lanes_alike in together.values():
            self._run(points, lanes_alike, complete, instruments, out)
        for offset in (m.as_it_was and m.as_it_was.offset, m.step_error):
            if offset is not None:
                out -= offset
        return out

    def declared(self, points: Sequence[Point]) -> list[Point]:
        """The points with the model's own parameters in the place of a fit's coordinates."""
        found = [p if p.rung is None else replace(p, values=p.rung.values(p.values), rung=None) for p in points]
        points = list(found)
        given = [k for k, point in enumerate(points) if point.coordinates]
        complete = self._complete([points[k] for k in given])
        if not any("." in name for values in complete[:1] for name in values):
            return [replace(point, coordinates=()) for point in points]
        names = points[given[0]].coordinates
        own = self.measured.model.declared(
            self._values(complete, frozenset(), np.arange(len(given))), names, self.options
        )
        for i, k in enumerate(given):
            values = {name: float(np.broadcast_to(x, (len(given),))[i]) for name, x in own.items()}
            found[k] = replace(points[k], values={**points[k].values, **values}, coordinates=())
        return found

    def carried(self, point: Point) -> dict[str, FloatArray]:
        """What the model carries to the starts of all windows at a point, arrays (W, ...) by name."""
        m = self.measured
        values, instruments = without_instruments(point.values), instruments_of(point.values)
        moves = []
        for r, recording in enumerate(m.recordings):
            own = np.flatnonzero(m.recording_of == r)
            if own.size:
                sets = self.sets(instruments, recording, point.stages)
                moves.append(_Moves(r, own, [([0], sets)], [moved_in_stages(m.shakings[r], sets, moved_in_windows)]))
        found: dict[str, FloatArray] = {}
        for one, carried in zip(moves, self._carried(moves, [point], [values], [instruments]), strict=True):
            for name, x in carried.items():
                found.setdefault(name, np.zeros((len(m.windows), *x.shape[2:])))[one.windows] = x[0]
        return found

    def _complete(self, points: Sequence[Point]) -> list[dict[str, float]]:
        """The wall's values of every point with all keys that some point uses, so that all can run together.

        A mechanism that a point does not use is at its null; a parameter of one joint is that of both.
        """
        acting = self.measured.model.mechanisms
        found = [without_instruments(p.values) for p in points]
        keys = sorted({key for values in found for key in values if "." in key})
        for name in dict.fromkeys(key.partition(".")[0] for key in keys):
            for parameter, null in acting[name].nulls.items():
                for values in found:
                    values.setdefault(f"{name}.{parameter}", null)
        for key in keys:
            for values in found:
                if key not in values:
                    values[key] = values[key.rpartition("_")[0]]
        return found

    def _alike(
        self, points: Sequence[Point], instruments: Sequence[Switched], recording: Recording
    ) -> Iterable[list[int]]:
        """Which points can run together: their base moves alike, and the same mechanisms act one after another.

        At instants of their own, but for instruments.
        """
        groups: dict[tuple[object, ...], list[int]] = {}
        for k, (point, switched) in enumerate(zip(points, instruments, strict=True)):
            ways = tuple(self._ways(recording, point.stages))
            timed: object = tuple(off for _, off in ways)
            if any(not off.isdisjoint(switched) for _, off in ways):
                timed = ways
            groups.setdefault((same_base(switched), timed), []).append(k)
        return groups.values()

    def _carried(
        self, moves: Sequence[_Moves], points: Sequence[Point], complete: Sequence[Mapping[str, float]],
        instruments: Sequence[Switched],
    ) -> list[dict[str, FloatArray]]:  # fmt: skip
        """What the model carries to the starts of the windows (P, n, ...) of all P points, recording by recording."""
        m = self.measured
        if not m.identification.carrying:
            return [{} for _ in moves]
        asked = []
        for one in moves:
            recording, bases = m.recordings[one.r], one.bases
            settings = [
                Setting(
                    bases[p],
                    self.parts(complete[p], recording, point.stages),
                    self.sets(instruments[p], recording, point.stages),
                )
                for p, point in enumerate(points)
            ]
            asked.append(Asked(recording, m.first[one.windows], settings))
        return self.carrying.at(asked, m, self.options)

    def _run(
        self,
        points: Sequence[Point],
        parts: Sequence[Lanes],
        complete: Sequence[Mapping[str, float]],
        instruments: Sequence[Switched],
        out: FloatArray,
    ) -> None:
        """One call of the model for windows of recordings that are sampled alike, in which the same things act."""
        m, time_step = self.measured, self.measured.recordings[parts[0].r].time_step
        point = np.concatenate([np.repeat(one.members, one.windows.size) for one in parts])
        window = np.concatenate([np.tile(one.windows, len(one.members)) for one in parts])
        under = np.repeat(np.arange(len(parts)), [one.size for one in parts])
        compared = np.array([one.samples for one in m.windows])
        ahead = [samples_ahead(switched, time_step) for switched in instruments]
        wanted = compared[window] + np.array(ahead)[point] + any(place.order for place in m.places.values())
        longest, samples = int(compared[window].max()), int(wanted.max())
        first, states = m.first[window], np.stack([one.states for one in points])[point, window]
        initial = {s: states[:, k] for k, s in enumerate(m.free)}
        initial |= {s: initial[of] for s, of in m.alike.items() if s not in initial}
        initial |= {k: v[window] for k, v in m.memory.items()}
        initial |= {k: np.concatenate([one.at_start(k) for one in parts]) for k in parts[0].carried}
        shakings = Shakings(tuple(one.shaking for one in parts), under)
        ran = trajectories(
            m.model, [self._values(complete, off, point) for _, off in parts[0].ways[0]],
            np.concatenate([one.instants for one in parts]), shakings, first=first, samples=wanted, initial=initial,
            options=self.options,
        )  # fmt: skip
        seen: Mapping[str, FloatArray] = ran
        # instruments read beyond what is compared, and beyond the motion's end what it ends with; a cut run ends in nan
        if any(ahead) or len(parts[0].ways[0]) > 1:
            last = np.clip(shakings.ends - first, 0, wanted - 1)
            seen = Observed({c: partial(held, ran, c, last) for c in ran})

        @cache
        def along() -> tuple[FloatArray, FloatArray]:
            return together_along([one.along(m.first, samples) for one in parts])

        true = m.sensed(seen, shakings.first.time_step, along)
        for lanes, sets in self._recorded_alike(points, parts, instruments):
            found = {c: true[c][lanes] for c in m.channels}
            if any(switched for _, switched in sets):
                around = m.around(time_step, along()[0][lanes], time_step * first[lanes, None])
                found = dict(recorded_in_stages(found, sets, around, recorded_in_windows))
            for c, channel in enumerate(m.channels):
                out[point[lanes], window[lanes], c, :longest] = found[channel][..., :longest]

    def _recorded_alike(
        self, points: Sequence[Point], parts: Sequence[Lanes], instruments: Sequence[Switched]
    ) -> Iterable[tuple[NDArray[np.intp] | slice, Sets]]:
        """The lanes that the same instruments record from the same samples on, and these instruments."""
        groups: dict[tuple[object, ...], tuple[list[NDArray[np.intp]], Sets]] = {}
        begin = 0
        for one in parts:
            n = one.windows.size
            for p in one.members:
                sets = self.sets(instruments[p], self.measured.recordings[one.r], points[p].stages)
                key = tuple((at, *((k, frozenset(v.items())) for k, v in acting.items())) for at, acting in sets)
                groups.setdefault(key, ([], sets))[0].append(np.arange(begin, begin + n))
                begin += n
        if len(groups) == 1:
            return [(slice(None), sets) for _, sets in groups.values()]
        return [(np.concatenate(lanes), sets) for lanes, sets in groups.values()]

    def _through(
        self,
        r: int,
        points: Sequence[Point],
        members: Sequence[int],
        windows: NDArray[np.intp],
        shaking: Shaking,
        complete: Sequence[Mapping[str, float]],
        instruments: Sequence[Switched],
        out: FloatArray,
    ) -> None:
        """The windows as stretches of runs through a whole recording."""
        m, recording = self.measured, self.measured.recordings[r]
        parts = [self.parts(complete[p], recording, points[p].stages) for p in members]
        sets = [self.sets(instruments[p], recording, points[p].stages) for p in members]
        ran = run_through(m, r, parts, sets, shaking, self.options)
        for w in windows:
            first, samples = m.windows[w].first, m.windows[w].samples
            out[members, w, :, :samples] = ran[:, :, first : first + samples]

    def _ways(self, recording: Recording, stages: Stages | None = None) -> Ways:
        """From which sample of a recording (of its base, where means are compared) on which stages do not act."""
        stages = self.stages if stages is None else stages
        if not stages:
            return [(0, frozenset())]
        m = self.measured
        steps = {one.name: shaking.time_step for one, shaking in zip(m.recordings, m.shakings, strict=True)}
        step = steps.get(recording.name, recording.time_step)
        found = changes(stages.keys(), stages, recording.name)
        return [(first_sample(time, step), frozenset(stages) - acting) for time, acting in found]

    def shares(self, mechanism: str) -> FloatArray:
        """Of the samples of each recording (R,) those on which a mechanism acts if it is switched on."""
        m, found = self.measured, []
        for recording, shaking in zip(m.recordings, m.shakings, strict=True):
            ways, end = self._ways(recording), shaking.horizontal.size
            ends = [*(min(first, end) for first, _ in ways[1:]), end]
            on = [last - first for (first, off), last in zip(ways, ends, strict=True) if mechanism not in off]
            found.append(sum(on) / end)
        return np.array(found)

    def sets(
        self, instruments: Switched, recording: Recording, stages: Stages | None = None
    ) -> list[tuple[int, Switched]]:
        """From which sample of a recording on which of the instruments act; ``stages`` None: those of the predictor."""
        return [
            (first, {name: values for name, values in instruments.items() if name not in off})
            for first, off in self._ways(recording, stages)
        ]

    def parts(self, values: Mapping[str, float], recording: Recording, stages: Stages | None = None) -> list[Part]:
        """A point's values of the wall from sample to sample of a recording; ``stages`` as in `sets`."""
        plain = without_instruments(values)
        mechanisms = self.measured.model.mechanisms

        def acting(off: frozenset[str]) -> dict[str, float]:
            split = {name: name.partition(".") for name in plain}
            nulls = {n: mechanisms[m].parameter(p).null for n, (m, _, p) in split.items() if m in off}
            return {**plain, **nulls}

        return [Part(first, acting(off)) for first, off in self._ways(recording, stages)]

    def _values(
        self, complete: Sequence[Mapping[str, float]], off: frozenset[str], point: NDArray[np.intp]
    ) -> dict[str, float | FloatArray]:
        """Values of every lane's ``point`` (n,), one where all have the same; those of ``off`` at their nulls."""
        values: dict[str, float | FloatArray] = {}
        for name in complete[0]:
            mechanism, _, parameter = name.partition(".")
            if mechanism in off:
                values[name] = self.measured.model.mechanisms[mechanism].parameter(parameter).null
                continue
            column = np.array([one[name] for one in complete])
            values[name] = column[0] if np.all(column == column[0]) else column[point]
        return values
