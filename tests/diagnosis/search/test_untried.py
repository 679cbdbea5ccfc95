"""What the budget left untried of a screen is tried in the place of the strongest single."""

from __future__ import annotations

from dataclasses import replace

import pytest

from diagnosis.errors.model import disturbance_about, estimate
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.setup import base_fit, measure
from diagnosis.progress import silent
from diagnosis.search import singles
from diagnosis.search.budget import ENDED, Budget
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation, extend
from diagnosis.search.screen import Score, score
from diagnosis.search.untried import in_its_place
from diagnosis.search.weighing import reweighed
from tests.diagnosis.made import SPECIMEN, recording

TRUE, WRONG = "restitution", "velocity_restitution"


@pytest.fixture(scope="module")
def begun() -> Search:
    """The wrong one of two laws of the impacts was refitted, then the budget ended."""
    measured = measure(
        SPECIMEN, [recording(f"run_{seed}", seed, {TRUE: {"factor_on_housner": 0.9}}) for seed in (1, 2)]
    )
    some = {one.name: one for one in candidates(measured, SPECIMEN) if one.name in (TRUE, WRONG, "tilt")}
    fitted = base_fit(SPECIMEN, measured)
    errors = estimate(fitted, disturbance_about(fitted))
    found = Search(reweighed(Explanation((), fitted), errors), tuple(some.values()), errors)
    found.scores = score(linearise_about(found.base.fitted), found.candidates)
    found.singles = [extend(found.base, some[WRONG], some[WRONG].null)]
    found.not_tried = {TRUE: ENDED, "tilt": ENDED}
    return found


def again(found: Search, budget: Budget) -> Search:
    return replace(found, singles=list(found.singles), not_tried=dict(found.not_tried), budget=budget)


def left(found: Search) -> list[Score]:
    return [entry for entry in found.scores if entry.candidate.name in found.not_tried]


def test_the_right_law_comes_first_however_late_it_is_tried(begun: Search) -> None:
    found = again(begun, Budget())
    in_its_place(found, left(found))
    assert found.singles[0].names == (TRUE,)
    assert found.singles[0].fitted.values["restitution.factor_on_housner"] == pytest.approx(0.9, abs=0.005)
    assert {single.names[0] for single in found.singles} == {TRUE, WRONG, "tilt"}
    assert not found.not_tried


def test_what_even_this_budget_does_not_reach_stays_noted(begun: Search) -> None:
    found = again(begun, Budget(most=0.0))
    in_its_place(found, left(found))
    assert [single.names for single in found.singles] == [(WRONG,)]
    assert found.not_tried == {TRUE: ENDED, "tilt": ENDED}


def test_a_search_whose_budget_ends_at_once_tries_all_that_the_screen_asks_for(begun: Search) -> None:
    class Short(Search):
        """With work for one refit, and for what was left."""

        def affordable(self, *names: str) -> bool:
            if self.singles and self.budget.most == Budget().most:
                self.not_tried |= dict.fromkeys(names, ENDED)
                return False
            return True

    found = Short(begun.base, begun.candidates, begun.errors)
    singles.take_further(found, singles.refit_singles(found, silent))
    assert {single.names[0] for single in found.singles} == {TRUE, WRONG, "tilt"}
    assert found.singles[0].names == (TRUE,) and TRUE not in found.not_tried
