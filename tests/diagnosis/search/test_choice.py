"""Which explanation is taken: what does not count is passed over for good, and variants leave room for other effects.

The fits are made up: only their losses, window by window, decide.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.search import beside, details, exchange, refit, select, weighing
from diagnosis.search import found as counting
from diagnosis.search.budget import Budget
from diagnosis.search.found import Search, rivals
from models.runs import DONE
from tests.diagnosis.search.made_up import TILT, A, B, C, Effect, fit, nothing_is_fitted, search


@pytest.fixture(autouse=True)
def made_up(monkeypatch: pytest.MonkeyPatch) -> None:
    nothing_is_fitted(monkeypatch)


def test_a_single_that_rests_on_one_window_does_not_come_back_when_the_errors_are_estimated_anew() -> None:
    clipped, tilt = fit(C, loss=700.0, first=300.0), fit(TILT, loss=800.0, first=500.0)
    found = search(fit(loss=1000.0, first=600.0), clipped, tilt)
    select.take_best_single(found)
    assert found.best.names == ("tilt",)
    weighing.weigh_again(found)
    assert found.best.names == ("tilt",)


def test_a_pair_is_weighed_though_a_single_that_was_passed_over_fits_better() -> None:
    clipped, pair = fit(C, loss=90.0, first=10.0), fit(A, TILT, loss=100.0)
    found = search(fit(loss=1000.0), clipped, fit(A, loss=300.0), pair)
    found.pass_over(clipped)
    found.best = pair
    weighing.weigh_again(found)
    assert found.best.names == ("maxwell", "tilt") and found.errors.loss == 100.0


def test_own_errors_are_those_of_two_of_a_name_and_fits_under_them_go_on_where_they_come_close(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fits: list[float] = []
    monkeypatch.setattr(weighing, "fit_under", lambda f, errors: (f, errors) if fits.append(f.loss) is None else None)
    pairs = [fit(Effect("maxwell", order=k), TILT, loss=100.0 + k) for k in range(2)]
    pairs.append(fit(TILT, Effect("maxwell", order=2), loss=102.0))
    found = search(fit(loss=1000.0), *pairs, fit(B, TILT, loss=200.0))
    found.best = pairs[0]
    weighing.weigh_again(found)
    assert found.best.candidates == pairs[0].candidates
    assert sorted(fits) == [100.0, 100.0, 101.0, 101.0, 200.0]


@pytest.mark.parametrize(
    ("stretches", "held", "kept"), [(None, False, [TILT]), (None, True, [TILT, B]), (object(), False, [TILT, B])]
)
def test_far_behind_an_explanation_of_everything_nothing_is_weighed(
    monkeypatch: pytest.MonkeyPatch, stretches: object, held: bool, kept: list[Effect]
) -> None:
    """But under errors that hold part of what is missing, and of whole runs, whose fits creep."""
    monkeypatch.setattr(counting, "explains_all", lambda _: True)
    monkeypatch.setattr(weighing, "errs", lambda _: held)
    known = [fit(one, loss=loss) for one, loss in ((TILT, 100.0), (B, 100.0 + counting.BEHIND + 1.0))]
    for one in known:
        one.measured.stretches = stretches
    found = search(fit(loss=1000.0), *known)
    found.best = known[0]
    weighing.weigh_again(found)
    assert [one.candidates[0] for one in found.tried] == kept


def test_a_detail_of_a_law_does_not_take_the_place_of_a_second_effect(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of evidence 50 000 of a law 200 are a detail; a lean brings 100, and counts."""
    law, detailed, leaning = fit(A, loss=10000.0), fit(A, B, loss=9800.0), fit(A, TILT, loss=9900.0)
    rest = {"maxwell": fit(TILT, loss=59000.0), "hardening": law, "tilt": law}
    for module in (details, exchange):
        monkeypatch.setattr(module, "without", lambda _, c, *__: rest[c.name])
    monkeypatch.setattr(select, "extended", lambda *_: [detailed, leaning])
    found = search(fit(loss=60000.0), law)
    found.best = law
    select._pairs(found, lambda *_: None)
    assert found.best.names == leaning.names


def test_the_next_pair_is_taken_where_the_likeliest_rests_on_one_window() -> None:
    law, clipped, leaning = fit(A, loss=10000.0), fit(A, C, loss=9000.0, first=4000.0), fit(A, TILT, loss=9800.0)
    found = search(fit(loss=60000.0), law)
    found.best = law
    assert select._pair_that_counts(found, law, [leaning, clipped]) is leaning
    assert not found.eligible(clipped)


