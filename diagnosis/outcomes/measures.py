"""Measures of a motion, and thresholds of one measure as the simplest predictors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import minimize
from scipy.stats import norm

from diagnosis.outcomes.ladder import ODD
from grids.motions import Motion
from grids.motions.intensity import intensity_measures
from models.base import FloatArray

UNITS = {"PGA": "m s-2", "PGV": "m s-1", "PGD": "m", "Arias intensity": "m s-1", "duration": "s", "PGV/PGA": "s"}
THRESHOLDS = ("PGA", "PGV")
SHARPEST = 0.02


def measures_of(motions: Sequence[Motion]) -> dict[str, FloatArray]:
    """By name (`UNITS`), arrays (runs,); PGV and PGD by `grids.motions.intensity`."""
    found = [intensity_measures(motion) for motion in motions]
    return {
        "PGA": np.array([one.pga for one in found]),
        "PGV": np.array([one.pgv for one in found]),
        "PGD": np.array([one.pgd for one in found]),
        "Arias intensity": np.array([one.arias for one in found]),
        "duration": np.array([one.significant_duration for one in found]),
        "PGV/PGA": np.array([one.pgv / one.pga for one in found]),
    }


def threshold(measure: FloatArray, outcomes: FloatArray) -> tuple[float, float]:
    """Median and logarithmic standard deviation of a lognormal threshold of ``measure`` (runs,), by likelihood."""
    x = np.log(measure)

    def loss(at: FloatArray) -> float:
        chance = np.clip(norm.cdf((x - at[0]) / np.exp(at[1])), ODD, 1.0 - ODD)
        return -float(np.sum(np.log(np.where(outcomes > 0.5, chance, 1.0 - chance))))

    start = [[float(np.quantile(x, q)), np.log(0.3)] for q in (0.25, 0.5, 0.75)]
    found = min((minimize(loss, one, method="Nelder-Mead") for one in start), key=lambda one: float(one.fun))
    return float(np.exp(found.x[0])), max(float(np.exp(found.x[1])), SHARPEST)


def exceeding(measure: FloatArray, median: float, deviation: float) -> FloatArray:
    """Chance (runs,) of overturning by a lognormal threshold."""
    return np.asarray(np.clip(norm.cdf(np.log(measure / median) / deviation), ODD, 1.0 - ODD))
