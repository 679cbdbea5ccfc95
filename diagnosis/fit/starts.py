"""Where a fit starts: searched over the ranges of its model, from the measured states or from those of a fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnosis.fit.misfit import Misfit
from diagnosis.fit.solver import Fitted, fit
from diagnosis.fit.unknowns import Unknown, clip
from models.base import FloatArray

GLOBAL_POINTS = 64
STARTS, QUICK = 3, 5
"""The best of them are taken a few iterations on."""


@dataclass(frozen=True)
class Origin:
    """Coordinates (k,) and states (W, S) that a search starts from; ``known`` (k,): which are not searched."""

    u: FloatArray
    states: FloatArray
    known: np.ndarray


def searched(misfit: Misfit, origins: Sequence[Origin], seed: int = 0) -> Fitted:
    """The best of starts from ``origins``, a few iterations on if there are several.

    What is not known there is that of a Sobol set over its range.
    """
    starts = [start for origin in origins for start in _over_ranges(misfit, origin, seed, len(origins))]
    if len(starts) == 1:
        ((u, states),) = starts
        return fit(misfit, u, states, 0)
    losses = _losses(misfit, starts)
    best = [starts[i] for i in np.argsort(losses)[:STARTS]]
    return min((fit(misfit, u, states, QUICK) for u, states in best), key=lambda f: f.loss)


def nominal(misfit: Misfit) -> Origin:
    """The specimen's own values, the states as measured."""
    known = np.array([unknown.prior is not None for unknown in misfit.unknowns], bool)
    return Origin(start_of(misfit.unknowns), misfit.measured.states, known)


def start_of(unknowns: Sequence[Unknown]) -> FloatArray:
    return clip(unknowns, np.array([u.coordinate(u.start) for u in unknowns], float))


def _over_ranges(misfit: Misfit, origin: Origin, seed: int, shared_by: int) -> list[tuple[FloatArray, FloatArray]]:
    from scipy.stats import qmc

    ranged = np.flatnonzero(~origin.known)
    if not ranged.size:
        return [(origin.u, origin.states)]
    bounds = np.array([misfit.unknowns[i].bounds for i in ranged])
    count = max(1, GLOBAL_POINTS // shared_by)
    share = qmc.Sobol(len(ranged), seed=seed).random(1 << (count - 1).bit_length())[:count]
    points = np.repeat(origin.u[None], count, axis=0)
    points[:, ranged] = qmc.scale(share, bounds[:, 0], bounds[:, 1])
    return [(u, origin.states) for u in points]


def _losses(misfit: Misfit, starts: Sequence[tuple[FloatArray, FloatArray]]) -> FloatArray:
    found = misfit.losses(misfit.residuals([misfit.point(u, states) for u, states in starts])).sum(axis=1)
    return np.asarray(found)
