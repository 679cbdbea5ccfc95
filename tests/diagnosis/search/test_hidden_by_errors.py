"""Errors estimated about a model that leaves a law of the impacts out hold most of it: the screen must see it still."""

from __future__ import annotations

from diagnosis.errors.model import calibrated
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.setup import measure
from diagnosis.search.candidates import candidates
from diagnosis.search.screen import score
from diagnosis.search.select import hidden_by_errors
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
    (hidden,) = hidden_by_errors(white, {other.candidate}, 1)
    assert hidden.candidate.name == "restitution"
    assert hidden.statistic > 10.0 * held.statistic  # scatter of impacts under these errors
    assert hidden_by_errors(white, {hidden.candidate}, 1) == []
