"""What a kick after an impact leaves is the derivative of the window by the rate there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnosis.errors.kicks import kicks
from diagnosis.fit.prediction import Point
from diagnosis.fit.setup import base_fit, measure
from tests.diagnosis.made import SPECIMEN, recording


def test_kicks_are_differences_of_runs() -> None:
    measured = measure(SPECIMEN, [recording("a", 1), recording("b", 2)])
    fitted = base_fit(SPECIMEN, measured)
    found = kicks(fitted.misfit.predictor, fitted.point).columns
    assert np.count_nonzero(np.any(found != 0.0, axis=(1, 2))) > len(measured.windows)
    model, shaking, point = measured.model, measured.shakings[0], fitted.point
    checked = 0
    for w in np.flatnonzero(measured.recording_of == 0)[:4]:
        n = measured.windows[w].samples
        plain = _run(model, point, shaking, measured.first[w], n, point.states[w])
        for k, sample in enumerate(np.flatnonzero(plain[0, 1:] * plain[0, :-1] < 0.0)):
            after = int(sample) + 1
            if after + 4 > n:
                continue
            ends, (angle, rate) = [], plain[:, after]
            since = min(angle / rate, measured.recordings[0].time_step)
            assert since > 0.0
            for share in (1.002, 0.998):
                state = np.array([angle + (share - 1.0) * rate * since, share * rate])
                ends.append(_run(model, point, shaking, measured.first[w] + after, n - after, state)[0])
            slope = (ends[0] - ends[1]) / 0.004
            column = found[w, 0, after:n, k]
            assert np.all(found[w, 0, :after, k] == 0.0)
            assert np.corrcoef(column, slope)[0, 1] > 0.997
            assert abs(column @ slope / (slope @ slope) - 1.0) < 0.03
            checked += 1
    assert checked >= 4


def test_where_nothing_is_declared_nothing_scatters() -> None:
    measured = measure(SPECIMEN, [recording("a", 1)])
    fitted = base_fit(SPECIMEN, measured)
    silent = replace(measured.identification, scatter=None)
    model = type("Quiet", (type(measured.model),), {"identification": silent})()
    predictor = replace(fitted.misfit.predictor, measured=replace(measured, model=model))
    assert kicks(predictor, fitted.point).columns.shape[-1] == 0


def _run(model, point: Point, shaking, first: int, samples: int, state: np.ndarray) -> np.ndarray:
    """Rotation and rate (2, samples)."""
    initial = {name: np.array([x]) for name, x in zip(model.states, state, strict=True)}
    initial |= {"peak_rotation_1": np.zeros(1), "impacts": np.zeros(1)}
    ran = model.trajectories(point.values, shaking, first=np.array([first]), samples=samples, initial=initial)
    return np.stack([ran[c][0] for c in ("rotation_1", "rotation_rate_1")])
