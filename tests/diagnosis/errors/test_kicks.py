"""What a kick after an impact leaves is the derivative of the window by the rate there."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from diagnosis.errors.draws import scattered
from diagnosis.errors.kicks import kicks
from diagnosis.fit.prediction import Point
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import Fitted
from grids.specimen import Specimen
from models.identification import Identification, Scatter
from tests.diagnosis import stacks
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


def test_impacts_of_a_stack_scatter_at_both_joints_and_in_draws_in_proportion() -> None:
    wall = Specimen(title="block on a wall", model="stacked", parameters=stacks.ON_TOP)
    fitted = base_fit(wall, measure(wall, [stacks.rocking_on_top(1, both=True)]))
    found = kicks(fitted.misfit.predictor, fitted.point)
    joints = fitted.measured.identification.scatter.joints  # type: ignore[union-attr]
    each = [replace(fitted.measured.identification, scatter=Scatter("impacts", (joint,))) for joint in joints]
    counts = [_events_of(fitted, one) for one in each]
    assert min(counts) > 2 and sum(counts) == found.window.size and not np.any(found.height)
    known = SimpleNamespace(scatter=0.01, kicks=found)
    drawn = scattered(known, fitted, np.random.default_rng(1))  # type: ignore[arg-type]
    changes = 0.01 * np.random.default_rng(1).normal(size=found.window.size)
    expected = np.zeros(drawn.shape)
    for e, change in enumerate(changes):
        expected[found.window[e]] += change * found.columns[found.window[e], ..., found.place[e]]
    change = drawn - fitted.misfit.predictor.predict([fitted.point])[0]
    assert np.any(expected) and np.allclose(change, expected, rtol=0.0, atol=1e-12)


def _events_of(fitted: Fitted, identification: Identification) -> int:
    measured = fitted.measured
    model = type("Other", (type(measured.model),), {"identification": identification})()
    predictor = replace(fitted.misfit.predictor, measured=replace(measured, model=model))
    return int(kicks(predictor, fitted.point).window.size)


def _run(model, point: Point, shaking, first: int, samples: int, state: np.ndarray) -> np.ndarray:
    """Rotation and rate (2, samples)."""
    initial = {name: np.array([x]) for name, x in zip(model.states, state, strict=True)}
    initial |= {"peak_rotation_1": np.zeros(1), "impacts": np.zeros(1)}
    ran = model.trajectories(point.values, shaking, first=np.array([first]), samples=samples, initial=initial)
    return np.stack([ran[c][0] for c in ("rotation_1", "rotation_rate_1")])
