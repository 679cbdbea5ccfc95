"""Fits from elsewhere in the ranges of a specimen: a model that lacked something has gone astray in them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import fit
from diagnosis.progress import silent
from diagnosis.search import exchange, select, singles
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.refit import QUICK, Explanation, again, extend, over_ranges
from models.runs import DONE
from tests.diagnosis import made
from tests.diagnosis.walls import LAYERS, MAXWELL, TRUE, WALL, misfit, recorded

ARM = {f"{name}{joint}": value for name, value in MAXWELL.items() for joint in ("", "_base", "_top")}


@pytest.mark.parametrize("powers", [(-1, -1, 1, 1), (1, -1, -1, -1), (-1, 1, -1, -1)])
def test_a_fit_with_an_effect_leaves_the_valley_of_a_base_that_went_astray(powers: tuple[int, ...]) -> None:
    measured = measure(WALL, [recorded(1, tuple(MAXWELL.items()))])
    one = misfit(measured)
    arm = next(c for c in candidates(measured, WALL) if c.name == "maxwell")
    own = np.array([x.coordinate(ARM[x.name]) for x in arm.unknowns])

    def with_arm(layers: dict[str, float], iterations: int) -> Explanation:
        values = {**TRUE, **layers}
        u = np.array([x.coordinate(values[x.name]) for x in one.unknowns])
        return extend(Explanation((), fit(one, u, measured.states, 0)), arm, own, iterations)

    right = again(with_arm(LAYERS, QUICK))
    astray = {name: value * 2.4**power for (name, value), power in zip(LAYERS.items(), powers, strict=True)}
    stuck = with_arm(astray, QUICK)
    assert stuck.loss > right.loss + 50.0
    found = over_ranges(stuck)
    assert found.loss < right.loss + 15.0
    assert found.candidates == stuck.candidates and over_ranges(found).loss <= found.loss


def test_a_specimen_without_ranges_is_left_as_it_is() -> None:
    measured = measure(made.SPECIMEN, [made.recording("a", 1)])
    stands = Explanation((), base_fit(made.SPECIMEN, measured))
    before = replace(DONE)
    assert over_ranges(stands) is stands and before == DONE


def test_the_leading_single_and_what_an_exchange_finds_start_anew_over_the_ranges(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[tuple[str, ...]] = []

    def noted(explanation: Explanation) -> Explanation:
        asked.append(explanation.names)
        return explanation

    for where in (singles, exchange):
        monkeypatch.setattr(where, "over_ranges", noted)
    effect = {"restitution": {"factor_on_housner": 0.93}}
    measured = measure(made.SPECIMEN, [made.recording(name, k, effect) for k, name in ((1, "a"), (2, "b"))])
    fitted, errors = calibrated(made.SPECIMEN, measured)
    base, known = Explanation((), fitted), candidates(measured, made.SPECIMEN)
    found = Search(base, known, errors)
    for _ in select.first_effect(found, silent):
        pass
    assert asked[0] == ("restitution",)

    pair = tuple(next(c for c in known if c.name == name) for name in ("restitution", "gain"))
    better = Explanation(pair, fitted)
    monkeypatch.setattr(exchange, "drop", lambda search: None)
    monkeypatch.setattr(exchange, "_try_others", lambda search, widely: None)
    monkeypatch.setattr(exchange, "_better", lambda search, incomplete: better)
    monkeypatch.setattr(exchange, "reshaped", lambda explanation: explanation)
    monkeypatch.setattr(exchange, "again", lambda explanation: explanation)
    monkeypatch.setattr(exchange, "weigh_again", lambda search: None)
    other = Explanation((next(c for c in known if c.name == "tilt"), pair[1]), fitted)
    exchange.exchanged(Search(base, known, errors, best=other), silent)
    assert asked[-1] == better.names
