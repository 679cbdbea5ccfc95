"""What is easily taken for an effect is tried in its place, whatever a screen says."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import models
from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.search import alike, exchange
from diagnosis.search.alike import in_the_place_of_each
from diagnosis.search.budget import ENDED, Budget
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation, again, extend
from tests.diagnosis.search.made_up import A, B, C, Effect, fit, nothing_is_fitted, search
from tests.diagnosis.walls import WALL, recorded

HARD, SHEAR = 40.0, 0.3
TRUE = (("hardening.beta2", HARD), ("interface_shear.shear_over_normal", SHEAR))


@cache
def found() -> Search:
    """A wall whose layers harden and shear, and nothing searched yet."""
    measured = measure(WALL, [recorded(1, TRUE)])
    fitted, errors = calibrated(WALL, measured, 0)
    return Search(Explanation((), fitted), candidates(measured, WALL), errors, budget=Budget(np.inf))


def with_effects(*values: tuple[str, float]) -> Explanation:
    """The fit with effects that start at these values of their first parameters."""
    stands = found().base
    for name, value in values:
        law = next(c for c in found().candidates if c.unknowns[0].name == name)
        start = law.null
        start[0] = law.unknowns[0].coordinate(value)
        stands = extend(stands, law, start, 0)
    return again(stands)


def named(explanation: Explanation) -> list[str]:
    return [c.unknowns[0].name for c in explanation.candidates]


def test_one_stiffening_of_a_layer_is_tried_for_another_and_laws_at_other_joints() -> None:
    stands = with_effects(("locking.lock_strain", 0.6), ("interface_shear.shear_over_normal_top", SHEAR))
    own = replace(found(), alike=set())
    fits = [one for each in in_the_place_of_each(own, stands, np.inf) for one in each]
    tried = {name for one in fits for name in named(one) if name not in named(stands)}
    assert tried == {
        *(f"hardening.beta2{joint}" for joint in ("", "_base", "_top")),
        *(f"locking.lock_strain_{joint}" for joint in ("base", "top")),
        "interface_shear.shear_over_normal", "interface_shear.shear_over_normal_base",
    }  # fmt: skip
    best = min(fits, key=lambda one: one.loss)
    assert best.loss < stands.loss - 15.0


def test_steps_of_one_effect_at_a_time_lead_to_the_truth() -> None:
    """From a wrong law beside one at the wrong joint."""
    own = replace(found(), alike=set())
    own.best = with_effects(("locking.lock_strain", 0.6), ("interface_shear.shear_over_normal_top", SHEAR))
    true = with_effects(*TRUE)
    for _ in range(3):
        for fits in in_the_place_of_each(own, own.best, own.best.loss + 30.0):
            own.best = min([own.best, *fits], key=lambda one: one.loss)
    assert own.best.loss < true.loss + 1.0 and set(named(own.best)) == {name for name, _ in TRUE}


def test_what_shows_at_the_same_place_is_easily_taken_for_it() -> None:
    library = models.get("interface").mechanisms
    assert library["hardening"].shows == library["locking"].shows == library["hardening"].signature
    assert library["tilt"].shows == library["eccentricity"].shows != library["hardening"].shows


@pytest.mark.parametrize("nearer", [True, False])
def test_other_mechanisms_wait_where_that_fits_better(monkeypatch: pytest.MonkeyPatch, nearer: bool) -> None:
    nothing_is_fitted(monkeypatch)
    asked: list[str] = []
    monkeypatch.setattr(exchange, "extended", lambda *_: asked.append("screen") or [])
    monkeypatch.setattr(exchange, "without", lambda best, candidate, _=0: fit(*best.candidates[:1], loss=5000.0))
    other = fit(A, C, loss=100.0 if nearer else 900.0)
    monkeypatch.setattr(exchange, "in_the_place_of_each", lambda *_: asked.append("alike") or [[other]])
    own = search(fit(loss=9000.0))
    own.best = fit(A, B, loss=500.0)
    own.best.measured.stretches = None
    exchange._try_others(own, False)
    assert asked == (["alike"] if nearer else ["alike", "screen", "screen"]) and other in own.tried


def test_what_was_tried_is_not_tried_again_and_what_was_not_is_noted(monkeypatch: pytest.MonkeyPatch) -> None:
    """As the budget ends, and goes on later."""
    asked: list[str] = []
    left = {A: fit(B, loss=9.0), B: fit(A, loss=9.0)}
    monkeypatch.setattr(alike, "without", lambda best, one, _: left[one])
    monkeypatch.setattr(alike, "joinable", lambda *_: [C])
    monkeypatch.setattr(alike, "same_law", lambda *_: False)
    monkeypatch.setattr(Effect, "mechanism", SimpleNamespace(shows="everywhere"))
    monkeypatch.setattr(alike, "within_reach", lambda one, _: one.candidates[0] is A)
    thoroughly: list[Any] = []
    monkeypatch.setattr(alike, "again", lambda one: thoroughly.append(one) or one)

    def tried(left: Any, other: Effect, most: float) -> Any:
        asked.append(f"{left.names[0]}+{other.name}")
        own.budget = Budget(-1.0)
        return fit(*left.candidates, other, loss=5.0)

    monkeypatch.setattr(alike, "beside_at_best_size", tried)
    own = search(fit(loss=9000.0))
    best = fit(A, B, loss=500.0)
    list(in_the_place_of_each(own, best, np.inf))
    assert len(asked) == 1 and ENDED in own.not_tried.values()
    own.budget = Budget()
    list(in_the_place_of_each(own, best, np.inf))
    own.budget = Budget()
    list(in_the_place_of_each(own, best, np.inf))
    assert sorted(asked) == sorted([f"{A.name}+{C.name}", f"{B.name}+{C.name}"])
    assert [one.names for one in thoroughly] == [(A.name, C.name)]  # what comes near is taken further


def test_what_the_model_refuses_beside_the_other_effect_is_noted() -> None:
    """A contact that stays shows where a spring does; beside a layer that locks there is none."""
    own = replace(found(), alike=set(), not_tried={})
    stands = with_effects(("locking.lock_strain", 0.6), ("added_stiffness.couple_stiffness", 1e4))
    fits = [one for each in in_the_place_of_each(own, stands, stands.loss + 30.0) for one in each]
    assert all("contact_length" not in one.names for one in fits if "locking" in one.names)
    assert "contact_length" in own.not_tried["contact_length"]
