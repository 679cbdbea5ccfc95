"""Effects taken one by one are held against the others again."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from diagnosis.data.measured import Measured
from diagnosis.errors.model import disturbance_about, estimate
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import fit
from diagnosis.progress import silent
from diagnosis.search import beside, exchange, refit, select
from diagnosis.search.beside import extended
from diagnosis.search.budget import Budget
from diagnosis.search.candidates import candidates
from diagnosis.search.exchange import exchanged
from diagnosis.search.found import MISSING, Search, adjusted
from diagnosis.search.refit import Explanation, extend, joined
from diagnosis.search.screen import Score
from diagnosis.search.weighing import reweighed
from tests.diagnosis.made import SPECIMEN, recording
from tests.diagnosis.search import made_up
from tests.diagnosis.search.made_up import A, B, C

TRUE = {"restitution": {"factor_on_housner": 0.9}, "tilt": {"tilt": 0.01}}
OTHERS = ("velocity_restitution", "offset")
"""What each of them may be taken for."""


class Unfinished(Search):
    """A search that no explanation completes, such as those of recordings that no model reproduces."""

    @property
    def incomplete(self) -> bool:
        return True


@pytest.fixture(scope="module")
def found() -> Search:
    """With every mechanism refitted alone, under the errors of the true model."""
    measured = measure(SPECIMEN, [recording("run_1", 1, TRUE)])
    some = {one.name: one for one in candidates(measured, SPECIMEN) if one.name in (*TRUE, *OTHERS)}
    base = Explanation((), base_fit(SPECIMEN, measured))
    true = base
    for name in TRUE:
        true = extend(true, some[name], some[name].null)
    errors = estimate(true.fitted, disturbance_about(true.fitted))
    found = Unfinished(reweighed(base, errors), tuple(some.values()), errors)
    found.singles = sorted((extend(found.base, one, one.null) for one in some.values()), key=adjusted)
    return found


def taken(found: Search, *names: str) -> Explanation:
    return joined(*(next(e for e in found.singles if e.names == (name,)) for name in names))


def exchanged_from(found: Search, best: Explanation) -> Explanation:
    search = replace(found, best=best, tried=[best], exchanged=set(), budget=Budget())
    exchanged(search, silent)
    assert search.best is not None
    return search.best


def test_an_effect_gives_way_to_one_that_explains_more_beside_the_other(
    found: Search, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And others are tried again beside what stays once its company has changed."""
    asked: list[tuple[str, ...]] = []

    def noted(found: Search, rest: Explanation, scores: list[Score], *how: Any) -> list[Explanation]:
        asked.append(rest.names)
        return extended(found, rest, scores, *how)

    monkeypatch.setattr(exchange, "extended", noted)
    best = exchanged_from(found, taken(found, "tilt", "velocity_restitution"))
    assert set(best.names) == set(TRUE)
    assert best.fitted.values["restitution.factor_on_housner"] == pytest.approx(0.9, abs=0.01)
    assert best.fitted.values["tilt.tilt"] == pytest.approx(0.01, abs=0.001)
    assert asked.count(("velocity_restitution",)) == asked.count(("restitution",)) > 0
    assert asked.count(("tilt",)) == 2 * asked.count(("restitution",))