def test_the_least_needed_effect_goes_and_what_would_do_without_the_other_is_its_rival(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    alone = {"tilt": fit(A, loss=902.0), "maxwell": fit(TILT, loss=908.0)}
    monkeypatch.setattr(exchange, "without", lambda _, c, *__: alone[c.name])
    found = search(fit(loss=1000.0))
    found.best = fit(TILT, A, loss=900.0)
    exchange.drop(found)
    assert found.best is alone["tilt"]
    assert [(near.candidate.name, near.gap) for near in rivals(found)] == [("tilt", 6.0)]


def scored(*effects: Effect) -> list[Any]:
    """Scores that fall by 5 from one to the next."""
    start = (np.zeros(1),)
    return [
        SimpleNamespace(candidate=c, statistic=1000.0 - 5.0 * k, starts=start, work=1.0) for k, c in enumerate(effects)
    ]


def test_variants_of_a_law_leave_room_for_other_effects(monkeypatch: pytest.MonkeyPatch) -> None:
    orders = [Effect("bouc_wen", order) for order in range(6)]
    tried: list[Effect] = []

    def extend(explanation: Any, candidate: Effect, *_: Any) -> Any:
        tried.append(candidate)
        return fit(*explanation.candidates, candidate, loss=900.0)

    monkeypatch.setattr(refit, "extend", extend)
    monkeypatch.setattr(beside, "again", lambda one: one)
    first: Any = fit(Effect("delay"), loss=1500.0)
    beside.extended(search(fit(loss=2000.0)), first, scored(*orders, TILT, A))
    assert tried == [orders[0], TILT, A, *orders[1:4]]
    tried.clear()
    but: Any = orders[0]
    beside.extended(search(fit(loss=2000.0)), first, scored(*orders, TILT, A), but=but)
    assert tried == [TILT, A, *orders[1:5]]


def test_a_later_start_is_bounded_by_the_best_before_it(monkeypatch: pytest.MonkeyPatch) -> None:
    losses = iter((1500.0, 1200.0, 1400.0, 1300.0))
    bounds: list[float] = []

    def extend(one: Any, candidate: Effect, start: Any, iterations: int, most: float) -> Any:
        bounds.append(most)
        return fit(candidate, loss=next(losses))

    monkeypatch.setattr(refit, "extend", extend)
    begins: Any = [fit(loss=2000.0), fit(loss=2100.0)]
    fits = refit.from_starts(begins, Effect("delay"), [np.zeros(1), np.ones(1)], 1450.0)  # type: ignore[arg-type]
    assert [one.loss for one in fits] == [1500.0, 1200.0, 1400.0, 1300.0]
    assert bounds == [1450.0, 1450.0, 1200.0 + refit.BETWEEN_STARTS, 1200.0 + refit.BETWEEN_STARTS]


def test_a_rival_is_kept_beside_variants_of_the_best() -> None:
    orders = [fit(Effect("bouc_wen", order), loss=1000.0 + 0.4 * order) for order in range(6)]
    tilt = fit(TILT, loss=1003.0)
    found = search(fit(loss=2000.0), *orders, tilt)
    found.best = orders[0]
    weighing.weigh_again(found)
    assert [near.candidate.name for near in rivals(found)] == ["tilt"]


def test_what_is_likelier_once_led_by_another_is_the_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    """Dashpot and tilt: the second is stuck in a window, until it starts from the states of the first."""
    dashpot, stuck, free = fit(A, loss=900.0), fit(TILT, loss=910.0), fit(TILT, loss=850.0)

    def led(one: Any, others: Any) -> Any:
        return free if one.names == ("tilt",) and [other.loss for other in others] == [900.0] else one

    monkeypatch.setattr(weighing, "from_states_of", led)
    found = search(fit(loss=2000.0), dashpot, stuck)
    found.best = dashpot
    weighing.weigh_again(found)
    assert found.best.names == ("tilt",) and found.errors.loss == found.best.loss == 850.0


def test_what_the_budget_broke_off_is_tried_when_there_is_work_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exchange, "without", lambda e, c, *_: fit(*(x for x in e.candidates if x is not c), loss=950.0))
    asked: list[str] = []

    def extended(found: Search, rest: Any, *_: Any, **__: Any) -> list[Any]:
        if found.affordable("x"):
            asked.append(rest.names[0])
            DONE.call(0, 20.0)
        return []

    monkeypatch.setattr(exchange, "extended", extended)
    found = search(fit(loss=2000.0))
    found.best, found.budget = fit(A, TILT, loss=900.0), Budget(10.0)
    exchange._try_others(found, False)
    assert len(asked) == 1 and not found.exchanged
    with found.work_of_its_own(1000.0):
        exchange._try_others(found, False)
    assert len(found.exchanged) == 2 and len(asked) == 3
    found.exchanged.clear()
    found.whole = Budget(-1.0)
    with found.work_of_its_own(1000.0):
        exchange._try_others(found, False)
    assert len(asked) == 3
    with found.work_of_its_own(1000.0, beyond=True):
        exchange._try_others(found, False)
    assert len(asked) == 5 and found.whole.spent
