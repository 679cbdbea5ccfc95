"""What a sensor remembers from before a window: no sign of what is missing, and as large as it is."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import models
from diagnosis.data.measured import Measured
from diagnosis.errors import model
from diagnosis.errors.adequacy import inadequacy
from diagnosis.errors.draws import draw
from diagnosis.errors.model import calibrated, refitted
from diagnosis.errors.past import before_windows
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import measure
from diagnosis.search.candidates import candidates
from diagnosis.search.refit import Explanation, extend, fit
from grids.instruments.filter import lag as lag_of
from grids.stages import Stage
from tests.diagnosis.made import SPECIMEN, TIME_STEP, TRUE, motion, recording

SEEDS = (1, 6)
FILTERS = {
    "causal": {"corner_hz": 2.5, "order": 2.0, "zero_phase": 0.0},
    "both ways": {"corner_hz": 2.5, "order": 3.0, "zero_phase": 1.0},
}


@cache
def seen(kind: str) -> tuple[Measured, Point]:
    """Recordings through a filter, and the point at the true parameters and states."""
    sensors = {"filter": FILTERS[kind]}
    measured = measure(SPECIMEN, [recording(f"train_{k}", k, sensors, noise=0.003) for k in SEEDS])
    # the recordings end in motion, and behind their ends nobody knows what a filter of zero phase was given
    ends = [measured.recordings[w.recording].time.size - w.first - w.samples for w in measured.windows]
    measured = measured.of_windows(np.flatnonzero(np.array(ends) * TIME_STEP > 0.5))
    lag = lag_of({"high_pass_hz": 0.0, **FILTERS[kind]})
    true = []
    for seed in SEEDS:
        base = motion(seed)
        ran = models.get("housner").simulate(TRUE, base, duration=base.duration).channels
        time = TIME_STEP * np.arange(base.horizontal.size)
        true.append([CubicSpline(time, np.ravel(ran[name])) for name in measured.free])
    starts = [[one(w.first * TIME_STEP - lag) for one in true[w.recording]] for w in measured.windows]
    values = {f"filter.{name}": value for name, value in FILTERS[kind].items()}
    return measured, Point({**TRUE, **values}, np.array(starts))


@pytest.mark.parametrize("kind", FILTERS)
def test_it_is_as_large_as_what_windows_lack_at_their_starts(kind: str) -> None:
    """At the true parameters and states, within 15 % of it; nothing is left of it at the windows' ends."""
    measured, point = seen(kind)
    predictor = Predictor(measured)
    noise = measured.sigma[:, 0, None]
    size = np.sqrt(np.sum(before_windows(predictor, point) ** 2, axis=-1))[:, 0]
    lacking = (measured.values - predictor.predict([point])[0])[:, 0]
    begin = slice(0, round(0.15 / TIME_STEP))
    expected, found = np.sqrt(np.mean((size**2 + noise**2)[:, begin])), np.sqrt(np.mean(lacking[:, begin] ** 2))
    assert expected > 1.5 * noise.max()
    assert found == pytest.approx(expected, rel=0.15)
    ends = [size[w, window.samples - 10 : window.samples] for w, window in enumerate(measured.windows)]
    assert np.median(ends) < 0.1 * size.max()


@pytest.mark.parametrize("kind", FILTERS)
def test_it_is_no_sign_of_what_is_missing(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The true model errs by nothing smooth; without what came before the windows it would, beyond chance."""
    measured, point = seen(kind)
    fitted, errors = calibrated(SPECIMEN, measured)
    held = {f"filter.{name}": value for name, value in FILTERS[kind].items() if name != "corner_hz"}
    one = next(c for c in candidates(measured, SPECIMEN) if c.name == "filter" and held.items() <= dict(c.held).items())
    start = np.array([one.unknowns[0].coordinate(FILTERS[kind]["corner_hz"])])
    explained = extend(Explanation((), fitted), one, start, 0).fitted
    found = fit(explained.misfit, explained.u, point.states, 200)
    _, with_memory = refitted(found, errors.base)
    weighed = with_memory.whitening(np.moveaxis(with_memory.past, -1, 0))
    assert np.max(np.sum(weighed**2, axis=-1)) < 1.0  # in units of what is expected: less than what it is by itself
    predictor, now = found.misfit.predictor, found.point
    elsewhere = with_memory.expected(predictor, now)(np.moveaxis(before_windows(predictor, now), -1, 0))
    assert np.max(np.sum(elsewhere**2, axis=-1)) < 1.0
    rngs = [np.random.default_rng(k) for k in range(300)]
    spread = np.var([draw(with_memory, measured, rng)[:, 0, :30] for rng in rngs], axis=0)
    alone = replace(with_memory, past=with_memory.past[..., :0])
    less = np.var([draw(alone, measured, rng)[:, 0, :30] for rng in rngs], axis=0)
    assert np.mean(spread - less) == pytest.approx(np.mean(np.sum(with_memory.past[:, 0, :30] ** 2, axis=-1)), rel=0.2)
    monkeypatch.setattr(model, "before_windows", lambda *_: np.zeros((*measured.values.shape, 0)))
    _, without = refitted(found, errors.base)
    assert inadequacy(with_memory).p_value > 0.05 and not inadequacy(with_memory).large
    assert inadequacy(without).p_value < 0.01 and without.loss > with_memory.loss + 100.0


def test_sensors_that_remember_nothing_have_no_such_error() -> None:
    measured, point = seen("causal")
    for more in ({}, {"gain.gain": 0.1}, {"delay.delay": 0.02}):
        assert before_windows(Predictor(measured), Point({**TRUE, **more}, point.states)).shape[-1] == 0
    assert before_windows(Predictor(measured), point).shape[-1] > 0


def test_windows_in_which_the_filter_does_not_act_have_no_such_error() -> None:
    """Nor do they tell how large it is in the others."""
    measured, point = seen("causal")
    first = measured.recording_of == 0
    here, there = (one.name for one in measured.recordings)
    only_here = {"filter": (Stage(here, 0.0, np.inf), Stage(there, 0.0, 0.0))}
    staged = before_windows(Predictor(measured, stages=only_here), point)
    alone = Predictor(measured.of_windows(np.flatnonzero(first)))
    assert not staged[~first].any()
    expected = before_windows(alone, Point(point.values, point.states[first]))
    np.testing.assert_allclose(np.sum(staged[first] ** 2, axis=-1), np.sum(expected**2, axis=-1), atol=1e-18)


def test_recordings_that_are_sampled_otherwise_have_their_own() -> None:
    fast, slow = (recording(f"train_{k}", k, {"filter": FILTERS["causal"]}, noise=0.003) for k in SEEDS)
    slow = replace(
        slow, time_step=2.0 * TIME_STEP, time=slow.time[::2], channels={n: x[::2] for n, x in slow.channels.items()}
    )
    measured = measure(SPECIMEN, [fast, slow])
    values = seen("causal")[1].values
    together = before_windows(Predictor(measured), Point(values, measured.states))
    for r in (0, 1):
        own = measured.recording_of == r
        alone = before_windows(Predictor(measured.of_windows(np.flatnonzero(own))), Point(values, measured.states[own]))
        assert alone.any()
        np.testing.assert_allclose(np.sum(together[own] ** 2, axis=-1), np.sum(alone**2, axis=-1), atol=1e-18)
