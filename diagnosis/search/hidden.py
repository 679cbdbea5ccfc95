"""Effects that hide in the errors: small under errors estimated without them, large once the errors know them.

A constant error of a sensor passes for a drift, a wrong law of events for their scatter. So where no mechanism stands
out under the errors of the base model, the strongest are tested with the variances estimated anew beside each
(`diagnosis.errors.evidence`), on the problem linearised about the base model.
"""

from __future__ import annotations

import numpy as np

from diagnosis.errors.evidence import Without
from diagnosis.fit.misfit import STEP
from diagnosis.search.candidates import Candidate
from diagnosis.search.found import MISSING, Search, survives
from diagnosis.search.screen import at
from diagnosis.search.weighing import weigh_again
from models.base import FloatArray

LEAST, MOST = 3.0, 4
"""Gain under the errors of the base model from which a single is tested, and how many are."""


def take_hidden(found: Search) -> None:
    """The single of the largest evidence with its own errors, if it counts."""
    trials = [single for single in found.singles if found.gain(single) > LEAST][:MOST]
    if not trials:
        return
    base = Without.estimated(found.errors, found.measured, np.zeros((*found.measured.values.shape, 0)))
    gains = {}
    for single in trials:
        column = _derivative(found, single.candidates[0])
        if np.any(column):
            gains[single.names] = base.evidence(column).without_largest
    large = [single for single in trials if gains.get(single.names, 0.0) > MISSING]
    if not large:
        return
    kept = found.base, found.errors, found.singles, found.tried
    found.best, found.tried = max(large, key=lambda single: gains[single.names]), found.singles
    weigh_again(found)
    if found.gain(found.best) < MISSING or not survives(found.base, found.best):
        found.base, found.errors, found.singles, found.tried = kept
        found.best, found.at_null = None, None
        return
    found.marginal = gains.get(found.best.names, 0.0)


def _derivative(found: Search, candidate: Candidate) -> FloatArray:
    """Change (W, C, N) of the predictions with the candidate's first coordinate at its null; zero without one."""
    predictor, point = found.base.fitted.misfit.predictor, found.base.fitted.point
    low, high = candidate.unknowns[0].bounds
    ends = [candidate.null.copy(), candidate.null.copy()]
    ends[0][0], ends[1][0] = max(ends[0][0] - STEP, low), min(ends[1][0] + STEP, high)
    width = ends[1][0] - ends[0][0]
    down, up = predictor.predict([at(point, candidate, u) for u in ends])
    slope = (up - down) / width
    return np.where(np.isfinite(slope) & found.measured.mask, slope, 0.0)
