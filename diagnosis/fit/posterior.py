"""Samples of what a fit found, with its uncertainty: normal in the fit's coordinates, within their bounds.

The covariance is that of the intervals (`diagnosis.fit.intervals`): correlations of the sandwich, each standard
deviation the larger of the sandwich's and the inverse Hessian's. It holds where the loss is nearly quadratic over the
interval; a profile that is lopsided shows where it is not.
"""

from __future__ import annotations

import numpy as np

from diagnosis.fit.intervals import UNINFORMED, at_least, covariances
from diagnosis.fit.solver import Fitted
from models.base import FloatArray

COUNT = 1000
ROUNDS = 100
"""Draws outside the bounds are drawn again so often; what is outside still is put on the bound."""


def samples(fitted: Fitted, count: int = COUNT, seed: int = 0) -> dict[str, FloatArray]:
    """Values ``(count,)`` of every unknown, in its SI unit; uniform in its range where nothing depends on it."""
    unknowns = fitted.misfit.unknowns
    if not unknowns:
        return {}
    bounds = np.array([x.bounds for x in unknowns])
    rng = np.random.default_rng(seed)
    sandwich, laplace = covariances(fitted)
    values, vectors = np.linalg.eigh(at_least(sandwich, laplace))
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    u = np.empty((count, len(unknowns)))
    again = np.arange(count)
    for _ in range(ROUNDS):
        u[again] = fitted.u + rng.normal(size=(again.size, len(unknowns))) @ root.T
        again = again[np.any((u[again] < bounds[:, 0]) | (u[again] > bounds[:, 1]), axis=1)]
        if not again.size:
            break
    u = np.clip(u, bounds[:, 0], bounds[:, 1])
    unknown = np.sqrt(np.maximum(np.diag(laplace), 0.0)) < UNINFORMED
    u[:, unknown] = rng.uniform(bounds[unknown, 0], bounds[unknown, 1], (count, int(unknown.sum())))
    found = {x.name: np.array([x.value(one) for one in u[:, k]]) for k, x in enumerate(unknowns)}
    predictor = fitted.misfit.predictor
    if predictor.coordinates:  # the model's own parameters, that depend on the other unknowns too
        own = predictor.declared([fitted.misfit.point(one, fitted.states) for one in u])
        found |= {x: np.array([p.values[x] for p in own]) for x in predictor.coordinates if x in found}
    return found
