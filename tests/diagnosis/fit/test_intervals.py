"""Profiles: a better optimum takes the fit there, a stuck window does not narrow an interval."""

from __future__ import annotations

import numpy as np
import pytest

from diagnosis.fit.intervals import LEVEL, estimates, profile_rise, settled
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import ITERATIONS, Fitted, fit
from diagnosis.search.candidates import candidates
from diagnosis.search.refit import Explanation, extend, with_memory
from models.base import FloatArray
from tests.diagnosis.made import SPECIMEN, recording


def test_a_profile_leads_back_to_the_optimum() -> None:
    best = base_fit(SPECIMEN, measure(SPECIMEN, [recording("a", 1)]))
    stuck = fit(best.misfit, best.u + np.array([0.0, 1.5]), best.states, iterations=0)
    assert stuck.loss > best.loss + 1.0
    found, intervals = settled(stuck, ["width"])
    assert found.loss < best.loss + 0.5
    assert intervals["width"].low95 < best.values["width"] < intervals["width"].high95
    same, _ = settled(best, ["width"])
    assert same is best


def test_a_window_that_a_profile_leaves_stuck_does_not_narrow_the_interval(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each refit at a held value ends with one window in a motion that is not that of the recording."""
    best = base_fit(SPECIMEN, measure(SPECIMEN, [recording("a", 1)]))
    free = estimates(best, ["width"])["width"]
    astray = np.zeros_like(best.states)
    astray[1] = 4.0 * best.measured.state_size

    def stuck(misfit: Misfit, u: FloatArray, states: FloatArray, iterations: int = ITERATIONS) -> Fitted:
        found = fit(misfit, u, states, iterations)
        return fit(misfit, found.u, found.states + astray, 0) if states is best.states else found

    monkeypatch.setattr("diagnosis.fit.intervals.fit", stuck)
    held = profile_rise(best, 1, float(best.u[1]))
    assert held > 10.0 * LEVEL
    found = estimates(best, ["width"])["width"]
    for ends in zip((found.low95, found.high95), (free.low95, free.high95), strict=True):
        assert np.subtract(*ends) == pytest.approx(0.0, abs=0.05 * (free.high95 - free.low95))


def test_a_shape_on_which_nothing_depends_where_it_is_has_an_end_where_something_does() -> None:
    """A floor that is never reached: every lower one is as good, a higher one is reached."""
    wears = {"degradation": {"loss_of_restitution_per_impact": 0.004, "floor": 0.5}}
    base = base_fit(SPECIMEN, measure(SPECIMEN, [recording("run_2", 2, wears)]))  # 12 impacts before the last window
    own = next(c for c in candidates(base.measured, SPECIMEN) if c.name == "degradation")
    best = with_memory(extend(Explanation((), base), own, np.array([0.1, 0.0]))).fitted
    name = "degradation.floor"
    assert best.values[name] == pytest.approx(0.5)
    found = estimates(best, [name])[name]
    assert found.low95 == pytest.approx(0.5)
    assert 0.93 < found.high95 < 0.97
    index = [x.name for x in best.misfit.unknowns].index(name)
    unknown = best.misfit.unknowns[index]
    assert profile_rise(best, index, unknown.coordinate(found.high95)) == pytest.approx(LEVEL, rel=0.15)
    assert profile_rise(best, index, unknown.coordinate(0.9)) == pytest.approx(0.0, abs=0.1)
