"""From parameters and window states to what the sensors would have recorded in every window.

All windows, for many parameter points at once: one call of ``model.trajectories`` for each recording and each
motion of the base, which carries the clock of the responses (`grids.instruments.windowed`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.measured import Measured
from diagnosis.fit.unknowns import instruments_of, without_instruments
from grids.instruments.base import Surroundings, Switched
from grids.instruments.windowed import moved_in_windows, recorded_in_windows, same_base, seconds_ahead
from models.base import FloatArray
from models.shaking import Shaking


@dataclass(frozen=True)
class Point:
    """One parameter setting (``mechanism.parameter`` for mechanisms) with the states (W, S) it starts from."""

    values: Mapping[str, float]
    states: FloatArray


@dataclass(frozen=True)
class Predictor:
    """Predictions for the windows of ``measured``."""

    measured: Measured
    options: Mapping[str, str] = field(default_factory=dict)

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
                shaking = moved_in_windows(given, instruments[members[0]])
                self._run(points, members, windows, shaking, complete, recording.time_step, instruments, out)
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
        time_step: float,
        instruments: Sequence[Switched],
        out: FloatArray,
    ) -> None:
        m = self.measured
        compared = max(m.windows[w].samples for w in windows)
        ahead = max(seconds_ahead(instruments[p]) for p in members)
        samples = compared + int(np.ceil(ahead / time_step))
        n, count = len(windows), len(members)
        values = {}
        for name in complete[0]:
            column = np.array([complete[p][name] for p in members])
            values[name] = column[0] if np.all(column == column[0]) else np.repeat(column, n)
        states = np.stack([points[p].states[windows] for p in members])
        initial = {s: states[:, :, k].ravel() for k, s in enumerate(m.model.states)}
        initial |= {k: np.tile(v[windows], count) for k, v in m.memory.items()}
        first = np.tile(m.first[windows], count)
        ran = m.model.trajectories(values, shaking, first=first, samples=samples, initial=initial, options=self.options)
        found = {c: _held(ran[c].reshape(count, n, samples), shaking, m.first[windows]) for c in m.channels}
        base = np.pad(m.base[windows][:, :compared], ((0, 0), (0, samples - compared)))
        start = np.asarray(time_step * m.first[windows, None], float)
        around = Surroundings(time_step, base, m.reference_peak, start)
        for k, p in enumerate(members):
            recorded = recorded_in_windows({c: found[c][k] for c in m.channels}, instruments[p], around)
            for c, channel in enumerate(m.channels):
                out[p, windows, c, :compared] = recorded[channel][:, :compared]


def _held(channel: FloatArray, shaking: Shaking, first: NDArray[np.int64]) -> FloatArray:
    """Channel (P, n, samples) with the last value held beyond the end of the recording."""
    last = np.clip(shaking.horizontal.size - 1 - first, 0, channel.shape[2] - 1)
    index = np.minimum(np.arange(channel.shape[2])[None, :], last[:, None])
    return np.take_along_axis(channel, np.broadcast_to(index, channel.shape), axis=2)
