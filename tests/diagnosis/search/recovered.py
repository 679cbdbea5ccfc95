"""A simulated effect against its own refit: seen by the screen, worth its gain, its size within its deviations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnosis.fit.intervals import covariances
from diagnosis.fit.linearisation import linearise_about
from diagnosis.search.candidates import Candidate
from diagnosis.search.refit import Explanation, again, best_of, extend, with_memory
from diagnosis.search.screen import score


def assert_recovered(before: Explanation, own: Sequence[Candidate], truth: float) -> None:
    """``truth``: the true value of the first parameter of the candidates ``own``."""
    seen = [s for s in score(linearise_about(before.fitted), own) if s.starts]
    assert max(s.statistic for s in seen) > 15.0
    after = with_memory(best_of([again(extend(before, s.candidate, start)) for s in seen for start in s.starts]))
    assert before.loss - after.loss > 15.0
    unknown = after.candidates[0].unknowns[0]
    place = [x.name for x in after.fitted.misfit.unknowns].index(unknown.name)
    sandwich, laplace = covariances(after.fitted)
    deviation = np.sqrt(max(sandwich[place, place], laplace[place, place]))
    off = after.fitted.u[place] - unknown.coordinate(truth)
    assert abs(off) < 3.0 * deviation, (after.fitted.values[unknown.name], deviation)
