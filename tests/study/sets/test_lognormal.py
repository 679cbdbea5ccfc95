"""Fits of fragility against simulated truth: estimates, and how often the intervals hold it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import binomtest, norm

from study.sets.fragility import binomial_interval
from study.sets.lognormal import fit_lognormal
from tests.study.sets.simulated import DISPERSION, LEVELS, MEDIAN, capacities

RUNS = 150


def scaled_records(random: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """25 motions, each at all levels: the cells of a motion hang together."""
    capacity = capacities(random, 25)
    x = np.broadcast_to(LEVELS, (25, LEVELS.size))
    return x.ravel(), (x >= capacity[:, None]).astype(float).ravel(), np.repeat(np.arange(25), LEVELS.size)


def cloud(random: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """100 records as they are."""
    x = 2.5 * np.exp(0.7 * random.standard_normal(100))
    return x, (x >= capacities(random, 100)).astype(float), np.arange(100)


@pytest.mark.parametrize("draw", [scaled_records, cloud])
def test_intervals_hold_the_truth_as_often_as_they_say(draw: object) -> None:
    """The binomial interval of each coverage holds .95, at 1 % in all for the six of them."""
    random = np.random.default_rng(1)
    held = {"median": 0, "dispersion": 0, "curve": 0}
    fitted = 0
    at = np.array([MEDIAN * np.exp(-DISPERSION)])
    for _ in range(RUNS):
        fit = fit_lognormal(*draw(random))  # type: ignore[operator]
        if fit.why:
            continue
        fitted += 1
        held["median"] += fit.median[1] <= MEDIAN <= fit.median[2]
        held["dispersion"] += fit.dispersion[1] <= DISPERSION <= fit.dispersion[2]
        _, low, high = fit.probability(at)
        held["curve"] += bool(low[0] <= norm.cdf(-1.0) <= high[0])
    assert fitted > 0.97 * RUNS
    for name, count in held.items():
        interval = binomtest(count, fitted).proportion_ci(1 - 0.01 / 6)
        assert interval.low <= 0.95 <= interval.high, (name, count, fitted)


def test_many_motions_give_the_truth() -> None:
    """Within three standard errors of a sample of 2000: beta/sqrt(n) of ln theta, about twice that of ln beta."""
    random = np.random.default_rng(4)
    x = np.broadcast_to(LEVELS, (2000, LEVELS.size))
    y = (x >= capacities(random, 2000)[:, None]).astype(float)
    fit = fit_lognormal(x.ravel(), y.ravel(), np.repeat(np.arange(2000), LEVELS.size))
    assert fit.median[0] == pytest.approx(MEDIAN, rel=3 * DISPERSION / 2000**0.5)
    assert fit.dispersion[0] == pytest.approx(DISPERSION, rel=3 * 2 / 4000**0.5)


def test_cells_that_share_motions_widen_the_interval() -> None:
    """The same cells taken as independent give an interval that is too narrow."""
    x, y, motion = scaled_records(np.random.default_rng(2))
    together, apart = fit_lognormal(x, y, motion), fit_lognormal(x, y, np.arange(x.size))
    assert together.median[0] == pytest.approx(apart.median[0])
    assert np.log(together.median[2] / together.median[1]) > 1.2 * np.log(apart.median[2] / apart.median[1])


def test_fit_is_the_largest_likelihood() -> None:
    x, y, motion = cloud(np.random.default_rng(3))
    fit = fit_lognormal(x, y, motion)

    def loss(median: float, spread: float) -> float:
        index = np.log(x / median) / spread
        return -float(np.sum(np.where(y == 1.0, norm.logcdf(index), norm.logcdf(-index))))

    best = loss(fit.median[0], fit.dispersion[0])
    for theta in (0.99, 1.0, 1.01):
        for beta in (0.98, 1.0, 1.02):
            assert loss(theta * fit.median[0], beta * fit.dispersion[0]) >= best


@pytest.mark.parametrize(
    ("y", "why"),
    [
        ([0, 0, 0, 0, 0, 0], "never"),
        ([1] * 6, "always"),
        ([0, 0, 0, 1, 1, 1], "one threshold"),
        ([1, 1, 0, 1, 0, 0], "more often"),
    ],
)
def test_what_cannot_be_fitted_says_so(y: list[int], why: str) -> None:
    fit = fit_lognormal(np.arange(1.0, 7.0), np.array(y, dtype=float), np.arange(6))
    assert why in fit.why and np.isnan(fit.median).all()


def test_binomial_interval() -> None:
    """Clopper and Pearson's as scipy has it; its ends are 0 and 1 where nothing or all happened."""
    for k in (0, 3, 10):
        low, high = binomial_interval(np.array([float(k)]), np.array([10.0]))
        exact = binomtest(k, 10).proportion_ci(0.95)
        assert (low[0], high[0]) == pytest.approx((exact.low, exact.high))
