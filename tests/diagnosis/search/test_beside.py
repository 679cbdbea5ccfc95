"""Effects that do not act together are left out of a search and said to be, not an error."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.errors.model import calibrated
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.setup import measure
from diagnosis.search import beside, refit
from diagnosis.search import found as found_module
from diagnosis.search.candidates import Candidate, candidates
from diagnosis.search.found import BEHIND, Search
from diagnosis.search.refit import QUICK, Explanation, extend
from diagnosis.search.screen import Score, score
from models.base import FloatArray
from tests.diagnosis.made import SPECIMEN, recording


def test_a_single_that_clashes_with_what_was_found_is_said_and_passed_over(monkeypatch: pytest.MonkeyPatch) -> None:
    """A bending wall and a rounded corner are no model together; each may be strong alone."""
    measured = measure(SPECIMEN, [recording("a", 1), recording("b", 2)])
    fitted, errors = calibrated(SPECIMEN, measured)
    base = Explanation((), fitted)
    known = {c.name: c for c in candidates(measured, SPECIMEN)}

    def single(name: str) -> Explanation:
        (entry,) = score(linearise_about(fitted), [known[name]])
        return extend(base, known[name], entry.starts[0] if entry.starts else known[name].null + 0.5, QUICK)

    corner, bending = single("rounded_corner"), single("wall_flexibility")
    found = Search(base, tuple(known.values()), errors, singles=[corner, bending])
    monkeypatch.setattr(beside, "explains_all", lambda one: False)
    monkeypatch.setattr(beside, "_strong_alone", lambda search, one: [bending])
    assert beside.extended(found, corner, [], widely=True) == []
    assert "do not act together" in found.not_tried["wall_flexibility"]


def test_once_a_pair_explains_everything_others_need_not_be_fitted_to_their_ends(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its rivals are; what is far behind is given up on the way and not fitted thoroughly."""
    effects = {"viscous_damping": {"rate": 0.15}, "base_gain": {"gain": 0.05}}
    measured = measure(SPECIMEN, [recording(f"run_{seed}", seed, effects) for seed in (1, 2)])
    fitted, errors = calibrated(SPECIMEN, measured)
    known = {c.name: c for c in candidates(measured, SPECIMEN)}
    base = Explanation((), fitted)
    lossy = extend(base, known["viscous_damping"], known["viscous_damping"].null + 0.5)
    scores = score(linearise_about(lossy.fitted), [known["base_gain"], known["tilt"]])
    given: list[float] = []
    thorough: list[str] = []

    def watched(one: Explanation, candidate: Candidate, start: FloatArray, iterations: int, most: float) -> Explanation:
        given.append(most)
        loss = 1000.0 if candidate.name == "base_gain" else 2000.0
        pair = extend(one, candidate, start, 0)
        return replace(pair, fitted=replace(pair.fitted, loss=loss))

    def taken_on(one: Explanation) -> Explanation:
        thorough.append(one.names[-1])
        return one

    monkeypatch.setattr(refit, "extend", watched)
    monkeypatch.setattr(beside, "again", taken_on)
    monkeypatch.setattr(beside, "explains_all", lambda _: False)
    monkeypatch.setattr(found_module, "explains_all", lambda one: one.names[-1] == "base_gain")
    beside.extended(Search(base, tuple(known.values()), errors), lossy, scores)
    assert scores[0].candidate.name == "base_gain"
    assert given[0] == np.inf and given[-1] == pytest.approx(1000.0 + BEHIND, abs=5.0)
    assert thorough == ["base_gain"]


def test_a_mechanism_of_many_short_steps_is_refitted_where_its_statistic_gives_hope() -> None:
    measured = measure(SPECIMEN, [recording("a", 1)])
    some = candidates(measured, SPECIMEN)[:6]
    start, column = (np.zeros(1),), np.zeros((1, 1))

    def chosen(statistic: float, work: float) -> list[int]:
        entries = [Score(c, 9.0 - k, start, column, work=100.0) for k, c in enumerate(some[1:])]
        one = Score(some[0], statistic, start, column, work=work)
        taken = beside.worth_a_refit(sorted([one, *entries], key=lambda s: -s.statistic), 6, 0.5)
        return [some.index(s.candidate) for s in taken]

    assert chosen(7.5, 100.0) == [1, 2, 0, 3, 4, 5]
    assert chosen(7.5, 1000.0) == [1, 2, 3, 4, 5]
    assert chosen(8.5, 1000.0) == [1, 0, 2, 3, 4, 5]
