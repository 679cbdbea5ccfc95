"""Where something must be added without a name for it, under errors that hold part of what is missing."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from diagnosis.answer.located import located
from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.search.refit import Explanation
from tests.diagnosis.made import SPECIMEN, recording


@pytest.mark.parametrize(
    "effect",
    [
        {"restitution": {"factor_on_housner": 0.93}},
        {"degradation": {"loss_of_restitution_per_impact": 0.003, "floor": 0.9}},
    ],
)
def test_a_wrong_law_of_impacts_acts_at_impacts(effect: Mapping[str, Mapping[str, float]]) -> None:
    """About the base model they scatter as much as they may; with that for noise it was seen between impacts."""
    measured = measure(SPECIMEN, [recording("a", 1, effect), recording("b", 2, effect)])
    fitted, errors = calibrated(SPECIMEN, measured)
    assert errors.scatter > 0.02
    places, laws = located(Explanation((), fitted), None, errors)
    assert {place.where for place in places} == {("impact",)} and laws == ()
    assert sum(place.share for place in places) == pytest.approx(1.0)
