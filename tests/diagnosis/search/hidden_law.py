"""Windows in which a law in a table acts that the base model lacks, its fit to them, and what it predicts of others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import measure
from diagnosis.fit.solver import fit
from diagnosis.fit.whitening import sensor_noise_only
from diagnosis.search.refit import Explanation
from diagnosis.search.tables import Law
from grids.stages import Stage
from tests.diagnosis.made import SPECIMEN, TRUE, at_truth, recording


def windows(
    seeds: Sequence[int], law: Mapping[str, float], noise: int, stages: Mapping[str, Sequence[Stage]] | None = None
) -> Measured:
    """Recordings cut in windows, in which the model with ``law`` was measured with noise."""
    measured = measure(SPECIMEN, [recording(f"run_{seed}", seed) for seed in seeds])
    values = {**TRUE, **{f"table_force.{name}": value for name, value in law.items()}}
    true = Predictor(measured, stages=stages or {}).predict([Point(values, measured.states)])[0]
    return replace(
        measured, values=true + np.random.default_rng(noise).normal(size=true.shape) * measured.sigma[..., None]
    )


def base(measured: Measured) -> Explanation:
    """The base model fitted from the true parameters."""
    start = at_truth(measured)
    return Explanation((), fit(start.misfit, start.u, start.states))


def chi2(explanation: Explanation, measured: Measured, law: Law | None = None) -> float:
    """Squared misfit a sample on other windows, parameters frozen, states refitted."""
    predictor = Predictor(measured)
    fitted = (law.explanation if law else explanation).fitted
    misfit = Misfit(predictor, sensor_noise_only(predictor), (), {**fitted.misfit.fixed, **fitted.values})
    found = fit(misfit, np.zeros(0), measured.states)
    return float(np.sum(misfit.residuals([found.point])[0] ** 2) / measured.count.sum())
