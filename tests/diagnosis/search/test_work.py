"""What a search spends its work on: what is hopeless takes none from what is not. The fits are made up."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.search import beside, exchange, refit, select, weighing
from diagnosis.search import found as counting
from diagnosis.search.budget import FURTHER, THIRD, Budget
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation
from models.runs import DONE
from tests.diagnosis.search.made_up import NOTHING, TILT, A, B, C, Effect, fit, nothing_is_fitted, search


@pytest.fixture(autouse=True)
def made_up(monkeypatch: pytest.MonkeyPatch) -> None:
    nothing_is_fitted(monkeypatch)


def test_pairs_are_weighed_by_what_they_explain_beyond_one_effect() -> None:
    """The first of them explains most of what any pair does."""
    pairs = [fit(A, other, loss=loss) for other, loss in ((TILT, 100.0), (B, 265.0), (C, 275.0))]
    found = search(fit(loss=10000.0), *pairs, fit(A, loss=350.0))
    found.best = pairs[0]
    weighing.weigh_again(found)
    assert [one.candidates[1] for one in found.tried] == [TILT, B]


def test_what_fits_better_from_the_states_of_the_best_takes_its_place(monkeypatch: pytest.MonkeyPatch) -> None:
    """Unless it was passed over."""
    better = fit(A, C, loss=50.0)
    monkeypatch.setattr(weighing, "from_states_of", lambda one, _: better if C in one.candidates else one)
    monkeypatch.setattr(weighing, "led_by_each_other", lambda judged, *_: judged)
    pairs = [fit(A, TILT, loss=100.0), fit(A, C, loss=110.0)]
    for passed_over, expected in (([], better), ([better], pairs[0])):
        found = search(fit(loss=10000.0), *pairs)
        found.best = pairs[0]
        for one in passed_over:
            found.pass_over(one)
        weighing.weigh_again(found)
        assert found.best.candidates == expected.candidates


@pytest.mark.parametrize(("most", "asked"), [(np.inf, [100.0, 110.0, 120.0]), (30.0, [100.0, 110.0])])
def test_mechanisms_are_weighed_as_long_as_it_is_worth_it(
    monkeypatch: pytest.MonkeyPatch, most: float, asked: list[float]
) -> None:
    own: list[float] = []

    def judged(explanation: Any, errors: Any) -> weighing.Judged:
        own.append(explanation.loss)
        DONE.call(0, 20.0)
        return weighing.Judged(explanation.loss, explanation, NOTHING)

    monkeypatch.setattr(weighing.Judged, "of", judged)
    singles = [fit(one, loss=100.0 + 10.0 * k) for k, one in enumerate((A, B, TILT))]
    found = search(fit(loss=1000.0), *singles)
    found.best = singles[0]
    weighing.weigh_again(found, most)
    assert own == asked and found.best.candidates == (A,)


def test_refits_that_do_not_come_near_the_best_exchange_before_are_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    bounds: list[float] = []

    def extended(found: Search, rest: Any, scores: Any, widely: bool, but: Any, most: float) -> list[Any]:
        bounds.append(most)
        return [fit(A, C, loss=500.0), fit(A, B, loss=600.0)]

    monkeypatch.setattr(exchange, "extended", extended)
    monkeypatch.setattr(exchange, "without", lambda best, candidate, _=0: fit(*best.candidates[:1], loss=1000.0))
    found = search(fit(loss=2000.0))
    found.best = fit(A, TILT, loss=900.0)
    found.best.measured.stretches = None
    exchange._try_others(found, False)
    assert bounds == [900.0 + weighing.CLOSE, 500.0 + weighing.CLOSE]


def test_others_on_which_the_budget_ended_come_last_when_it_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[str, ...]] = []

    def extended(found: Search, rest: Any, *_: Any) -> list[Any]:
        asked.append(rest.names)
        found.budget = Budget(-1.0)
        return []

    left = {A: fit(B, loss=900.0), B: fit(A, loss=990.0)}
    monkeypatch.setattr(exchange, "extended", extended)
    monkeypatch.setattr(exchange, "without", lambda best, candidate, _: left[candidate])
    found = search(fit(loss=2000.0))
    found.best = fit(A, B, loss=500.0)
    found.best.measured.stretches = None
    for _ in left:
        exchange._try_others(found, False)
        found.budget = Budget()
    assert asked == [(B.name,), (A.name,)]
    assert found.cut == {frozenset({A}), frozenset({B})} and not found.exchanged


def test_what_cannot_reach_the_best_exchange_is_not_taken_further(monkeypatch: pytest.MonkeyPatch) -> None:
    """But for a window whose motion may have lost its way."""
    pairs = [fit(A, B, loss=900.0, first=450.0), fit(A, C, loss=950.0, first=475.0)]
    further: list[Any] = []
    monkeypatch.setattr(beside, "reaching", lambda one, most: one)
    monkeypatch.setattr(beside, "worth_a_refit", lambda *_: [])
    monkeypatch.setattr(beside, "_strong_alone", lambda *_: pairs)
    monkeypatch.setattr(beside, "joined", lambda _, single, most: single)
    monkeypatch.setattr(beside, "again", lambda one: further.append(one) or one)
    for most, expected in ((np.inf, pairs), (460.0, pairs[:1]), (440.0, [])):
        further.clear()
        beside.extended(search(fit(loss=2000.0)), fit(A, loss=1500.0), [], widely=True, most=most)
        assert further == expected


def test_quick_fits_go_on_that_may_reach_the_best_exchange(monkeypatch: pytest.MonkeyPatch) -> None:
    """The few best, as far as they promise to; what then reaches it is taken further as others are."""
    pairs = [fit(A, other, loss=loss) for other, loss in ((B, 900.0), (C, 950.0), (TILT, 990.0))]
    ended, gone_on, thoroughly = fit(A, C, loss=100.0), [], []
    monkeypatch.setattr(beside, "worth_a_refit", lambda *_: [])
    monkeypatch.setattr(beside, "_strong_alone", lambda *_: pairs)
    monkeypatch.setattr(beside, "joined", lambda _, single, most: single)
    monkeypatch.setattr(beside, "again", lambda one: thoroughly.append(one) or one)

    def reaching(one: Any, most: float) -> Any:
        gone_on.append((one.loss, most))
        return ended if one is pairs[1] else one

    monkeypatch.setattr(beside, "reaching", reaching)
    found = beside.extended(search(fit(loss=2000.0)), fit(A, loss=1500.0), [], widely=True, most=200.0)
    assert gone_on == [(900.0, 200.0), (950.0, 200.0)]
    assert found == [ended, pairs[0], pairs[2]] and thoroughly == [ended]
    gone_on.clear()
    beside.extended(search(fit(loss=2000.0)), fit(A, loss=1500.0), [], widely=True)
    assert not gone_on


@pytest.mark.parametrize(("losses", "rounds"), [((900.0, 400.0, 90.0), 3), ((900.0, 895.0, 90.0), 2), ((), 0)])
def test_a_fit_goes_on_as_long_as_it_gets_on(
    monkeypatch: pytest.MonkeyPatch, losses: tuple[float, ...], rounds: int
) -> None:
    ends = [fit(A, loss=loss) for loss in (2000.0 if losses else 50.0, *losses)]
    following = iter(ends[1:])
    monkeypatch.setattr(refit, "further", lambda one, most: next(following))
    assert refit.reaching(ends[0], 100.0) is ends[rounds]


@pytest.mark.parametrize(("losses", "left"), [((90.0, 50.0, 49.8, 10.0), 1), ((90.0, 89.9), 0)])
def test_a_fit_is_taken_further_until_its_loss_stays(
    monkeypatch: pytest.MonkeyPatch, losses: tuple[float, ...], left: int
) -> None:
    made = SimpleNamespace(misfit=None, u=None, states=None, measured=SimpleNamespace(stretches=None))
    ends = iter([SimpleNamespace(**vars(made), loss=loss) for loss in losses])
    for name in ("fit_thoroughly", "fit"):
        monkeypatch.setattr(refit, name, lambda *_: next(ends))
    ended = refit.again(Explanation((), made))  # type: ignore[arg-type]
    assert len(list(ends)) == left and ended.loss == losses[len(losses) - left - 1]


def test_what_explains_little_beside_the_best_is_not_fitted_against_white_noise(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What explains nothing may have lost its way, and is."""
    asked: list[float] = []
    monkeypatch.setattr(weighing, "by_white_noise", lambda one, _: asked.append(one.loss) or one)
    found = search(fit(loss=1000.0))
    for loss in (990.0, 500.0, 950.0, 850.0, 1100.0):
        weighing.add_single(found, [fit(A, loss=loss)], np.inf)
    assert asked == [990.0, 500.0, 850.0, 1100.0]
    assert [one.loss for one in found.singles] == [990.0, 500.0, 950.0, 850.0, 1100.0]


