"""An effect larger than the library takes for possible is no explanation, and is said to be that."""

from __future__ import annotations

import numpy as np
import pytest

from diagnosis.answer.ranges import beyond_ranges
from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation, extend
from tests.diagnosis.made import SPECIMEN, recording


def found_with(rate: float) -> Search:
    """A dashpot, found among the fits of its own range."""
    effect = {"viscous_damping": {"rate": rate}}
    measured = measure(SPECIMEN, [recording("a", 1, effect), recording("b", 2, effect)])
    fitted, errors = calibrated(SPECIMEN, measured)
    known = candidates(measured, SPECIMEN)
    dashpot = next(c for c in known if c.name == "viscous_damping")
    start = np.array([dashpot.unknowns[0].coordinate(0.5)])
    base = Explanation((), fitted)
    return Search(base, known, errors, best=extend(base, dashpot, start))


@pytest.mark.parametrize("rate", [0.6, 1.0])
def test_an_effect_within_its_range_is_not_questioned(rate: float) -> None:
    assert beyond_ranges(found_with(rate)) == ()


def test_one_that_needs_more_is_said_with_what_it_needs() -> None:
    (one,) = beyond_ranges(found_with(1.5))
    assert one.effect == "viscous_damping" and one.parameter == "rate" and one.limit == 1.0
    assert one.wanted == pytest.approx(1.5, rel=0.03) and one.evidence > 100.0
