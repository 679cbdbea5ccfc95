"""From parameters and window states to what the sensors would have recorded in every window.

All windows, for many parameter points at once: one call of ``model.trajectories`` for each
recording and each motion of the base. A lag or clock error of the responses is a change of the
base's clock, recorded(t) = true((1 + rate) t - lag): the base is read at (1 + rate) t - lag and the
window starts where it started, so nothing is read across a window's start.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.measured import Measured
from diagnosis.fit.unknowns import split
from grids.instruments import INSTRUMENTS
from grids.instruments.base import Surroundings
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
        sensors = [split(p.values, tuple(INSTRUMENTS)) for p in points]
        nulls = self._nulls(points)
        groups: dict[tuple[object, ...], list[int]] = {}
        for k, switched in enumerate(sensors):
            groups.setdefault(_base_key(switched), []).append(k)
        for r, recording in enumerate(m.recordings):
            windows = np.flatnonzero(m.recording_of == r)
            if not windows.size:
                continue
            given = m.shakings[r] if shakings is None else shakings[r]
            for members in groups.values():
                shaking = _as_felt(given, sensors[members[0]])
                self._run(points, members, windows, shaking, nulls, recording.time_step, sensors, out)
        return out

    def _nulls(self, points: Sequence[Point]) -> dict[str, float]:
        """Null values of every mechanism that some point uses, so that all points can run together."""
        acting = self.measured.model.mechanisms
        names = {k.partition(".")[0] for p in points for k in p.values if "." in k}
        return {f"{n}.{k}": v for n in sorted(names) if n in acting for k, v in acting[n].nulls.items()}

    def _run(
        self,
        points: Sequence[Point],
        members: Sequence[int],
        windows: NDArray[np.intp],
        shaking: Shaking,
        nulls: Mapping[str, float],
        time_step: float,
        sensors: Sequence[Mapping[str, Mapping[str, float]]],
        out: FloatArray,
    ) -> None:
        m = self.measured
        compared = max(m.windows[w].samples for w in windows)
        ahead = max(_ahead(sensors[p]) for p in members)
        samples = compared + int(np.ceil(ahead / time_step))
        n, count = len(windows), len(members)
        full = [{**nulls, **{k: v for k, v in points[p].values.items() if k.partition(".")[0] not in INSTRUMENTS}}
                for p in members]  # fmt: skip
        values = {}
        for name in full[0]:
            column = np.array([f[name] for f in full])
            values[name] = column[0] if np.all(column == column[0]) else np.repeat(column, n)
        states = np.stack([points[p].states[windows] for p in members])
        initial = {s: states[:, :, k].ravel() for k, s in enumerate(m.model.states)}
        initial |= {k: np.tile(v[windows], count) for k, v in m.memory.items()}
        first = np.tile(m.first[windows], count)
        ran = m.model.trajectories(values, shaking, first=first, samples=samples, initial=initial, options=self.options)
        found = {c: _held(ran[c].reshape(count, n, samples), shaking, m.first[windows]) for c in m.channels}
        base = np.pad(m.base[windows][:, :compared], ((0, 0), (0, samples - compared)))
        around = Surroundings(time_step, base)
        for k, p in enumerate(members):
            recorded = {c: found[c][k] for c in m.channels}
            for name, sensor in INSTRUMENTS.items():
                if name in sensors[p] and "response" in sensor.acts:
                    given = {**sensor.nulls, "reference_peak": m.reference_peak, **sensors[p][name]}
                    act = sensor.acts.get("windowed", sensor.acts["response"])
                    recorded = act(recorded, given, around)
            for c, channel in enumerate(m.channels):
                out[p, windows, c, :compared] = recorded[channel][:, :compared]


def _ahead(switched: Mapping[str, Mapping[str, float]]) -> float:
    """Seconds beyond a window's end that the sensors look."""
    return float(
        sum(
            sensor.acts["lag"]({**sensor.nulls, **switched[name]})
            for name, sensor in INSTRUMENTS.items()
            if name in switched and "lag" in sensor.acts
        )
    )


def _held(channel: FloatArray, shaking: Shaking, first: NDArray[np.int64]) -> FloatArray:
    """Channel (P, n, samples) with the last value held beyond the end of the recording."""
    last = np.clip(shaking.horizontal.size - 1 - first, 0, channel.shape[2] - 1)
    index = np.minimum(np.arange(channel.shape[2])[None, :], last[:, None])
    return np.take_along_axis(channel, np.broadcast_to(index, channel.shape), axis=2)


def _base_key(switched: Mapping[str, Mapping[str, float]]) -> tuple[object, ...]:
    """What two points must share to feel the same motion of the base."""
    return tuple(
        (name, tuple(sorted(switched[name].items())))
        for name, sensor in INSTRUMENTS.items()
        if name in switched and not {"base", "clock", "lag"}.isdisjoint(sensor.acts)
    )


def _as_felt(shaking: Shaking, switched: Mapping[str, Mapping[str, float]]) -> Shaking:
    """The motion of the base on the clock of the responses."""
    rate, lag = 0.0, 0.0
    for name, sensor in INSTRUMENTS.items():
        if name not in switched:
            continue
        given = {**sensor.nulls, **switched[name]}
        if "base" in sensor.acts:
            shaking = sensor.acts["base"](shaking, given)
        if "clock" in sensor.acts:
            more_rate, more_lag = sensor.acts["clock"](given)
            rate, lag = rate + more_rate, lag + more_lag
        if "lag" in sensor.acts:
            lag += sensor.acts["lag"](given)
    if rate == 0.0 and lag == 0.0:
        return shaking
    return read_at(shaking, rate, lag)


def read_at(shaking: Shaking, rate: float, lag: float) -> Shaking:
    """The shaking with sample k read at (1 + rate) t_k - lag, on a step (1 + rate) times as long."""
    from scipy.interpolate import CubicSpline

    count = shaking.horizontal.size
    time = np.arange(count) * shaking.time_step
    at = (1.0 + rate) * time - lag
    inside = (at >= 0.0) & (at <= time[-1])

    def read(samples: FloatArray) -> FloatArray:
        return np.where(inside, CubicSpline(time, samples)(np.clip(at, 0.0, time[-1])), 0.0)

    vertical = None if shaking.vertical is None else read(shaking.vertical)
    step = (1.0 + rate) * shaking.time_step
    return replace(shaking, time_step=step, horizontal=read(shaking.horizontal), vertical=vertical)
