"""Mechanisms that set in at a threshold, fitted from the measured states where the model without them misfits.

They have no slope at their null. Where such an effect is strong (a base that slips) the base model's parameters go
astray, its windows end far from their states, and no value of the effect helps from there. So fits begin at the
measured states, with values a little beyond the one at which the effect sets in.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from diagnosis.errors.model import Errors
from diagnosis.fit.misfit import STEP
from diagnosis.search.candidates import Candidate
from diagnosis.search.found import left_over_white_noise
from diagnosis.search.refit import QUICK, Explanation, extend
from diagnosis.search.screen import at
from models.base import FloatArray

MISFITS = 2.0
"""Misfit per sample over white noise from which on a fit is no guide to where its windows begin."""
BEYOND = (0.03, 0.1, 0.2, 0.35)
"""Shares by which starts lie beyond the value at which the effect sets in."""
BETWEEN = 16
"""Values between two of the grid at which that value is looked for."""
CHANGED = 1e-3
"""Noise levels by which a prediction is another one, beyond rounding."""


def misfits(explanation: Explanation, errors: Errors) -> bool:
    """Whether a fit is far from its recordings."""
    return left_over_white_noise(explanation, errors) > MISFITS


def setting_in(explanation: Explanation, candidates: Sequence[Candidate]) -> list[Candidate]:
    """Those with their null at infinity that a step from it leaves without effect from the measured states.

    From states that a fit has led astray a base without weight on it slips at any friction.
    """
    begins = _from_measured(explanation)
    found = []
    for candidate in candidates:
        if candidate.unknowns[0].kind == "inverse":
            near = candidate.null
            near[0] += STEP
            if _first(begins, candidate, [near]) is None:
                found.append(candidate)
    return found


def from_measured(explanation: Explanation, candidate: Candidate) -> list[Explanation]:
    """Fits with a mechanism from the measured states; none where no value of it changes what is predicted."""
    begins = _from_measured(explanation)
    null = candidate.null[0]
    sets_in = _sets_in(begins, candidate)
    if sets_in is None:
        return []
    low, high = candidate.unknowns[0].bounds
    starts = []
    for share in BEYOND:
        start = sets_in.copy()
        start[0] = np.clip(null + (sets_in[0] - null) / (1.0 - share), low, high)
        starts.append(start)
    return [extend(begins, candidate, start, QUICK) for start in starts]


def _from_measured(explanation: Explanation) -> Explanation:
    return replace(explanation, fitted=replace(explanation.fitted, states=explanation.measured.states))


def _sets_in(begins: Explanation, candidate: Candidate) -> FloatArray | None:
    """Coordinates at which a mechanism first changes the prediction, its shapes as first in its grid."""
    trials = list(candidate.grid(finely=True))
    trials = [u for u in trials if np.array_equal(u[1:], trials[0][1:])]
    first = _first(begins, candidate, trials)
    if first is None:
        return None
    before = candidate.null if first == 0 else trials[first - 1]
    between = []
    for value in np.linspace(before[0], trials[first][0], BETWEEN + 1)[1:]:
        u = trials[first].copy()
        u[0] = value
        between.append(u)
    nearest = _first(begins, candidate, between)
    return between[-1 if nearest is None else nearest]


def _first(begins: Explanation, candidate: Candidate, trials: list[FloatArray]) -> int | None:
    """Which of the trials is the first that changes the prediction."""
    misfit = begins.fitted.misfit
    point = misfit.point(begins.fitted.u, begins.fitted.states)
    r = misfit.residuals([point, *(at(point, candidate, u) for u in trials)])
    changed = np.flatnonzero(np.max(np.abs(r[1:] - r[0]), axis=(1, 2)) > CHANGED)
    return int(changed[0]) if changed.size else None