def test_effects_are_exchanged_one_after_the_other_where_what_stands_explains_enough(
    found: Search, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each exchange alone leaves the other effect wrong."""
    monkeypatch.setattr(Unfinished, "incomplete", False)
    best = exchanged_from(found, taken(found, "offset", "velocity_restitution"))
    assert set(best.names) == set(TRUE)


def test_no_effect_gives_way_to_one_that_predicts_recordings_left_out_worse(
    found: Search, monkeypatch: pytest.MonkeyPatch
) -> None:
    """However much more it explains, as long as no model explains everything."""
    monkeypatch.setattr(exchange, "predicts_worse", lambda before, after: True)
    best = exchanged_from(found, taken(found, "tilt", "velocity_restitution"))
    assert set(best.names) == {"tilt", "velocity_restitution"}


@pytest.mark.parametrize(("gain", "expected"), [(0.5 * MISSING, "tw"), (2.0 * MISSING, "wtt")])
def test_errors_are_estimated_anew_at_once_where_an_exchange_gains_clearly(
    found: Search, monkeypatch: pytest.MonkeyPatch, gain: float, expected: str
) -> None:
    """Else once at the end (t: others tried, w: errors weighed); it takes its place all the same, before others."""
    asked: list[str] = []
    monkeypatch.setattr(exchange, "weigh_again", lambda _: asked.append("w"))
    monkeypatch.setattr(exchange, "extended", lambda *_: asked.append("t") or [])
    true, other = taken(found, *TRUE), taken(found, "tilt", "velocity_restitution")
    standing = replace(other, fitted=replace(other.fitted, loss=true.loss + gain))
    search = replace(
        found, best=standing, tried=[true], exchanged={frozenset(standing.candidates[:1])}, budget=Budget()
    )
    monkeypatch.setattr(Unfinished, "incomplete", False)
    monkeypatch.setattr(exchange, "drop", lambda _: None)
    exchanged(search, silent)
    assert search.best is not None and set(search.best.names) == set(TRUE)
    assert "".join(asked) == expected


def test_what_was_stuck_in_a_window_is_not_exchanged_for_what_gains_little(
    found: Search, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Led by the states of what took its place it is likelier again, and the errors are its own already."""
    for name, stands_in in (("extended", []), ("drop", None), ("weigh_again", None)):
        monkeypatch.setattr(exchange, name, lambda *_, stands_in=stands_in: stands_in)
    for name in ("again", "reshaped", "over_ranges"):
        monkeypatch.setattr(exchange, name, lambda one: one)
    true, other = taken(found, *TRUE), taken(found, "tilt", "velocity_restitution")
    states = true.fitted.states.copy()
    states[:, 1] += 8.0 * true.measured.state_size[1]
    standing = replace(true, fitted=fit(true.fitted.misfit, true.fitted.u, states))
    assert standing.loss > true.loss + 2.0 * MISSING
    little = replace(other, fitted=replace(other.fitted, loss=standing.loss - 0.5 * MISSING))
    monkeypatch.setattr(Unfinished, "incomplete", False)
    search = replace(found, best=standing, tried=[little], exchanged=set(), budget=Budget())
    exchanged(search, silent)
    assert search.best is not None and set(search.best.names) == set(TRUE)
    assert search.best.loss == pytest.approx(true.loss, abs=1.0)


def test_an_exchange_that_is_right_is_not_given_up(found: Search, monkeypatch: pytest.MonkeyPatch) -> None:
    """However far off it starts, the wrong effect just taken out: it ends where it does without a bound."""
    within: list[float] = []
    bounds: list[float] = []
    asked: list[float] = []

    def bounded_by(*how: Any) -> Explanation:
        bounds.append(how[4] if len(how) > 4 else np.inf)
        return extend(*how)

    def noted(*how: Any) -> list[Explanation]:
        within.append(how[-1])
        begun = len(bounds)
        bounded = extended(*how)
        asked.extend(bounds[begun:])
        free = extended(*how[:-1])
        right = [[e for e in each if set(e.names) == set(TRUE)] for each in (bounded, free)]
        assert len(right[0]) == len(right[1])
        for one, other in zip(*right, strict=True):
            assert min(one.loss, within[-1]) == pytest.approx(min(other.loss, within[-1]), abs=1.0)
        return bounded

    monkeypatch.setattr(exchange, "extended", noted)
    monkeypatch.setattr(refit, "extend", bounded_by)
    monkeypatch.setattr(beside, "again", lambda one: one)  # the few best would be taken further all the same
    exchanged_from(found, taken(found, "tilt", "velocity_restitution"))
    finite = {bound for bound in asked if np.isfinite(bound)}  # lower ones where another explains everything
    assert within and set(within) <= finite and max(finite) == max(within)


def test_refits_far_from_what_stands_are_given_up(found: Search, monkeypatch: pytest.MonkeyPatch) -> None:
    """None where whole runs are compared: such fits creep."""
    within: list[float] = []
    monkeypatch.setattr(exchange, "extended", lambda *how: within.append(how[-1]) or [])
    true = taken(found, *TRUE)
    exchanged_from(found, true)
    assert within and all(true.loss + 10.0 < most < true.loss + 100.0 for most in within)
    within.clear()
    for name, stands_in in (("seconds", []), ("without", taken(found, "tilt", "offset")), ("drop", None)):
        monkeypatch.setattr(exchange, name, lambda *_, stands_in=stands_in: stands_in)
    monkeypatch.setattr(Measured, "stretches", property(lambda _: ()), raising=False)
    exchanged_from(found, true)
    assert within and all(np.isinf(most) for most in within)


def test_what_stands_explains_a_share_of_what_is_missing(found: Search) -> None:
    """All of it, a part, nothing; and where the base model leaves noise alone, whatever more is fitted to it."""
    true, base = taken(found, *TRUE), found.base
    (spare,) = (one for one in found.candidates if one.name == "offset")
    assert replace(found, best=true).explained == pytest.approx(1.0, abs=0.1)
    half = replace(base, fitted=replace(base.fitted, loss=0.5 * (base.loss + true.loss)))
    assert replace(found, best=half).explained == pytest.approx(0.5, abs=0.05)
    assert replace(found, best=None).explained < 0.01
    assert replace(found, base=true, best=extend(true, spare, spare.null)).explained > select.LITTLE


def test_no_effect_is_named_that_the_last_errors_do_not_ask_for(found: Search, monkeypatch: pytest.MonkeyPatch) -> None:
    """However it came in: searches for more are left out here."""
    for more in ("_pairs", "_more", "settle_ties"):
        monkeypatch.setattr(select, more, lambda *_: None)
    spare = next(one for one in found.candidates if one.name == OTHERS[1])
    best = extend(taken(found, *TRUE), spare, spare.null)
    search = replace(found, best=best, weighed=best)
    for _ in select.further_effects(search, silent):
        pass
    assert search.best is not None and set(search.best.names) == set(TRUE)


def test_an_effect_that_is_no_longer_needed_is_dropped(found: Search) -> None:
    (spare,) = (one for one in found.candidates if one.name == "offset")
    best = exchanged_from(found, extend(taken(found, *TRUE), spare, spare.null))
    assert set(best.names) == set(TRUE)


def test_the_least_sure_effect_is_questioned_first(found: Search, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Explanation] = []
    monkeypatch.setattr(exchange, "extended", lambda found, rest, *how: asked.append(rest) or [])
    exchanged_from(found, taken(found, *TRUE))
    standing = asked[::2]  # from where the others stand; fitted anew in between, for nothing completes this search
    assert {rest.names for rest in standing} == {(name,) for name in TRUE}
    assert standing[0].loss < standing[1].loss


def test_what_the_budget_left_untried_is_tried_at_the_end(found: Search, monkeypatch: pytest.MonkeyPatch) -> None:
    for more in ("_pairs", "_more", "settle_ties"):
        monkeypatch.setattr(select, more, lambda *_: None)
    best = taken(found, "tilt", "velocity_restitution")
    search = replace(found, best=best, tried=[best], weighed=best, exchanged=set(), budget=Budget(most=0.0))
    for _ in select.further_effects(search, silent):
        pass
    assert search.best is not None and set(search.best.names) == set(TRUE)


@pytest.mark.parametrize(("astray", "better", "taken"), [(True, 40.0, True), (True, 55.0, False), (False, 40.0, False)])
def test_where_the_base_went_astray_others_are_led_from_the_middle_of_the_ranges(
    monkeypatch: pytest.MonkeyPatch, astray: bool, better: float, taken: bool
) -> None:
    """Beside each of two effects, once nothing in their place is better from where they stand."""
    made_up.nothing_is_fitted(monkeypatch)
    found = made_up.search(made_up.fit(loss=1000.0), made_up.fit(A, loss=500.0), made_up.fit(B, loss=500.0))
    found.best, other = made_up.fit(A, B, loss=50.0), made_up.fit(A, C, loss=better)
    asked: list[tuple[str, ...]] = []
    monkeypatch.setattr(exchange, "without", lambda best, one, *_: made_up.fit(*{*best.candidates} - {one}, loss=500.0))
    monkeypatch.setattr(exchange, "from_states_of", lambda one, *_: one)
    monkeypatch.setattr(exchange, "astray", lambda _: astray)
    monkeypatch.setattr(
        exchange,
        "beside_recentred",
        lambda _, best, most: asked.append(best.names) or ([other] if A in best.candidates else []),
    )
    exchanged(found, silent)
    assert found.best is not None and (found.best.names == other.names) is taken
    assert bool(asked) is astray
