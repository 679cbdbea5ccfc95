"""Recordings left out in turn and predicted from the others: what a fit to all of them cannot say.

Where no model explains everything, what they all get wrong is as large as what tells two of them apart, and the
likelihood, for which such errors are chance, overrates the difference. The law that is closer to the truth then
predicts a recording better that it was not fitted to.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.fit.solver import ITERATIONS, fit
from diagnosis.search.refit import Explanation

BEYOND = 1.1
"""Peak over the largest learned from, from which a prediction extrapolates."""
WORSE = 1.05
"""Error over that of another prediction from which on it is worse: of recordings left out, and of those held out."""


def predicts_worse(before: Explanation, after: Explanation) -> bool:
    """Whether ``after`` predicts recordings that are left out in turn worse than ``before``.

    Left out are those that move no further than the others: a prediction that extrapolates decides nothing. False where
    there is none.
    """
    inside = within_the_others(before.measured)
    if not inside:
        return False
    one, other = (np.mean([error_left_out(e, r) ** 2 for r in inside]) for e in (before, after))
    return bool(np.sqrt(other) > WORSE * np.sqrt(one))


def within_the_others(measured: Measured) -> list[int]:
    """Recordings whose leading channel goes no further than that of one of the others."""
    lead = measured.channels[measured.lead]
    peaks = [float(np.max(np.abs(r.channels[lead]))) for r in measured.recordings]
    compared = set(measured.recording_of.tolist())
    others = {r: [peaks[k] for k in compared - {r}] for r in sorted(compared)}
    return [r for r, of in others.items() if of and peaks[r] <= BEYOND * max(of)]


def error_left_out(explanation: Explanation, recording: int) -> float:
    """Rms of the error over the rms of a recording in its windows, channels alike, with all but it fitted to.

    The states of its windows are its own.
    """
    f, m = explanation.fitted, explanation.measured
    own = np.flatnonzero(m.recording_of == recording)
    others = np.flatnonzero(m.recording_of != recording)
    learned = fit(f.misfit.of_windows(others), f.u, f.states[others])
    alone = f.misfit.at_level(learned.misfit.level).of_windows(own)
    alone = replace(alone, unknowns=(), fixed={**f.misfit.fixed, **learned.values}, smooth=None)
    shown = fit(alone, np.zeros(0), f.states[own], ITERATIONS if f.states.shape[1] else 0)
    error = alone.predictor.predict([shown.point])[0] - m.values[own]
    rms = [np.sqrt(np.mean(m.recordings[recording].channels[c] ** 2)) for c in m.channels]
    relative = np.where(np.isfinite(error), error, np.inf) / np.maximum(rms, 1e-300)[:, None]
    return float(np.sqrt(np.mean(np.minimum(relative**2, 1.0)[m.mask[own]])))
