"""A further effect: where no model explains everything, one that predicts recordings left out worse is passed over."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from diagnosis.progress import silent
from diagnosis.search import select
from models.errors import InputError
from tests.diagnosis.search import made_up
from tests.diagnosis.search.made_up import TILT, A, B, C, Effect


def fit(loss: float) -> Any:
    no_law = SimpleNamespace(mechanism=SimpleNamespace(at_joints=()), unknowns=(0,), held={}, price=0.0)
    return SimpleNamespace(loss=loss, candidates=(no_law,), measured=SimpleNamespace(model=SimpleNamespace(name="m")))


def search(incomplete: bool) -> Any:
    return SimpleNamespace(incomplete=incomplete, more=20.0, pass_over=lambda one: None)


@pytest.fixture(autouse=True)
def all_survive(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(select, "survives", lambda before, after, more: True)


def test_the_likeliest_that_does_not_predict_worse_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    before, likely, next_one = fit(200.0), fit(100.0), fit(150.0)
    monkeypatch.setattr(select, "predicts_worse", lambda one, other: other is likely)
    assert select._next(search(True), before, [next_one, likely]) is next_one
    assert select._next(search(True), before, [likely]) is None


def test_where_the_model_explains_all_but_noise_the_likelihood_decides(monkeypatch: pytest.MonkeyPatch) -> None:
    before, likely = fit(200.0), fit(100.0)
    monkeypatch.setattr(select, "predicts_worse", lambda one, other: True)
    assert select._next(search(False), before, [likely]) is likely


def test_what_gains_too_little_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(select, "predicts_worse", lambda one, other: False)
    assert select._next(search(True), fit(200.0), [fit(190.0)]) is None
    monkeypatch.setattr(select, "survives", lambda before, after, more: False)
    assert select._next(search(True), fit(200.0), [fit(100.0)]) is None


@pytest.mark.parametrize(("explained", "stretches", "sought"), [(0.2, None, False), (0.3, None, True), (0.2, (), True)])
def test_no_third_effect_is_sought_beside_two_that_explain_little(
    monkeypatch: pytest.MonkeyPatch, explained: float, stretches: Any, sought: bool
) -> None:
    """But where whole runs are compared, which no single law explains."""
    asked: list[Any] = []
    monkeypatch.setattr(select, "seconds", lambda found, best: asked.append(best) or [])
    monkeypatch.setattr(select, "adequate", lambda best: True)
    monkeypatch.setattr(select, "extended", lambda *_: [])
    measured = SimpleNamespace(stretches=stretches, identification=SimpleNamespace(most_effects=3))
    found: Any = SimpleNamespace(
        best=SimpleNamespace(candidates=(0, 1)), explained=explained, measured=measured, incomplete=True, tried=[],
        affordable=lambda *_: True, not_tried={},
    )  # fmt: skip
    select._more(found, silent)
    assert bool(asked) == sought
    assert found.not_tried == ({} if sought else {"a third effect": select.FUTILE})


def test_a_third_effect_is_tried_beside_the_pairs_that_are_less_behind_than_it_gains(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The nearest two, of other laws, which were not passed over; a refusal to act together ends nothing."""
    delay, other_joint = Effect("delay", of_joints=False), Effect(A.name, order=1)
    asked: list[Any] = []

    def extend(one: Any, candidate: Any, start: Any, iterations: int, most: float) -> Any:
        assert candidate is delay and start == "as fitted" and most == one.loss
        asked.append(one.candidates)
        if C in one.candidates:
            raise InputError("no two together")
        return made_up.fit(*one.candidates, delay, loss=100.0)

    monkeypatch.setattr(select, "extend", extend)
    monkeypatch.setattr(select, "again", lambda one: one)
    before, after = made_up.fit(TILT, A, loss=500.0), made_up.fit(TILT, A, delay, loss=200.0)
    passed_over = made_up.fit(A, B, loss=510.0)
    far, last = made_up.fit(TILT, Effect("payne"), loss=801.0), made_up.fit(TILT, Effect("mullins"), loss=790.0)
    nearer = [made_up.fit(TILT, other_joint, loss=520.0), made_up.fit(delay, B, loss=530.0)]
    taken = [made_up.fit(TILT, B, loss=600.0), made_up.fit(TILT, C, loss=700.0)]
    found = made_up.search(made_up.fit(loss=9000.0), far, last, *taken, *nearer, passed_over, before)
    found.candidates = (TILT, A, B, C, delay)
    found.measured.stretches = None
    found.pass_over(passed_over)
    (one,) = select._beside_rivals(found, before, after)
    assert asked == [(TILT, B), (TILT, C)] and one.candidates == (TILT, B, delay)
    assert found.not_tried == {"delay": "no two together"}
    found.tried = [far, before]
    assert not select._beside_rivals(found, before, after)
