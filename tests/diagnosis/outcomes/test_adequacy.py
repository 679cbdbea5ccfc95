"""Outcomes that the model predicts the wrong way round, and such that it explains."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.outcomes.adequacy import chance_of_slopes, swapped
from diagnosis.outcomes.measures import exceeding, threshold
from diagnosis.outcomes.statement import why_unexplained

PGA = np.geomspace(1.0, 9.0, 16)
CHANCE = np.clip(np.linspace(-0.5, 1.5, 16), 0.05, 0.95)
FELL = (PGA > 3.0).astype(float)


def test_outcomes_the_wrong_way_round_are_seen() -> None:
    assert swapped(CHANCE, 1.0 - FELL) and not swapped(CHANCE, FELL)


def test_residuals_that_slope_along_a_measure_are_seen() -> None:
    rng = np.random.default_rng(1)
    assert chance_of_slopes(CHANCE, 1.0 - FELL, {"PGA": PGA}, rng) < 0.01
    assert chance_of_slopes(CHANCE, FELL, {"PGA": PGA}, rng) > 0.1


@pytest.mark.filterwarnings("error")
def test_a_threshold_of_outcomes_the_wrong_way_round_stays_finite() -> None:
    for fell in (FELL, 1.0 - FELL):
        median, deviation = threshold(PGA, fell)
        assert 1e-3 < median < 1e4 and 0.0 < deviation < 10.0
        assert np.all(np.isfinite(exceeding(PGA, median, deviation)))


@pytest.mark.parametrize(
    ("misfit", "slope", "said"),
    [
        (0.001, 0.4, "within groups of runs (p at most 0.001)"),
        (0.2, 0.004, "depends on the motion (p 0.004)"),
        (0.2, 0.4, "worse than by a coin"),
    ],
)
def test_why_outcomes_count_as_unexplained_is_told_with_its_number(misfit: float, slope: float, said: str) -> None:
    answer: Any = SimpleNamespace(misfit_p_value=misfit, slope_p_value=slope)
    assert said in why_unexplained(answer)
