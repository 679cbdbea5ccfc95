"""What does nearly the same as a leader that explains everything is fitted from where that ended.

A fit from a small effect may lose its way to a large one: the mass centre far beside the middle of a block was
answered with a base that leans.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from diagnosis.errors.model import disturbance_about, estimate
from diagnosis.fit.setup import base_fit, measure
from diagnosis.progress import silent
from diagnosis.search import singles
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search, explains_all
from diagnosis.search.refit import Explanation, extend, from_other, in_the_place_of
from diagnosis.search.singles import refit_singles, take_further
from diagnosis.search.weighing import reweighed
from tests.diagnosis.made import SPECIMEN, recording

OFFSET = -0.19
NAMES = ("eccentricity", "tilt", "viscous_damping")


@pytest.fixture(scope="module")
def found() -> Search:
    """Under the errors of the true model; the base model and every mechanism alone are where they are declared."""
    effect = {"eccentricity": {"offset_over_half_width": OFFSET}}
    measured = measure(SPECIMEN, [recording(f"run_{seed}", seed, effect) for seed in (1, 2)])
    some = {one.name: one for one in candidates(measured, SPECIMEN) if one.name in NAMES}
    first = Explanation((), base_fit(SPECIMEN, measured))
    true = extend(first, some["eccentricity"], some["eccentricity"].null)
    errors = estimate(true.fitted, disturbance_about(true.fitted))
    return Search(reweighed(first, errors), tuple(some.values()), errors)


def single(found: Search, name: str, iterations: int) -> Explanation:
    (candidate,) = (one for one in found.candidates if one.name == name)
    return extend(found.base, candidate, candidate.null, iterations)


def test_it_is_fitted_from_the_size_that_fits_best_where_the_other_ended(found: Search) -> None:
    lost, leader = single(found, "eccentricity", 0), single(found, "tilt", 12)
    assert explains_all(leader) and lost.loss > leader.loss + 100.0
    one_step = in_the_place_of(lost, leader, most=0.0).loss
    assert one_step < from_other(lost, leader, most=0.0).loss - 1.0
    led = in_the_place_of(lost, leader)
    assert led.loss <= single(found, "eccentricity", 12).loss + 0.5
    assert led.fitted.values["eccentricity.offset_over_half_width"] == pytest.approx(OFFSET, abs=0.02)
    assert in_the_place_of(leader, lost) is leader


@pytest.mark.parametrize("explained", [True, False])
def test_singles_far_behind_are_where_the_leader_explains_everything(
    monkeypatch: pytest.MonkeyPatch, found: Search, explained: bool
) -> None:
    lost, leader, other = (
        single(found, "eccentricity", 0),
        single(found, "tilt", 12),
        single(found, "viscous_damping", 0),
    )
    asked: list[tuple[str, float]] = []

    def watched(one: Explanation, first: Explanation, most: float) -> Explanation:
        asked.append((one.names[0], most))
        return in_the_place_of(one, first, most)

    for name in ("over_ranges", "reshaped", "again", "with_memory"):
        monkeypatch.setattr(singles, name, lambda one: one)
    for name, stands_in in (("at_other_joints", None), ("in_its_place", None), ("_may_hide", False), ("led_by", False)):
        monkeypatch.setattr(singles, name, lambda *_, stands_in=stands_in: stands_in)
    monkeypatch.setattr(singles, "heavy", lambda entry, _: entry.candidate.name == "viscous_damping")
    monkeypatch.setattr(singles, "explains_all", lambda _: explained)
    monkeypatch.setattr(singles, "in_the_place_of", watched)

    def refitted(search: Search, *_: Any) -> list[Any]:
        search.singles += [replace(one) for one in (leader, lost, other)]
        return []

    monkeypatch.setattr(singles, "_refit_in_turn", refitted)
    search = replace(found, singles=[], tried=[])
    take_further(search, refit_singles(search, silent))
    assert [name for name, _ in asked] == (["eccentricity"] if explained else [])
    if explained:
        assert leader.loss < asked[0][1] < found.base.loss
        best = {one.names[0]: one.loss for one in search.singles}
        assert best["eccentricity"] < leader.loss + 1.0 and np.isfinite(best["viscous_damping"])
