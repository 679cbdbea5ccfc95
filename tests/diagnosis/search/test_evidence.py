"""An effect that errors estimated without it explain as well is not told."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from diagnosis.search import evidence as module
from diagnosis.search.evidence import drop_without_evidence, evidence
from diagnosis.search.found import MISSING, Search
from tests.diagnosis.search.made_up import TILT, A, B, fit, search

BEST = 900.0


def answered(
    monkeypatch: pytest.MonkeyPatch, under: dict[str, float], each: dict[str, float]
) -> tuple[Search, list[str]]:
    """An answer of two effects; what each gains under the errors of the model without it, and with errors of each."""
    refits: list[str] = []
    best = fit(A, TILT, loss=BEST)
    errors: Any = SimpleNamespace(loss=BEST, base=None)

    def without(one: Any, gone: Any) -> Any:
        refits.append(gone.name)
        rest = fit(*(c for c in one.candidates if c is not gone), loss=BEST + 500.0)
        rest.fitted.left_out = gone.name
        return rest

    def refitted(fitted: Any, *_: Any) -> Any:
        left_out = fitted.left_out
        return SimpleNamespace(loss=BEST + under[left_out]), SimpleNamespace(loss=BEST + each[left_out], base=None)

    monkeypatch.setattr(module, "without", without)
    monkeypatch.setattr(module, "refitted", refitted)
    monkeypatch.setattr(module, "reweighed", lambda one, _: one)
    found = search(fit(loss=5000.0))
    found.best, found.errors = best, errors
    return found, refits


def test_evidence_is_the_gain_under_the_errors_without_the_effect(monkeypatch: pytest.MonkeyPatch) -> None:
    found, refits = answered(monkeypatch, {"maxwell": 400.0, "tilt": 60.0}, {"maxwell": 300.0, "tilt": 20.0})
    drop_without_evidence(found)
    assert found.chosen.names == ("maxwell", "tilt")
    assert evidence(found) == [400.0, 60.0]
    assert refits == ["maxwell", "tilt"]  # left out once for both


def test_what_the_errors_hold_without_it_counts_by_the_errors_of_each(monkeypatch: pytest.MonkeyPatch) -> None:
    found, _ = answered(monkeypatch, {"maxwell": 400.0, "tilt": 2.0}, {"maxwell": 300.0, "tilt": MISSING})
    drop_without_evidence(found)
    assert found.chosen.names == ("maxwell", "tilt") and evidence(found) == [400.0, MISSING]


def test_an_effect_that_the_errors_explain_as_well_is_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    found, _ = answered(monkeypatch, {"maxwell": 400.0, "tilt": 2.0}, {"maxwell": 300.0, "tilt": MISSING - 0.1})
    weighed: list[Any] = []
    monkeypatch.setattr(module, "weigh_again", lambda found: weighed.append(found.best))
    drop_without_evidence(found)
    assert found.chosen.names == ("maxwell",)
    assert found.tried[-1] is found.best and weighed == [found.best]  # the errors hold now what the tilt was taken for


def test_of_an_effect_with_elements_beside_it_none_is_dropped_before_them(monkeypatch: pytest.MonkeyPatch) -> None:
    found, _ = answered(monkeypatch, {"maxwell": 0.0, "tilt": 50.0}, {"maxwell": 0.0, "tilt": 50.0})
    monkeypatch.setattr(type(found.chosen), "removable", property(lambda one: one.candidates[1:]))
    drop_without_evidence(found)
    assert found.chosen.names == ("maxwell", "tilt")


def test_the_price_of_details_is_that_of_each_model(monkeypatch: pytest.MonkeyPatch) -> None:
    found, _ = answered(monkeypatch, {"maxwell": 0.0, "tilt": 0.0}, {"maxwell": 300.0, "tilt": 20.0})
    dear: Any = type(B)("tilt", unknowns=(1, 1), of_joints=False)
    found.best = fit(A, dear, loss=BEST)  # type: ignore[assignment]
    assert evidence(found)[1] == 18.0
