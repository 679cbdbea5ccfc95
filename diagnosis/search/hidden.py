"""Effects that hide in the errors: small under errors estimated without them, large once the errors know them.

A constant error of a sensor passes for a drift, a wrong law of events for their scatter. So where no mechanism stands
out under the errors of what was found so far, the strongest are tested with the variances estimated anew beside each
(`diagnosis.errors.evidence`), on the problem linearised about what was found.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from diagnosis.errors.evidence import Without
from diagnosis.errors.model import estimate
from diagnosis.fit.misfit import STEP
from diagnosis.search.beside import (
    FEWEST_SECOND,
    HOPELESS,
    SHARE_OF_SECOND,
    joinable,
    one_of_each,
    starts_of,
    worth_a_refit,
)
from diagnosis.search.candidates import Candidate
from diagnosis.search.details import least
from diagnosis.search.found import MISSING, Search, adjusted, passes_for_white, survives
from diagnosis.search.refit import QUICK, Explanation, best_of, extend, without
from diagnosis.search.screen import Score, at
from diagnosis.search.weighing import by_white_noise, weigh_again
from diagnosis.search.white_screen import against_white_noise
from models.base import FloatArray

LEAST, MOST = 3.0, 4
"""Gain under the errors as they are from which a mechanism is tested, and how many are."""


def hidden_by_errors(white: Sequence[Score], tried: Collection[Candidate], fewest: int, share: float) -> list[Score]:
    """The strongest ``fewest`` of a screen against white noise that were not tried.

    Errors about a model hold part of what is missing: scatter of events much of a wrong law of them. Such a mechanism
    has no score under these errors until it is in.
    """
    strongest = worth_a_refit(one_of_each(white), fewest, share)[:fewest]
    return [entry for entry in strongest if entry.candidate not in tried]


def hidden_beside(found: Search, best: Explanation, fits: Sequence[Explanation]) -> list[Explanation]:
    """Refits of ``best`` with one more mechanism that white noise makes a suspect, and that is not among the ``fits``.

    None where what is left of ``best`` passes for white noise, for then its errors hold nothing.
    """
    if passes_for_white(best, found.errors):
        return []
    if not found.affordable("what the errors hold beside what was found"):
        return []
    _, white = against_white_noise(found, best, joinable(found, best))
    hopeful = [entry for entry in white if entry.statistic > HOPELESS]
    more = []
    for entry in hidden_by_errors(hopeful, {e.candidates[-1] for e in fits}, FEWEST_SECOND, SHARE_OF_SECOND):
        if found.affordable(entry.candidate.name):
            tried = [extend(best, entry.candidate, start, QUICK) for start in starts_of(entry, white)]
            more.append(by_white_noise(best_of(tried), found.errors))
    return more


def take_hidden(found: Search, before: Explanation, fits: Sequence[Explanation]) -> None:
    """Take that of the largest evidence of ``fits``, each ``before`` with one more mechanism, if it counts.

    Beside others it has to leave errors that hold no more than noise, or what it explains may be part of a third thing.
    """
    beside = [e for e in sorted(fits, key=adjusted) if set(before.candidates) < set(e.candidates)]
    trials = [e for e in beside if adjusted(before) - adjusted(e) > LEAST][:MOST]
    if not trials:
        return
    errors = estimate(before.fitted, found.errors.base, found.errors)  # those of the search may stand at another fit
    base = Without.estimated(errors, before.measured, np.zeros((*before.measured.values.shape, 0)))
    gains = {}
    for trial in trials:
        column = _derivative(before, trial.candidates[-1])
        if np.any(column):
            gains[trial.candidates] = base.evidence(column).without_largest
    large = [trial for trial in trials if gains.get(trial.candidates, 0.0) > MISSING]
    if not large:
        return
    kept = replace(found)
    found.best, found.tried = max(large, key=lambda trial: gains[trial.candidates]), [*fits]
    weigh_again(found)
    if not _counts(found):
        vars(found).update(vars(kept))
    elif not before.candidates:
        found.marginal = gains.get(found.best.candidates, 0.0)


def _counts(found: Search) -> bool:
    """Whether what was taken counts under the errors estimated with it."""
    best = found.chosen
    if len(best.candidates) == 1:
        return found.gain(best) >= MISSING and survives(found.base, best)
    rest = without(best, best.candidates[-1])
    needed = least(found, rest, best.candidates[-1])
    return not found.incomplete and adjusted(rest) - adjusted(best) >= needed and survives(rest, best, needed)


def _derivative(before: Explanation, candidate: Candidate) -> FloatArray:
    """Change (W, C, N) of the predictions with the candidate's first coordinate at its null; zero without one."""
    predictor, point = before.fitted.misfit.predictor, before.fitted.point
    low, high = candidate.unknowns[0].bounds
    ends = [candidate.null.copy(), candidate.null.copy()]
    ends[0][0], ends[1][0] = max(ends[0][0] - STEP, low), min(ends[1][0] + STEP, high)
    width = ends[1][0] - ends[0][0]
    down, up = predictor.predict([at(point, candidate, u) for u in ends])
    slope = (up - down) / width
    return np.where(np.isfinite(slope) & before.measured.mask, slope, 0.0)
