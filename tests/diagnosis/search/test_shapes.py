"""A gap before a spring may stand for a layer that hardens."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.search import shapes
from diagnosis.search.budget import Budget
from diagnosis.search.candidates import candidates
from diagnosis.search.found import MISSING, Search
from diagnosis.search.refit import Explanation, again, extend
from diagnosis.search.shapes import in_the_place_of_shapes, without_idle_shapes
from tests.diagnosis.walls import WALL, recorded

SPRING, HARD, GAP = -1e5, 15.0, 0.003


@cache
def found(*law: tuple[str, float]) -> Search:
    measured = measure(WALL, [recorded(1, law)])
    fitted, errors = calibrated(WALL, measured, 0)
    return Search(Explanation((), fitted), candidates(measured, WALL), errors, budget=Budget(np.inf))


def alone(search: Search, name: str, *start: float) -> Explanation:
    law = next(c for c in search.candidates if c.name == name)
    u = np.array([x.coordinate(value) for x, value in zip(law.unknowns, start, strict=True)])
    return again(extend(search.base, law, u))


def test_a_gap_that_stands_for_hardening_gives_way_to_it() -> None:
    search = found(("hardening.beta2", HARD), ("added_stiffness.couple_stiffness", SPRING))
    single = alone(search, "added_stiffness", SPRING, GAP)
    assert single.fitted.values["added_stiffness.gap"] > GAP
    pairs = in_the_place_of_shapes(search, single)
    assert all(pair.candidates[0] is single.candidates[0] for pair in pairs)
    right = next(pair for pair in pairs if "hardening.beta2" in pair.fitted.values)
    assert right.loss < single.loss - 3.0
    assert right.fitted.values["added_stiffness.gap"] == pytest.approx(0.0, abs=1e-4)
    assert right.fitted.values["added_stiffness.couple_stiffness"] == pytest.approx(SPRING, rel=0.1)
    plain = without_idle_shapes(single, right)  # what hardening brings is held against the law without the gap
    assert "added_stiffness.gap" not in plain.fitted.values and plain.loss > single.loss + MISSING
    with_gap = replace(right, fitted=replace(right.fitted, u=np.append(single.fitted.u, right.fitted.u[-1])))
    assert without_idle_shapes(single, with_gap) is single


def test_a_gap_that_does_nothing_and_a_law_that_has_no_such_shape_are_left(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shapes, "seconds", lambda *_: pytest.fail("a screen"))
    search = found(("added_stiffness.couple_stiffness", SPRING))
    assert not in_the_place_of_shapes(search, alone(search, "added_stiffness", SPRING, 0.0))
    assert not in_the_place_of_shapes(search, alone(search, "maxwell", 0.1, 0.05))
