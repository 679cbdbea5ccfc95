"""What a strong law of a layer leaves of its force is a detail of it; what a sensor brings beside it is not."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from diagnosis.search import details, select
from diagnosis.search.details import OF_LAW, least
from diagnosis.search.found import MISSING

MORE = 30.0


def candidate(name: str, *joints: str) -> Any:
    return SimpleNamespace(name=name, mechanism=SimpleNamespace(at_joints=joints))


ARM, YIELDING = candidate("maxwell", "interface"), candidate("bouc_wen", "interface")
LEAN, LANDING = candidate("tilt"), candidate("restitution", "stacked")


def explanation(gain: float, *candidates: Any, model: str = "interface") -> Any:
    measured = SimpleNamespace(model=SimpleNamespace(name=model))
    names = tuple(c.name for c in candidates)
    return SimpleNamespace(candidates=candidates, measured=measured, gain=gain, loss=-gain, names=names)


def search(*singles: Any) -> Any:
    return SimpleNamespace(
        gain=lambda e: e.gain, more=MORE, singles=singles, strongest_law=None, pass_over=lambda one: None
    )


@pytest.fixture(autouse=True)
def prices_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(details, "adequate", lambda e: True)
    monkeypatch.setattr(select, "without_idle_shapes", lambda single, _: single)
    for module in (details, select):
        monkeypatch.setattr(module, "adjusted", lambda e: e.loss)


def test_another_law_of_the_joints_and_a_departure_from_constancy_must_bring_a_share_of_a_strong_law() -> None:
    strong = explanation(50_000.0, ARM)
    assert least(search(), strong, YIELDING) == least(search(), strong) == MISSING + OF_LAW * 50_000.0
    assert least(search(), explanation(500.0, ARM), YIELDING) == MORE


def test_what_is_no_law_of_the_joints_counts_from_the_ordinary_threshold_on() -> None:
    assert least(search(), explanation(50_000.0, ARM), LEAN) == MORE
    assert least(search(), explanation(50_000.0, LEAN), YIELDING) == MORE
    assert least(search(), explanation(50_000.0, LEAN)) == MORE
    assert least(search(), explanation(50_000.0, LANDING, model="housner")) == MORE


def test_what_leaves_more_than_noise_leaves_no_details(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(details, "adequate", lambda e: False)
    strong = explanation(50_000.0, ARM)
    assert least(search(), strong, YIELDING) == least(search(), strong) == MORE


def test_of_several_effects_the_law_counts_by_its_own_evidence(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []

    def rest(whole: Any, left_out: Any, iterations: int) -> Any:
        asked.append(left_out)
        return explanation(10_000.0)

    monkeypatch.setattr(details, "without", rest)
    found, both = search(), explanation(50_000.0, ARM, LEAN)
    for _ in range(2):
        assert least(found, both, YIELDING) == MISSING + OF_LAW * 40_000.0
    assert asked == [ARM]  # once, and nothing for the lean
    least(found, explanation(50_000.0, ARM, LEAN), YIELDING)
    assert asked == [ARM, ARM]


def test_a_detail_is_passed_over_and_a_sensor_that_explains_less_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(select, "survives", lambda before, after, threshold: True)
    best = explanation(50_000.0, ARM)
    detail, sensor = explanation(50_150.0, ARM, YIELDING), explanation(50_100.0, ARM, LEAN)
    found = search(best)
    assert select._pair_that_counts(found, best, [sensor, detail]) is sensor
    assert select._pair_that_counts(found, best, [detail]) is None
    another = explanation(51_000.0, ARM, YIELDING)
    assert select._pair_that_counts(found, best, [sensor, another]) is another


def test_in_the_place_of_a_shape_another_law_counts_by_what_it_brings_over_the_law_without_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The evidence of a gap that stands for a layer that hardens is evidence of that layer."""
    best, pair = explanation(50_000.0, ARM), explanation(50_150.0, ARM, YIELDING)
    for plain, counts in ((explanation(48_000.0, ARM), pair), (explanation(49_900.0, ARM), None)):
        held_against: list[Any] = []
        monkeypatch.setattr(select, "without_idle_shapes", lambda *_, plain=plain: plain)
        monkeypatch.setattr(select, "survives", lambda before, *_, of=held_against: of.append(before) or True)
        assert select._pair_that_counts(search(best), best, [pair]) is counts
        assert held_against == ([plain] if counts else [])
