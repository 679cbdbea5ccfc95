"""In which run of windows a mechanism is asked for: one Gauss-Newton step for each run against refits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.data.measured import AsItWas
from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.search.asked import asked_for, losses
from diagnosis.search.candidates import candidates
from diagnosis.search.refit import Explanation, again, extend
from diagnosis.search.runs import runs
from diagnosis.search.spells import of_windows
from diagnosis.search.staged import refitted_in
from tests.diagnosis.made import SPECIMEN
from tests.diagnosis.search.changing import made

INSTANT = 6.0


@pytest.fixture(scope="module")
def in_a_wrong_spell() -> Explanation:
    """A law of impacts that changes in the second of two recordings, fitted as one of the first half of all."""
    recordings = [made("a", 13, []), made("b", 6, [(INSTANT, {"restitution.factor_on_housner": 0.95})])]
    measured = measure(SPECIMEN, recordings)
    fitted, _ = calibrated(SPECIMEN, measured)
    known = {c.name: c for c in candidates(measured, SPECIMEN)}
    wrong = of_windows(measured, 0, len(measured.windows) // 2)
    staged = replace(known["restitution"], spell=wrong)
    start = staged.null.copy()
    start[0] -= 0.2
    return extend(Explanation((), fitted), staged, start)


def test_the_run_asked_for_is_the_true_one_from_a_wrong_one(in_a_wrong_spell: Explanation) -> None:
    spell = asked_for(in_a_wrong_spell)
    assert (spell.first, spell.last, spell.ends) == (1, 1, None)
    assert spell.begins == pytest.approx(INSTANT, abs=1.0)


def test_losses_of_runs_are_those_of_refits(in_a_wrong_spell: Explanation) -> None:
    """Of a fit in the true run, for runs that differ from it by a window."""
    m, settled = in_a_wrong_spell.measured, again(refitted_in(in_a_wrong_spell, asked_for(in_a_wrong_spell)))
    ends = runs(len(m.windows))
    predicted = losses(settled, ends)
    best = int(np.argmin(predicted))
    assert predicted[best] == pytest.approx(settled.loss, rel=0.02)
    low, high = ends[best].tolist()
    for run in ([low + 1, high], [low - 1, high], [low, high - 1]):
        (k,) = np.flatnonzero((ends == run).all(axis=1))
        actual = again(refitted_in(settled, of_windows(m, *run))).loss
        assert predicted[k] - settled.loss == pytest.approx(actual - settled.loss, rel=0.3, abs=3.0)


def test_what_events_were_taken_for_may_stand_for_the_mechanism(in_a_wrong_spell: Explanation) -> None:
    """Events as they were estimated about the base may be wrong with the mechanism: without them counts too."""
    m, f = in_a_wrong_spell.measured, in_a_wrong_spell.fitted
    wrong = AsItWas(tuple(np.zeros_like(one.horizontal) for one in m.shakings), 0.1 * m.values)
    predictor = replace(f.misfit.predictor, measured=replace(m, as_it_was=wrong))
    about = replace(in_a_wrong_spell, fitted=replace(f, misfit=replace(f.misfit, predictor=predictor)))
    ends = runs(len(m.windows))
    np.testing.assert_allclose(losses(about, ends), losses(in_a_wrong_spell, ends))
    spell = asked_for(in_a_wrong_spell)
    assert refitted_in(about, spell).loss == pytest.approx(refitted_in(in_a_wrong_spell, spell).loss)
