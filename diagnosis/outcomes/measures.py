"""Measures of a motion, and thresholds of one measure as the simplest predictors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import minimize
from scipy.stats import norm

import grids.motions.measures
from diagnosis.outcomes.ladder import ODD
from grids.motions import Motion
from grids.motions.measures import MEASURES
from models.base import FloatArray

SHOWN = tuple(measure for measure in MEASURES if measure.stretch is not None)
"""All but pseudo-accelerations: a rocking body has no period."""
UNITS = {measure.symbol: measure.unit for measure in SHOWN}
THRESHOLDS = ("PGA", "PGV")
SHARPEST, BLUNTEST = 0.02, 7.0
"""Logarithmic standard deviations of a threshold, at least and at most."""
BEYOND = 5.0
"""How far the logarithm of a median may lie beyond the measures."""


def measures_of(motions: Sequence[Motion]) -> dict[str, FloatArray]:
    """By symbol (`UNITS`), arrays (runs,), by `grids.motions.measures`."""
    found = [grids.motions.measures.measures_of(motion) for motion in motions]
    return {measure.symbol: np.array([one[measure.name] for one in found]) for measure in SHOWN}


def threshold(measure: FloatArray, outcomes: FloatArray) -> tuple[float, float]:
    """Median and logarithmic standard deviation of a lognormal threshold of ``measure`` (runs,), by likelihood."""
    x = np.log(measure)

    def loss(at: FloatArray) -> float:
        chance = np.clip(norm.cdf((x - at[0]) / np.exp(at[1])), ODD, 1.0 - ODD)
        return -float(np.sum(np.log(np.where(outcomes > 0.5, chance, 1.0 - chance))))

    start = [[float(np.quantile(x, q)), np.log(0.3)] for q in (0.25, 0.5, 0.75)]
    # Where larger motions stand and smaller ones fall the best median is infinite.
    bounds = [(float(x.min()) - BEYOND, float(x.max()) + BEYOND), (np.log(SHARPEST), np.log(BLUNTEST))]
    found = min(
        (minimize(loss, one, method="Nelder-Mead", bounds=bounds) for one in start), key=lambda one: float(one.fun)
    )
    return float(np.exp(found.x[0])), float(np.exp(found.x[1]))


def exceeding(measure: FloatArray, median: float, deviation: float) -> FloatArray:
    """Chance (runs,) of overturning by a lognormal threshold."""
    return np.asarray(np.clip(norm.cdf(np.log(measure / median) / deviation), ODD, 1.0 - ODD))
