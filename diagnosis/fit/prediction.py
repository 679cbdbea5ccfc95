"""From parameters and window states to what the sensors would have recorded in every window.

All windows, for many parameter points at once: one call of the model for each recording and each motion of the
base, which carries the clock of the responses (`grids.instruments.windowed`). Mechanisms with stages act in their
intervals: a window before or after an instant runs as it is then; one that holds it is cut there and goes on from its
state (`models.piecewise`), and what instruments do to it changes at that sample.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.measured import Measured
from diagnosis.fit.unknowns import instruments_of, without_instruments
from grids.instruments.base import Surroundings, Switched
from grids.instruments.staged import moved_in_stages, recorded_in_stages
from grids.instruments.windowed import moved_in_windows, recorded_in_windows, same_base, seconds_ahead
from grids.recordings.base import Recording
from grids.stages import Stage, changes, first_sample
from models.base import FloatArray
from models.piecewise import Part, trajectories
from models.shaking import Shaking


@dataclass(frozen=True)
class Point:
    """One parameter setting (``mechanism.parameter`` for mechanisms) with the states (W, S) it starts from."""

    values: Mapping[str, float]
    states: FloatArray


@dataclass(frozen=True)
class Predictor:
    """Predictions for the windows of ``measured``; ``stages`` by mechanism, of those that do not always act."""

    measured: Measured
    options: Mapping[str, str] = field(default_factory=dict)
    stages: Mapping[str, Sequence[Stage]] = field(default_factory=dict)

    def predict(self, points: Sequence[Point], shakings: Sequence[Shaking] | None = None) -> FloatArray:
        """Channels (P, W, C, N) of P points; ``shakings`` replace the measured ones."""
        m = self.measured
        out = np.zeros((len(points), *m.values.shape))
        instruments = [instruments_of(p.values) for p in points]
        complete = self._complete(points)
        groups: dict[tuple[object, ...], list[int]] = {}
        for k, switched in enumerate(instruments):
            groups.setdefault(same_base(switched), []).append(k)
        for r, recording in enumerate(m.recordings):
            windows = np.flatnonzero(m.recording_of == r)
            if not windows.size:
                continue
            given = m.shakings[r] if shakings is None else shakings[r]
            for members in groups.values():
                shaking = moved_in_stages(given, self.sets(instruments[members[0]], recording), moved_in_windows)
                self._run(points, members, windows, shaking, complete, recording, instruments, out)
        return out

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

    def _run(
        self,
        points: Sequence[Point],
        members: Sequence[int],
        windows: NDArray[np.intp],
        shaking: Shaking,
        complete: Sequence[Mapping[str, float]],
        recording: Recording,
        instruments: Sequence[Switched],
        out: FloatArray,
    ) -> None:
        m, time_step, ways = self.measured, recording.time_step, self._ways(recording)
        compared = max(m.windows[w].samples for w in windows)
        ahead = max(seconds_ahead(instruments[p]) for p in members)
        samples = compared + int(np.ceil(ahead / time_step))
        n, count = len(windows), len(members)
        parts = [self._values([complete[p] for p in members], off, n) for _, off in ways]
        instants = np.tile(np.array([first for first, _ in ways[1:]], np.int64), (n * count, 1))
        states = np.stack([points[p].states[windows] for p in members])
        initial = {s: states[:, :, k].ravel() for k, s in enumerate(m.model.states)}
        initial |= {k: np.tile(v[windows], count) for k, v in m.memory.items()}
        first = np.tile(m.first[windows], count)
        ran = trajectories(
            m.model, parts, instants, shaking, first=first, samples=samples, initial=initial, options=self.options
        )
        found = {c: _held(ran[c].reshape(count, n, samples), shaking, m.first[windows]) for c in m.channels}
        base = np.pad(m.base[windows][:, :compared], ((0, 0), (0, samples - compared)))
        start = np.asarray(time_step * m.first[windows, None], float)
        around = Surroundings(time_step, base, m.reference_peak, start)
        for k, p in enumerate(members):
            true = {c: found[c][k] for c in m.channels}
            recorded = recorded_in_stages(true, self.sets(instruments[p], recording), around, recorded_in_windows)
            for c, channel in enumerate(m.channels):
                out[p, windows, c, :compared] = recorded[channel][:, :compared]

    def _ways(self, recording: Recording) -> list[tuple[int, frozenset[str]]]:
        """From which sample of a recording on which mechanisms with stages do not act."""
        step = recording.time_step
        found = changes(self.stages.keys(), self.stages, recording.name)
        return [(first_sample(time, step), frozenset(self.stages) - acting) for time, acting in found]

    def sets(self, instruments: Switched, recording: Recording) -> list[tuple[int, Switched]]:
        """From which sample of a recording on which of the instruments act."""
        return [
            (first, {name: values for name, values in instruments.items() if name not in off})
            for first, off in self._ways(recording)
        ]

    def parts(self, values: Mapping[str, float], recording: Recording) -> list[Part]:
        """A point's values of the wall from sample to sample of a recording."""
        plain = without_instruments(values)
        return [Part(first, self._values([plain], off, 1)) for first, off in self._ways(recording)]

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


def _held(channel: FloatArray, shaking: Shaking, first: NDArray[np.int64]) -> FloatArray:
    """Channel (P, n, samples) with the last value held beyond the end of the recording."""
    last = np.clip(shaking.horizontal.size - 1 - first, 0, channel.shape[2] - 1)
    index = np.minimum(np.arange(channel.shape[2])[None, :], last[:, None])
    return np.take_along_axis(channel, np.broadcast_to(index, channel.shape), axis=2)
