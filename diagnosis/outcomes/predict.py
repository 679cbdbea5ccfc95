"""Further runs predicted from a saved answer."""

from __future__ import annotations

import numpy as np

import models
from diagnosis.outcomes.answer import Posterior, Prediction
from diagnosis.outcomes.ladder import ODD, Ladder, weights
from diagnosis.progress import Progress, silent
from grids.recordings.outcomes import Outcomes
from grids.specimen import Specimen

SIMULATED = 64
"""Samples of the posterior that are simulated."""


def predict_outcomes(
    specimen: Specimen, posterior: Posterior, outcomes: Outcomes, progress: Progress = silent
) -> Prediction:
    """Chance that each run overturns the extended ``specimen``, averaged over the posterior.

    The interval is of the chance over the posterior; an outcome scatters about its chance besides.
    """
    ladder = Ladder.of(models.get(specimen.model), specimen, outcomes.motions)
    kept = np.linspace(0, posterior.scatter.size - 1, min(SIMULATED, posterior.scatter.size)).round().astype(int)
    points = [{name: float(values[k]) for name, values in posterior.values.items()} for k in kept]
    fell = ladder.fell(points, progress)
    share = np.einsum("prk,pk->pr", fell, weights(posterior.scatter[kept]))
    chance = ODD + (1.0 - 2.0 * ODD) * share
    low, high = np.quantile(chance, (0.025, 0.975), axis=0)
    return Prediction(outcomes.runs, chance.mean(axis=0), low, high)
