"""Errors estimated about a model that leaves a law of the impacts out hold most of it: the screen must see it still."""

from __future__ import annotations

import pytest

from diagnosis.errors.model import calibrated
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.setup import measure
from diagnosis.progress import silent
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.hidden import hidden_by_errors
from diagnosis.search.refit import Explanation
from diagnosis.search.screen import score
from diagnosis.search.select import first_effect, further_effects
from diagnosis.search.weighing import as_white_noise
from tests.diagnosis.made import SPECIMEN, recording

NAMES = ("restitution", "velocity_restitution", "tilt", "gain")


def test_a_mechanism_that_the_errors_hold_is_found_by_a_screen_against_white_noise() -> None:
    effect = {"restitution": {"factor_on_housner": 0.97}}
    measured = measure(SPECIMEN, [recording(f"run_{seed}", seed, effect) for seed in (1, 2)])
    fitted, errors = calibrated(SPECIMEN, measured)
    some = tuple(one for one in candidates(measured, SPECIMEN) if one.name in NAMES)
    scores = {one.candidate.name: one for one in score(linearise_about(fitted), some)}
    held, other = scores["restitution"], scores["velocity_restitution"]
    white = score(linearise_about(as_white_noise(fitted, errors)), some)
    (hidden,) = hidden_by_errors(white, {other.candidate}, 1, 0.05)
    assert hidden.candidate.name == "restitution"
    assert hidden.statistic > 10.0 * held.statistic  # scatter of impacts under these errors
    assert hidden_by_errors(white, {hidden.candidate}, 1, 0.05) == []


def test_a_second_effect_that_the_errors_hold_is_found_beside_the_first() -> None:
    """Impacts that lose 3 % more pass for impacts that scatter by 3 % about a base that leans."""
    effects = {"tilt": {"tilt": 0.01}, "restitution": {"factor_on_housner": 0.97}}
    measured = measure(SPECIMEN, [recording(f"run_{seed}", seed, effects) for seed in (1, 2)])
    fitted, errors = calibrated(SPECIMEN, measured)
    some = tuple(one for one in candidates(measured, SPECIMEN) if one.name in (*effects, "gain"))
    found = Search(Explanation((), fitted), some, errors)
    for _ in first_effect(found, silent):
        pass
    assert found.best is not None and found.best.names == ("tilt",)
    assert found.errors.scatter > 0.02
    for stage in further_effects(found, silent):
        found = stage
    assert found.best is not None and set(found.best.names) == set(effects)
    assert found.best.fitted.values["restitution.factor_on_housner"] == pytest.approx(0.97, abs=0.01)
    assert found.errors.scatter < 0.01
