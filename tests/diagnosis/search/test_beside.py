"""Effects that do not act together are left out of a search and said to be, not an error."""

from __future__ import annotations

import pytest

from diagnosis.errors.model import calibrated
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.setup import measure
from diagnosis.search import beside
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.refit import QUICK, Explanation, extend
from diagnosis.search.screen import score
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
