"""Samples of a fit: its intervals, correlations and bounds; a study takes them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import models
from diagnosis.answer.posterior import posterior
from diagnosis.fit.intervals import correlation, estimates
from diagnosis.fit.posterior import samples
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import Fitted
from diagnosis.outcomes.answer import Posterior
from diagnosis.outcomes.files import write_posterior as from_outcomes
from diagnosis.report.posterior_file import write_posterior
from grids.plan import parse_plan
from tests.diagnosis.made import SPECIMEN, recording

UNKNOWN = replace(SPECIMEN, tolerance={"width": 0.005}, calibrate={"restitution": (0.8, 1.0), "gain.gain": (-0.2, 0.2)})
PLAN = """
[study]
name = "found"
model = "housner"
[motion]
files = ["ridgecrest_2019_clc"]
vertical = false
[parameters]
height = "1.8 m"
mass = "540 kg"
[samples]
from = "posterior.nc"
[axes]
pga = { values = [0.3], unit = "g" }
"""


@pytest.fixture(scope="module")
def fitted() -> Fitted:
    return base_fit(UNKNOWN, measure(UNKNOWN, [recording("a", 1), recording("b", 2)]))


def test_samples_have_the_intervals_and_correlations_of_the_fit(fitted: Fitted) -> None:
    drawn, intervals = samples(fitted, 20_000, seed=3), estimates(fitted)
    assert list(drawn) == list(intervals)
    for name, expected in intervals.items():
        low, middle, high = np.quantile(drawn[name], [0.025, 0.5, 0.975])
        width = expected.high95 - expected.low95
        assert abs(low - expected.low95) + abs(high - expected.high95) < 0.05 * width
        assert middle == pytest.approx(expected.estimate, abs=0.02 * width)
    found = np.corrcoef(list(drawn.values()))
    np.testing.assert_allclose(found, correlation(fitted), atol=0.03)


def test_samples_stay_within_bounds(fitted: Fitted) -> None:
    """A range that ends at the estimate cuts the samples there."""
    unknowns = fitted.misfit.unknowns
    k = [x.name for x in unknowns].index("restitution")
    at = fitted.values["restitution"]
    cut = (*unknowns[:k], replace(unknowns[k], high=at), *unknowns[k + 1 :])
    drawn = samples(replace(fitted, misfit=replace(fitted.misfit, unknowns=cut)), 500)["restitution"]
    assert drawn.max() <= at * (1 + 1e-12) and np.unique(drawn).size == 500


def test_a_study_takes_what_is_the_walls(fitted: Fitted, tmp_path: Path) -> None:
    model = models.get("housner")
    found = posterior(fitted, model)
    assert set(found) == {"width", "restitution"}  # a gain is the sensor's
    write_posterior(found, model, "test block", tmp_path / "posterior.nc")
    plan = parse_plan(PLAN, tmp_path)
    axis = plan.axes[0]
    assert axis.name == "sample" and axis.size == 1000
    for name, values in found.items():
        np.testing.assert_array_equal(axis.sets[name], values)


def test_a_study_passes_over_what_outcomes_say_of_the_runs(tmp_path: Path) -> None:
    width = np.array([0.24, 0.26])
    held = Posterior({"width": width}, {"width": "m"}, np.array([0.1, 0.2]))
    from_outcomes(held, tmp_path / "posterior.nc")
    assert dict(parse_plan(PLAN, tmp_path).axes[0].sets).keys() == {"width"}