@pytest.mark.parametrize(("elsewhere", "tries"), [(1000.0, 2), (900.0, 4)])
def test_others_are_tried_from_where_the_rest_moves_to_only_if_it_moves(
    monkeypatch: pytest.MonkeyPatch, elsewhere: float, tries: int
) -> None:
    places: list[float] = []

    def without(best: Any, gone: Effect, iterations: int = 1) -> Any:
        return fit(*(c for c in best.candidates if c is not gone), loss=elsewhere if iterations else 1000.0)

    monkeypatch.setattr(exchange, "without", without)
    monkeypatch.setattr(exchange, "extended", lambda _, rest, *__: places.append(rest.loss) or [])
    found = search(fit(loss=2000.0))
    found.best = fit(A, B, loss=400.0)
    exchange._try_others(found, True)
    assert places == [1000.0, elsewhere][: tries // 2] * 2


@pytest.mark.parametrize(("loss", "asked"), [(400.0, ["maxwell"]), (1400.0, ["maxwell", "hardening"])])
def test_no_pair_is_sought_beside_another_once_one_explains_most(
    monkeypatch: pytest.MonkeyPatch, loss: float, asked: list[str]
) -> None:
    singles = [fit(A, loss=2000.0), fit(B, loss=2100.0)]
    beside_which: list[str] = []

    def extended(found: Search, single: Any, *_: Any) -> list[Any]:
        beside_which.append(single.names[0])
        return [fit(*single.candidates, TILT, loss=loss)]

    monkeypatch.setattr(select, "adequate", lambda _: False)
    monkeypatch.setattr(select, "explains_most", lambda pair, of, _: pair.loss < 0.25 * of.loss)
    monkeypatch.setattr(select, "outside", lambda *_: None)
    monkeypatch.setattr(select, "pool", lambda *_: [[one] for one in singles])
    monkeypatch.setattr(select, "extended", extended)
    for name in ("exchanged", "weigh_again"):
        monkeypatch.setattr(select, name, lambda *_: None)
    found = search(fit(loss=10000.0), *singles)
    found.best = singles[0]
    select._pairs(found, lambda *_: None)
    assert beside_which == asked


@pytest.mark.parametrize(("beside", "goes_on"), [("base_filter", True), ("tilt", False)])
def test_a_law_outside_the_library_is_asked_again_beside_an_instrument(
    monkeypatch: pytest.MonkeyPatch, beside: str, goes_on: bool
) -> None:
    likelier, other = fit(A, Effect(beside, of_joints=False), loss=900.0), fit(A, B, loss=1500.0)
    monkeypatch.setattr(select, "adequate", lambda _: False)
    monkeypatch.setattr(select, "explains_most", lambda *_: False)
    monkeypatch.setattr(select, "outside", lambda *_: "a law outside the library")
    monkeypatch.setattr(select, "pool", lambda found, best: [[best]])
    monkeypatch.setattr(select, "extended", lambda *_: [other, likelier])
    for name in ("exchanged", "weigh_again"):
        monkeypatch.setattr(select, name, lambda *_: None)
    found = search(fit(loss=10000.0), fit(A, loss=2000.0))
    found.best = found.singles[0]
    select._pairs(found, lambda *_: None)
    assert (found.outside is None) == goes_on
    assert found.best.names == (("maxwell", beside) if goes_on else ("maxwell",))


def test_a_pair_in_the_place_of_a_shape_is_taken_like_any_other(monkeypatch: pytest.MonkeyPatch) -> None:
    """Though no mechanism scores beside the law with its shape."""
    single, pair = fit(A, loss=500.0), fit(A, B, loss=300.0)
    monkeypatch.setattr(select, "extended", lambda *_: [])
    monkeypatch.setattr(select, "in_the_place_of_shapes", lambda _, one: [pair] if one is single else [])
    monkeypatch.setattr(select, "survives", lambda *_: True)
    monkeypatch.setattr(select, "explains_most", lambda *_: True)
    for name in ("exchanged", "weigh_again"):
        monkeypatch.setattr(select, name, lambda *_: None)
    found = search(fit(loss=2000.0), single)
    found.best = single
    select._pairs(found, lambda *_: None)
    assert found.best is pair


def test_the_last_exchange_goes_on_beyond_the_work_of_all_searches(monkeypatch: pytest.MonkeyPatch) -> None:
    spent: list[bool] = []
    monkeypatch.setattr(select, "_pairs", lambda *_: None)
    monkeypatch.setattr(select, "_more", lambda *_: None)
    monkeypatch.setattr(select, "exchanged", lambda found, _: spent.append(found.spent))
    checked: list[str] = []
    for name in ("settle_ties", "drop", "drop_without_evidence", "with_other_numbers"):
        monkeypatch.setattr(select, name, lambda _, name=name: checked.append(name))
    monkeypatch.setattr(select, "with_memory", lambda one: one)
    monkeypatch.setattr(select, "estimate", lambda *_: NOTHING)
    found = search(fit(loss=10000.0))
    found.best, found.whole = fit(A, TILT, loss=900.0), Budget(-1.0)
    found.best.measured.identification = SimpleNamespace(further_work=1.0)
    found.base.measured.identification = SimpleNamespace(further_work=1.0)
    list(select.further_effects(found, lambda *_: None))
    assert spent == [False]
    assert checked == ["settle_ties", "drop", "drop_without_evidence", "with_other_numbers"]


@pytest.mark.parametrize(
    ("much", "white", "windows", "work"),
    [
        (True, True, True, FURTHER),
        (False, True, True, None),
        (False, False, True, FURTHER),
        (False, False, False, None),
    ],
)
def test_where_the_first_leaves_much_or_errors_may_hold_some_others_have_work_of_their_own(
    monkeypatch: pytest.MonkeyPatch, much: bool, white: bool, windows: bool, work: float | None
) -> None:
    """The pairs tried before it, from the specimen as declared, may have taken all that was kept for them.

    Runs that are compared whole leave more than white noise anyway.
    """
    left: list[float | None] = []
    monkeypatch.setattr(select, "leaves_much", lambda *_: much)
    monkeypatch.setattr(select, "passes_for_white", lambda *_: white)
    monkeypatch.setattr(select, "_pairs", lambda found, _: left.append(None if found.spent else found.budget.left))
    monkeypatch.setattr(select, "_more", lambda *_: None)
    further_effects_of(Budget(-1.0), windows, monkeypatch)
    assert left == [work if work is None else pytest.approx(work, abs=1.0)]


@pytest.mark.parametrize(
    ("incomplete", "windows", "spent", "work"),
    [
        (True, True, FURTHER + 1.0, THIRD),
        (True, True, 50.0, FURTHER - 50.0),
        (False, True, FURTHER + 1.0, None),
        (True, False, FURTHER + 1.0, None),
    ],
)
def test_where_two_leave_something_a_third_has_work_of_its_own_if_too_little_is_left(
    monkeypatch: pytest.MonkeyPatch, incomplete: bool, windows: bool, spent: float, work: float | None
) -> None:
    left: list[float | None] = []
    monkeypatch.setattr(select, "leaves_much", lambda *_: True)
    monkeypatch.setattr(select, "passes_for_white", lambda *_: True)
    monkeypatch.setattr(counting, "errs", lambda _: incomplete)
    monkeypatch.setattr(select, "_pairs", lambda *_: DONE.call(0, spent))
    monkeypatch.setattr(select, "_more", lambda found, _: left.append(None if found.spent else found.budget.left))
    further_effects_of(Budget(), windows, monkeypatch)
    assert left == [work if work is None else pytest.approx(work, abs=1.0)]


def further_effects_of(whole: Budget, windows: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """The stages for further effects beside one that stands, nothing fitted."""
    for name in ("settle_ties", "drop", "drop_without_evidence", "with_other_numbers"):
        monkeypatch.setattr(select, name, lambda _: None)
    monkeypatch.setattr(select, "with_memory", lambda one: one)
    monkeypatch.setattr(select, "again", lambda one: one)
    monkeypatch.setattr(select, "estimate", lambda *_: NOTHING)
    found = search(fit(loss=10000.0))
    found.best, found.whole = fit(A, loss=900.0), whole
    found.base.measured.identification = SimpleNamespace(further_work=1.0)
    found.base.measured.stretches = None if windows else "whole runs"
    list(select.further_effects(found, lambda *_: None))


@pytest.mark.parametrize(
    ("incomplete", "windows", "tried"), [(True, True, True), (False, True, False), (True, False, False)]
)
def test_whole_numbers_of_two_effects_that_leave_something_come_before_others(
    monkeypatch: pytest.MonkeyPatch, incomplete: bool, windows: bool, tried: bool
) -> None:
    """A rubber that yields with the wrong exponent leaves what a third effect would then be sought for."""
    done: list[str] = []
    numbered = fit(A, replace(B, held=("exponent",)), loss=500.0)

    def other_numbers(found: Search) -> None:
        done.append(f"spent {found.spent}")
        found.best = numbered

    monkeypatch.setattr(counting, "adequate", lambda _: not incomplete)
    monkeypatch.setattr(select, "with_other_numbers", other_numbers)
    monkeypatch.setattr(select, "weigh_again", lambda _: done.append("weighed"))
    monkeypatch.setattr(select, "exchanged", lambda found, _: done.append("exchanged"))
    found = search(fit(loss=10000.0))
    found.best, found.whole = fit(A, B, loss=900.0), Budget(-1.0)
    found.best.measured.stretches = None if windows else "whole runs"
    select._pairs(found, lambda *_: None)
    assert done == (["spent False", "weighed", "exchanged"] if tried else ["exchanged"])
    assert (found.best is numbered) == tried


@pytest.mark.parametrize(("whole", "most"), [(250.0, 100.0), (100.0, 20.0)])
def test_weighing_singles_leaves_further_effects_their_work(
    monkeypatch: pytest.MonkeyPatch, whole: float, most: float
) -> None:
    asked: list[float] = []
    monkeypatch.setattr(select, "weigh_again", lambda _, given: asked.append(given))
    monkeypatch.setattr(select, "refit_singles", lambda *_: [])
    monkeypatch.setattr(select, "take_further", lambda *_: None)
    monkeypatch.setattr(select, "explains_most", lambda *_: True)
    found = search(fit(loss=1000.0), fit(A, loss=100.0))
    found.whole = Budget(whole)
    list(select.first_effect(found, lambda *_: None))
    assert asked == [pytest.approx(most, abs=1.0)]
