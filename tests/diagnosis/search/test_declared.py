"""Where no mechanism explains much alone, two are sought from the specimen as declared."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.fit.solver import fit as fitted_from
from diagnosis.fit.starts import nominal
from diagnosis.progress import silent
from diagnosis.search import declared, select
from diagnosis.search.budget import DECLARED, Budget
from diagnosis.search.candidates import candidates
from diagnosis.search.declared import (
    FAR,
    astray,
    beside_recentred,
    explains_most,
    leaves_much,
    pairs_as_declared,
)
from diagnosis.search.found import ENDED, Search
from diagnosis.search.refit import Explanation, extend, further, recentred
from tests.diagnosis.made import SPECIMEN, TRUE, recording
from tests.diagnosis.search.made_up import TILT, A, B, Effect, fit, search

EFFECTS = {"delay": {"delay": 0.004}, "gain": {"gain": 0.06}}


@pytest.fixture(scope="module")
def begun() -> Search:
    measured = measure(SPECIMEN, [recording(name, k, EFFECTS) for name, k in (("a", 4), ("b", 5))])
    fitted, errors = calibrated(SPECIMEN, measured)
    some = tuple(one for one in candidates(measured, SPECIMEN) if one.name in (*EFFECTS, "tilt", "viscous_damping"))
    return Search(Explanation((), fitted), some, errors)


def far_away(begun: Search) -> Search:
    """The base at the ends of what its numbers may be."""
    f = begun.base.fitted
    u = np.array([x.bounds[1] for x in f.misfit.unknowns])
    return Search(Explanation((), fitted_from(f.misfit, u, f.states, 0)), begun.candidates, begun.errors)


def over_white(monkeypatch: pytest.MonkeyPatch) -> None:
    """Losses stand for what is left over white noise."""
    monkeypatch.setattr(declared, "left_over_white_noise", lambda one, _: one.loss)


@pytest.mark.parametrize(
    ("left", "of", "most"),
    [(10.9, 41.0, True), (11.1, 41.0, False), (1.2, 1.3, True), (1.3, 1.3, False)],
)
def test_what_explains_most_leaves_little_over_white_noise(
    monkeypatch: pytest.MonkeyPatch, left: float, of: float, most: bool
) -> None:
    over_white(monkeypatch)
    assert explains_most(fit(A, loss=left), fit(loss=of), search(fit(loss=of)).errors) is most


@pytest.mark.parametrize(
    ("left", "of", "much"),
    [(FAR - 1.0, 1000.0, False), (FAR + 1.0, 1000.0, True), (19.0, 35.0, True), (FAR + 1.0, FAR + 2.0, False)],
)
def test_a_mechanism_alone_may_leave_much(monkeypatch: pytest.MonkeyPatch, left: float, of: float, much: bool) -> None:
    """Whatever share it explains; but it has to explain something."""
    over_white(monkeypatch)
    single = fit(A, loss=left)
    single.measured.stretches = None
    assert leaves_much(single, search(fit(loss=of))) is much
    single.measured.stretches = object()  # of a building
    assert not leaves_much(single, search(fit(loss=of)))


def test_a_pair_is_found_from_the_declared_numbers_wherever_the_fit_of_the_base_went(begun: Search) -> None:
    """The base at the ends of what its numbers may be, as a fit that lacks much may leave it."""
    found = far_away(begun)
    asked: list[str] = []
    pairs = pairs_as_declared(found, begun.base, lambda text, _: asked.append(text))
    best = pairs[-1]
    assert declared.passes_for_white(best, found.errors) and len(asked) < declared.LEADING  # it ends there
    assert [pair.loss for pair in pairs] == sorted((pair.loss for pair in pairs), reverse=True)
    assert set(best.names) == set(EFFECTS)
    assert best.fitted.values["delay.delay"] == pytest.approx(0.004, rel=0.05)
    assert best.fitted.values["width"] == pytest.approx(TRUE["width"], rel=0.01)


def test_the_screen_is_made_about_the_declared_numbers_and_each_pair_has_to_beat_the_last(
    monkeypatch: pytest.MonkeyPatch, begun: Search
) -> None:
    screened: list[Any] = []
    bounds: list[float] = []
    losses = iter((900.0, 800.0, 700.0))

    def beside(_: Search, first: Any, most: float) -> Any:
        bounds.append(most)
        return fit(A, B, loss=next(losses))

    of = declared.linearise_about
    monkeypatch.setattr(declared, "linearise_about", lambda fitted: screened.append(fitted) or of(fitted))
    monkeypatch.setattr(declared, "_beside", beside)
    monkeypatch.setattr(declared, "passes_for_white", lambda *_: False)
    unknowns, single = begun.base.fitted.misfit.unknowns, fit(A, loss=1000.0)
    pairs = pairs_as_declared(far_away(begun), single, silent)
    assert [x.value(u) for x, u in zip(unknowns, screened[0].u, strict=True)] == pytest.approx(
        [SPECIMEN.parameters[x.name] for x in unknowns]
    )
    assert bounds == [1000.0, 900.0, 800.0] and [pair.loss for pair in pairs] == [900.0, 800.0, 700.0]


@pytest.mark.parametrize(("name", "first"), [("base_filter", True), ("maxwell", False)])
def test_what_an_instrument_does_is_led_first_as_it_was_fitted(
    monkeypatch: pytest.MonkeyPatch, begun: Search, name: str, first: bool
) -> None:
    led: list[Any] = []
    monkeypatch.setattr(declared, "_beside", lambda found, one, most: led.append(one))
    alone: Any = fit(Effect(name), loss=1000.0)
    pairs_as_declared(begun, alone, silent)
    assert (led[0] is alone) is first and alone not in led[1:]
    assert len(led) == declared.LEADING + first


def test_what_the_budget_left_is_said(begun: Search) -> None:
    found = Search(begun.base, begun.candidates, begun.errors, budget=Budget(-1.0))
    assert pairs_as_declared(found, begun.base, silent) == []
    assert ENDED in found.not_tried.values()


@pytest.mark.parametrize(
    ("alone", "pair", "taken"), [(200.0, 3.0, True), (200.0, 150.0, False), (20.0, 3.0, False), (995.0, 3.0, False)]
)
def test_a_pair_is_taken_where_a_mechanism_alone_leaves_much_and_the_pair_little(
    monkeypatch: pytest.MonkeyPatch, alone: float, pair: float, taken: bool
) -> None:
    over_white(monkeypatch)
    single, both = fit(A, loss=alone), fit(A, B, loss=pair)
    single.measured.stretches = both.measured.stretches = None
    found = search(fit(loss=1000.0), single, fit(TILT, loss=alone + 1.0))
    found.measured.stretches = None
    work: list[float] = []
    monkeypatch.setattr(select, "pairs_as_declared", lambda found, *_: work.append(found.budget.most) or [both])
    monkeypatch.setattr(select, "survives", lambda *_: True)
    monkeypatch.setattr(select, "least", lambda *_: 15.0)
    monkeypatch.setattr(select, "without_idle_shapes", lambda single, _: single)
    for name in ("again", "reshaped", "over_ranges"):
        monkeypatch.setattr(select, name, lambda one: one)
    monkeypatch.setattr(select, "weigh_again", lambda *_: None)
    further: list[Any] = []
    monkeypatch.setattr(select, "refit_singles", lambda *_: [])
    monkeypatch.setattr(select, "take_further", lambda found, _: further.append(found))
    monkeypatch.setattr(select, "take_best_single", lambda found: None)
    monkeypatch.setattr(select, "take_hidden", lambda *_: None)
    list(select.first_effect(found, silent))
    assert (found.best is not None) is taken and bool(further) is not taken
    assert not taken or (found.best is not None and found.best.names == both.names)
    assert set(work) <= {DECLARED} and (not taken or work)  # of their own, whatever the singles took


def test_a_pair_that_was_taken_first_is_exchanged_and_no_other_sought(monkeypatch: pytest.MonkeyPatch) -> None:
    found = search(fit(loss=1000.0))
    found.best = fit(A, B, loss=3.0)
    done: list[str] = []
    monkeypatch.setattr(select, "_settle_numbers", lambda _: done.append("numbers"))
    monkeypatch.setattr(select, "exchanged", lambda *_: done.append("exchanged"))
    monkeypatch.setattr(select, "seconds", lambda *_: done.append("seconds") or [])
    select._pairs(found, silent)
    assert done == ["numbers", "exchanged"]


def test_beside_each_of_two_effects_another_is_led_from_the_middle_of_the_ranges_once(
    monkeypatch: pytest.MonkeyPatch, begun: Search
) -> None:
    """The surest first; what acts takes the place of what does not."""
    gain, lean = (next(one for one in begun.candidates if one.name == name) for name in ("gain", "tilt"))
    pair = further(extend(extend(begun.base, gain, gain.null + 0.5, 0), lean, lean.null + 0.1, 0))
    led: list[Any] = []
    middles: list[Any] = []
    beside = declared._beside
    monkeypatch.setattr(declared, "_beside", lambda found, first, most: led.append(first) or beside(found, first, most))
    monkeypatch.setattr(declared, "recentred", lambda one: middles.append(recentred(one)) or middles[-1])
    found = Search(begun.base, begun.candidates, begun.errors)
    best, *others = beside_recentred(found, pair, pair.loss)
    assert [one.names for one in led] == [("gain",), ("tilt",)] and led == middles
    assert set(best.names) == set(EFFECTS) and all(best.loss < one.loss for one in (pair, *others))
    assert best.fitted.values["width"] == pytest.approx(TRUE["width"], rel=0.01)
    assert beside_recentred(found, pair, pair.loss) == []
    assert beside_recentred(Search(begun.base, begun.candidates, begun.errors), pair, 0.0) == []  # none comes near


def test_from_afar_only_what_is_behind_another_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """A quick fit may end behind what is to be reached, and goes on from there."""
    found, promised = search(fit(loss=1000.0)), []
    entries = [SimpleNamespace(candidate=one) for one in (A, B)]
    losses = iter((80.0, 120.0))

    def quick(begins: Any, candidate: Any, starts: Any, most: float) -> list[Any]:
        promised.append(most)
        return [fit(TILT, candidate, loss=next(losses))]

    monkeypatch.setattr(declared, "seconds", lambda *_: entries)
    monkeypatch.setattr(declared, "worth_a_refit", lambda scores, *_: scores)
    monkeypatch.setattr(declared, "one_of_each", lambda scores: scores)
    monkeypatch.setattr(declared, "starts_of", lambda *_: ())
    monkeypatch.setattr(declared, "from_starts", quick)
    monkeypatch.setattr(declared, "reaching", lambda one, most: fit(*one.candidates, loss=one.loss - 40.0))
    monkeypatch.setattr(declared, "again", lambda one: one)
    best = declared._beside(found, fit(TILT, loss=500.0), 50.0)
    assert best is not None and best.names == ("tilt", "maxwell") and best.loss == 40.0
    assert promised == [np.inf, 80.0]


def test_only_numbers_that_have_but_a_range_are_recentred(begun: Search) -> None:
    gain = next(one for one in begun.candidates if one.name == "gain")
    single = extend(begun.base, gain, gain.null + 0.5, 0)
    first, second, *others = single.fitted.misfit.unknowns
    unknowns = (replace(first, prior=None), replace(second, prior=(0.5, 0.1)), *others)
    misfit = replace(single.fitted.misfit, unknowns=unknowns)
    u, states = single.fitted.u + 0.01, single.fitted.states + 1e-4
    moved = recentred(replace(single, fitted=replace(single.fitted, misfit=misfit, u=u, states=states)))
    np.testing.assert_array_equal(moved.fitted.u[1:], u[1:])
    assert moved.fitted.u[0] == nominal(misfit).u[0] != u[0]
    np.testing.assert_array_equal(moved.fitted.states, states)


@pytest.mark.parametrize(
    ("at", "prior", "away"), [(9.95, None, True), (0.05, None, True), (0.2, None, False), (9.95, (5.0, 0.1), False)]
)
def test_a_base_is_astray_with_a_number_at_an_end_of_its_range(at: float, prior: Any, away: bool) -> None:
    """But not with one at the end of its tolerance, nor where fits creep."""
    unknowns = [SimpleNamespace(prior=prior, bounds=(0.0, 10.0)), SimpleNamespace(prior=None, bounds=(0.0, 10.0))]
    measured = SimpleNamespace(stretches=None)
    base: Any = SimpleNamespace(
        fitted=SimpleNamespace(measured=measured, misfit=SimpleNamespace(unknowns=unknowns), u=np.array([at, 5.0]))
    )
    assert astray(search(base)) is away
    measured.stretches = object()
    assert not astray(search(base))
