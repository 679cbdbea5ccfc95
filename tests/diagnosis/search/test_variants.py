"""Whole numbers, such as the order of a filter, have intervals too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.errors.model import disturbance_about, estimate
from diagnosis.fit.intervals import estimates
from diagnosis.fit.setup import base_fit, measure
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation, extend
from diagnosis.search.variants import held_numbers, variants, widened, with_other_numbers
from diagnosis.search.weighing import reweighed
from tests.diagnosis.made import SPECIMEN, recording

ORDER = 2.0


def search(corner: float, order: float) -> Search:
    """Recordings through a low-pass of ORDER, that was found with ``order``."""
    true = {"filter": {"corner_hz": corner, "order": ORDER}}
    measured = measure(SPECIMEN, [recording(f"run_{seed}", seed, true) for seed in (1, 2)])
    filters = [c for c in candidates(measured, SPECIMEN) if c.unknowns[0].name == "filter.corner_hz"]
    base = Explanation((), base_fit(SPECIMEN, measured))
    (own,) = [c for c in filters if c.held == {"filter.order": ORDER, "filter.zero_phase": 0.0}]
    errors = estimate(extend(base, own, own.null).fitted, disturbance_about(base.fitted))
    found = Search(reweighed(base, errors), tuple(filters), errors)
    (one,) = [c for c in filters if c.held == {"filter.order": order, "filter.zero_phase": 0.0}]
    found.best = extend(found.base, one, np.array([one.unknowns[0].coordinate(corner)]))
    return found


@pytest.mark.parametrize(("corner", "known"), [(4.0, True), (10.0, False), (60.0, False)])
def test_the_likeliest_order_is_taken_and_its_interval_holds_those_that_fit_as_well(corner: float, known: bool) -> None:
    found = search(corner, 4.0)
    with_other_numbers(found)
    best = found.best
    assert best is not None
    tried = [c.held for e in [best, *variants(best, found.tried)] for c in e.candidates]
    assert {one["filter.order"] for one in tried} == {1, 2, 3, 4}
    assert {one["filter.zero_phase"] for one in tried} == {0, 1}
    order = held_numbers(best, found.tried)["filter.order"]
    assert order.low95 <= ORDER <= order.high95
    assert (order.low95 == order.high95) is known
    if known:
        assert order.estimate == ORDER
    alone = estimates(best.fitted)
    wider = widened(alone, best, found)
    held = wider["filter.corner_hz"]
    assert held.low95 <= corner <= held.high95
    assert (wider == alone) is known


def test_fits_under_other_errors_are_no_variants() -> None:
    found = search(4.0, ORDER)
    with_other_numbers(found)
    best = found.best
    assert best is not None
    (other, *_) = variants(best, found.tried)
    whitening = other.fitted.misfit.whitening
    moved = replace(other.fitted.misfit, whitening=replace(whitening, sensor=whitening.sensor * 0.5))
    assert not variants(best, [replace(other, fitted=replace(other.fitted, misfit=moved))])


def test_a_clock_knows_of_a_lag_too_short_to_be_named() -> None:
    """A filter of 5 ms beside it: alone the clock takes a part of that for its own."""
    rate = 0.004
    true = {"clock": {"rate": rate}, "filter": {"corner_hz": 45.0, "order": 2.0}}
    measured = measure(SPECIMEN, [recording(f"run_{seed}", seed, true) for seed in (1, 2)])
    both = {c.name: c for c in candidates(measured, SPECIMEN) if c.name in ("clock", "delay")}
    base = Explanation((), base_fit(SPECIMEN, measured))
    best = extend(base, both["clock"], both["clock"].null)
    found = Search(base, tuple(both.values()), estimate(best.fitted, disturbance_about(best.fitted)))
    alone = estimates(best.fitted)
    held = widened(alone, best, found)["clock.rate"]
    assert not alone["clock.rate"].low95 <= rate <= alone["clock.rate"].high95
    assert held.low95 <= rate <= held.high95
    with_lag = extend(best, both["delay"], both["delay"].null)
    assert widened(estimates(with_lag.fitted), with_lag, found) == estimates(with_lag.fitted)
    in_a_table = replace(best.fitted.misfit, smooth=np.zeros((0, best.fitted.u.size)))
    law = replace(best, fitted=replace(best.fitted, misfit=in_a_table))
    assert widened(alone, law, found) == alone
