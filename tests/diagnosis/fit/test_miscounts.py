"""Errors of the count of impacts before a window: what they leave, and what an interval owes to them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from diagnosis.data.measured import AsItWas
from diagnosis.fit import intervals
from diagnosis.fit.intervals import estimates
from diagnosis.fit.memory import counted, histories
from diagnosis.fit.miscounts import FIRST, LEAST, SHARE, miscounts
from diagnosis.fit.prediction import Predictor
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import fit_thoroughly
from diagnosis.search.candidates import candidates
from diagnosis.search.refit import Explanation, extend, with_memory
from tests.diagnosis.made import SPECIMEN, recording

LOSS = 0.004
WEARS = {"degradation": {"loss_of_restitution_per_impact": LOSS, "floor": 0.5}}
NAME = "degradation.loss_of_restitution_per_impact"


@cache
def worn() -> Explanation:
    """The law that is there, fitted under errors that know nothing of miscounts."""
    base = base_fit(SPECIMEN, measure(SPECIMEN, [recording(f"run_{k}", k, WEARS) for k in (1, 2)]))
    (own,) = (c for c in candidates(base.measured, SPECIMEN) if c.name == "degradation")
    return with_memory(extend(Explanation((), base), own, np.array([0.1, 0.0])))


def test_an_event_more_is_a_little_less_restitution() -> None:
    """e_H (1 - l n): the derivative by n is that by a factor on e_H, times -l/(1 - l n)."""
    fitted = worn().fitted
    predictor: Predictor = fitted.misfit.predictor
    measured, loss = predictor.measured, fitted.values[NAME]
    columns = miscounts(predictor, fitted.point)
    first = [np.flatnonzero(measured.recording_of == r)[0] for r in (0, 1)]
    of_first = [next(k for k in range(columns.shape[-1]) if columns[w, ..., k].any()) for w in first]

    def by_factor(step: float) -> np.ndarray:
        point = replace(fitted.point, values={**fitted.point.values, "restitution.factor_on_housner": 1.0 + step})
        return predictor.predict([point])[0]

    slope = np.where(measured.mask, (by_factor(1e-4) - by_factor(-1e-4)) / 2e-4, 0.0)
    expected = -loss / (1.0 - loss * measured.memory["impacts"][:, None, None]) * slope
    for r, k in enumerate(of_first):
        own = measured.recording_of == r
        assert not columns[~own, ..., k].any()
        deviation = max(
            FIRST, SHARE * measured.memory["impacts"][own][0]
        )  # no window follows what was before the first
        difference = columns[own, ..., k] / deviation - expected[own]
        assert np.sqrt(np.mean(difference**2)) < 0.05 * np.sqrt(np.mean(expected[own] ** 2))


def test_what_was_not_seen_between_two_windows_is_shared_by_those_after_it() -> None:
    """A quarter of what happened after the window before had ended, in proportion to the error of one event."""
    f = worn().fitted
    m, predictor = f.measured, f.misfit.predictor
    columns = miscounts(predictor, f.point)
    one = columns[..., 0] / max(FIRST, SHARE * m.memory["impacts"][0])
    gaps = []
    for own, events in histories(predictor, f.point):
        for k in range(1, own.size):
            ended = m.windows[own[k - 1]].samples * m.recordings[m.windows[own[0]].recording].time_step
            unseen = sum(e.kind == "impact" and e.time > ended for e in events[k])
            if SHARE * unseen >= LEAST and m.recording_of[own[0]] == 0:
                gaps.append((own[k:], SHARE * unseen))
    assert gaps
    for after, deviation in gaps:
        expected = np.zeros_like(one)
        expected[after] = deviation * one[after]
        assert any(np.allclose(columns[..., k], expected, rtol=1e-9, atol=1e-15) for k in range(columns.shape[-1]))


def test_no_law_that_counts_no_error() -> None:
    f = worn().fitted
    point = replace(f.point, values={**f.point.values, NAME: 0.0})
    assert miscounts(f.misfit.predictor, point).shape[-1] == 0


def test_events_are_counted_along_the_motion_as_it_was() -> None:
    """With the pulses of the base that stand for the scatter of impacts: as if the base had moved so."""
    f = worn().fitted
    m, predictor = f.measured, f.misfit.predictor
    pulses = tuple(np.where(np.arange(s.horizontal.size) % 200 < 20, 2.0, 0.0) for s in m.shakings)
    moved = tuple(replace(s, horizontal=s.horizontal + p) for s, p in zip(m.shakings, pulses, strict=True))
    plain, disturbed, pushed = (
        counted(replace(predictor, measured=one), f.point).memory["impacts"]
        for one in (m, replace(m, as_it_was=AsItWas(pulses, np.zeros(m.values.shape))), replace(m, shakings=moved))
    )
    assert np.array_equal(disturbed, pushed) and not np.array_equal(disturbed, plain)


@pytest.mark.parametrize("wrong", (-8.0, 8.0))
def test_a_recording_counted_wrongly_stays_within_the_interval(wrong: float, monkeypatch: pytest.MonkeyPatch) -> None:
    f = worn().fitted
    counts = f.measured.memory["impacts"] + wrong * (f.measured.recording_of == 0)
    predictor = replace(
        f.misfit.predictor, measured=replace(f.measured, memory={**f.measured.memory, "impacts": counts})
    )
    off = fit_thoroughly(replace(f.misfit, predictor=predictor), f.u, f.states)
    known = estimates(off, [NAME])[NAME]
    assert known.low95 < LOSS < known.high95
    monkeypatch.setattr(intervals, "miscounts", lambda predictor, point: np.zeros((*f.measured.values.shape, 0)))
    sure = intervals.estimates(off, [NAME])[NAME]
    assert not sure.low95 < LOSS < sure.high95
