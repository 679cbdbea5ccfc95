"""Calibrating a base model: global, then local, from several starts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnosis.fit.misfit import Misfit
from diagnosis.fit.solver import Fitted, fit, fit_thoroughly
from diagnosis.fit.unknowns import Unknown, clip
from models.base import FloatArray

GLOBAL_POINTS = 64
STARTS, QUICK = 3, 5
"""The best of them are taken a few iterations on, and the best of these to the end."""


def calibrate_base(misfit: Misfit, seed: int = 0) -> Fitted:
    """The base fit. Unknowns with a range start from the best of a Sobol set, others from nominal values."""
    states = misfit.measured.states
    starts = [start_of(misfit.unknowns)]
    ranged = [i for i, unknown in enumerate(misfit.unknowns) if unknown.prior is None]
    if ranged:
        starts = _best_of_sobol(misfit, ranged, starts[0], seed)
    if len(starts) > 1:
        starts = [min((fit(misfit, u, states, QUICK) for u in starts), key=lambda f: f.loss).u]
    return fit_thoroughly(misfit, starts[0], states)


def start_of(unknowns: Sequence[Unknown]) -> FloatArray:
    return clip(unknowns, np.array([u.coordinate(u.start) for u in unknowns], float))


def _best_of_sobol(misfit: Misfit, ranged: Sequence[int], nominal: FloatArray, seed: int) -> list[FloatArray]:
    from scipy.stats import qmc

    bounds = np.array([misfit.unknowns[i].bounds for i in ranged])
    share = qmc.Sobol(len(ranged), seed=seed).random(GLOBAL_POINTS)
    candidates = np.repeat(nominal[None], GLOBAL_POINTS, axis=0)
    candidates[:, ranged] = qmc.scale(share, bounds[:, 0], bounds[:, 1])
    states = misfit.measured.states
    losses = misfit.losses(misfit.residuals([misfit.point(u, states) for u in candidates])).sum(axis=1)
    return [candidates[i] for i in np.argsort(losses)[:STARTS]]
