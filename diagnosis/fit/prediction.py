"""From parameters and window states to what the sensors would have recorded in every window.

All windows, for many parameter points at once: one call of the model for each recording and each motion of the
base, which carries the clock of the responses (`grids.instruments.windowed`). Mechanisms with stages act in their
intervals: a window before or after an instant runs as it is then; one that holds it is cut there and goes on from its
state (`models.piecewise`), and what instruments do to it changes at that sample.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.measured import Measured
from diagnosis.fit.carrying import Asked, Carrying, Setting
from diagnosis.fit.through import run_through
from diagnosis.fit.unknowns import instruments_of, without_instruments
from grids.instruments.base import Switched
from grids.instruments.staged import Sets, moved_in_stages, recorded_in_stages
from grids.instruments.windowed import moved_in_windows, recorded_in_windows, same_base, seconds_ahead
from grids.recordings.base import Recording
from grids.stages import Stage, changes, first_sample
from models.base import FloatArray
from models.identification import Rung
from models.kinematics import ground_along
from models.observed import Observed
from models.piecewise import Part, trajectories
from models.shaking import Shaking

Stages = Mapping[str, Sequence[Stage]]
Ways = Sequence[tuple[int, frozenset[str]]]
"""From which sample on which mechanisms do not act."""


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

        Meaningless but in windows ``only``. Events are as the law has them: where they are known as they were
        (`AsItWas`), linear about that motion.
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
                for members, sets in alike:
                    shaken = moved_in_stages(plain, sets)
                    self._through(r, points, members, windows, shaken, complete, instruments, out)
                continue
            grounds = [moved_in_stages(m.shakings[r], sets, moved_in_windows) for _, sets in alike]
            moves.append(_Moves(r, windows, alike, grounds))
        for one, carried in zip(moves, self._carried(moves, points, complete, instruments), strict=True):
            for (own, acting), ground in zip(one.alike, one.grounds, strict=True):
                shaking = ground if shakings is None else moved_in_stages(shakings[one.r], acting, moved_in_windows)
                # probes of the base are disturbances of the model: accelerometers are on the base as it moves
                around = m.disturbed(shaking, one.r), ground
                recording = m.recordings[one.r]
                self._run(points, own, one.windows, around, complete, recording, instruments, carried, out)
        return out if m.as_it_was is None else out - m.as_it_was.offset

    def declared(self, points: Sequence[Point]) -> list[Point]:
        """The points with the model's own parameters in the place of a fit's coordinates."""
        found = [p if p.rung is None else replace(p, values=p.rung.values(p.values), rung=None) for p in points]
        points = list(found)
        given = [k for k, point in enumerate(points) if point.coordinates]
        complete = self._complete([points[k] for k in given])
        if not any("." in name for values in complete[:1] for name in values):
            return [replace(point, coordinates=()) for point in points]
        names = points[given[0]].coordinates
        own = self.measured.model.declared(self._values(complete, frozenset(), 1), names, self.options)
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
        members: Sequence[int],
        windows: NDArray[np.intp],
        shakings: tuple[Shaking, Shaking],
        complete: Sequence[Mapping[str, float]],
        recording: Recording,
        instruments: Sequence[Switched],
        carried: Mapping[str, FloatArray],
        out: FloatArray,
    ) -> None:
        m, time_step = self.measured, recording.time_step
        ways = [self._ways(recording, points[p].stages) for p in members]
        shaking, ground = shakings
        compared = np.array([m.windows[w].samples for w in windows])
        ahead = max(seconds_ahead(instruments[p]) for p in members)
        wanted = compared + int(np.ceil(ahead / time_step)) + any(place.order for place in m.places.values())
        longest, samples = int(compared.max()), int(wanted.max())
        n, count = len(windows), len(members)
        parts = [self._values([complete[p] for p in members], off, n) for _, off in ways[0]]
        instants = np.repeat(np.array([[first for first, _ in own[1:]] for own in ways], np.int64), n, axis=0)
        states = np.stack([points[p].states[windows] for p in members])
        initial = {s: states[:, :, k].ravel() for k, s in enumerate(m.free)}
        initial |= {s: initial[of] for s, of in m.alike.items() if s not in initial}
        initial |= {k: np.tile(v[windows], count) for k, v in m.memory.items()}
        initial |= {k: v[members].reshape(n * count, *v.shape[2:]) for k, v in carried.items()}
        first = np.tile(m.first[windows], count)
        ran = trajectories(
            m.model, parts, instants, shaking, first=first, samples=np.tile(wanted, count), initial=initial,
            options=self.options,
        )  # fmt: skip
        last = np.clip(shaking.horizontal.size - 1 - m.first[windows], 0, wanted - 1)
        seen = Observed({c: partial(held, ran, c, (count, n, samples), last) for c in ran})
        along = ground_along(ground, m.first[windows], samples)
        found = m.sensed(seen, shaking.time_step, along)
        start = np.asarray(time_step * m.first[windows, None], float)
        around = m.around(time_step, along[0], start)
        for alike in _alike([instruments[p] for p in members]):
            true = {c: found[c][alike] for c in m.channels}
            leader = members[alike[0]]
            sets = self.sets(instruments[leader], recording, points[leader].stages)
            recorded = recorded_in_stages(true, sets, around, recorded_in_windows)
            rows = np.array([members[k] for k in alike])[:, None]
            for c, channel in enumerate(m.channels):
                out[rows, windows, c, :longest] = recorded[channel][..., :longest]

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
        self, points: Sequence[Mapping[str, float]], off: frozenset[str], windows: int
    ) -> dict[str, float | FloatArray]:
        """Values of the points for their lanes, one for all or (points x windows,); those of ``off`` at their nulls."""
        values: dict[str, float | FloatArray] = {}
        for name in points[0]:
            mechanism, _, parameter = name.partition(".")
            column = np.array([point[name] for point in points])
            if mechanism in off:
                column[:] = self.measured.model.mechanisms[mechanism].parameter(parameter).null
            values[name] = column[0] if np.all(column == column[0]) else np.repeat(column, windows)
        return values


def _alike(instruments: Sequence[Switched]) -> list[list[int]]:
    """Which of several settings of the instruments are the same."""
    groups: dict[frozenset[object], list[int]] = {}
    for k, switched in enumerate(instruments):
        key = frozenset((name, frozenset(values.items())) for name, values in switched.items())
        groups.setdefault(key, []).append(k)
    return list(groups.values())


def held(ran: Mapping[str, FloatArray], name: str, shape: tuple[int, ...], last: NDArray[np.int64]) -> FloatArray:
    """A channel in the shape (P, n, samples) with the value at sample ``last`` (n,) held beyond it."""
    channel = ran[name].reshape(shape)
    short = np.flatnonzero(last < shape[2] - 1)
    if short.size:
        channel = channel.copy()
        for w, end in zip(short, last[short], strict=True):
            channel[:, w, end + 1 :] = channel[:, w, end, None]
    return channel
