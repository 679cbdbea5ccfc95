"""Parametric bootstrap of the p-value: recordings made by the fitted base model, searched the same way.

Each draw is the base model's windows plus errors as estimated (`diagnosis.errors.draws`), and passes through the whole
chain: base fit, errors estimated anew, search. The gains that a short search brings are compared with the gain that
the same search brings on the recordings. Beyond the draws' upper quarter the tail is that of lambda chi-squared
with one degree of freedom, lambda from the mean excess over the quarter's start v lambda:

    mean excess = lambda [ Q_3(v)/Q_1(v) - v ],      Q_k(v) = P(chi2_k > v).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq
from scipy.stats import chi2

from diagnosis.errors.draws import draw, scattered
from diagnosis.errors.model import Errors, refitted
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.solver import Fitted, fit
from diagnosis.fit.starts import start_of
from diagnosis.progress import Progress
from diagnosis.search.candidates import candidates
from diagnosis.search.found import MISSING, Search, adjusted
from diagnosis.search.null import LEAST_P
from diagnosis.search.refit import Explanation, extend
from diagnosis.search.screen import score
from diagnosis.search.singles import FEWEST
from grids.specimen import Specimen
from models.base import FloatArray
from models.errors import InputError

TAIL = 0.25
FEWEST_FOR_A_TAIL = 20
FARTHEST = 600.0
"""v, beyond which Q underflows."""


def p_value(specimen: Specimen, found: Search, draws: int, seed: int, progress: Progress) -> float:
    """Probability of a gain at least as large as that of the recordings if nothing is missing.

    Raises InputError where something was found and the short search finds nothing, as what begins or ends or what the
    errors hide: its gains are not those of the answer.
    """
    start = found if found.at_null is None else found.at_null
    base, errors = start.base.fitted, start.errors
    predictor, m = base.misfit.predictor, base.measured
    rng = np.random.default_rng(seed)
    progress("bootstrap: the recordings", 0.9)
    observed = gain(specimen, base, errors)
    if found.best is not None and observed < MISSING:
        raise InputError("its search of one effect that always acts does not find what was found")
    drawn = []
    for turn in range(draws):
        progress(f"bootstrap {turn + 1} of {draws}", 0.9)
        values = scattered(errors, base, rng) + draw(errors, m, rng)
        made = replace(m, values=np.where(m.mask, values, 0.0), as_it_was=None)
        misfit = replace(base.misfit, predictor=replace(predictor, measured=made))
        drawn.append(gain(specimen, replace(base, misfit=misfit), errors))
    return tail_probability(observed, np.array(drawn))


def gain(specimen: Specimen, base: Fitted, errors: Errors) -> float:
    """What the best of the strongest mechanisms of a screen takes off the base model's loss, errors estimated anew."""
    first = fit(base.misfit, start_of(base.misfit.unknowns), base.states)
    fitted, _ = refitted(first, errors.base, errors)
    explained = Explanation((), fitted)
    scores = score(linearise_about(fitted), candidates(fitted.measured, specimen))
    fits = [extend(explained, entry.candidate, start) for entry in scores[:FEWEST] for start in entry.starts]
    return max([0.0, *(explained.loss - adjusted(each) for each in fits)])


def tail_probability(observed: float, drawn: FloatArray) -> float:
    """(1 + draws as large)/(1 + draws), or less where the tail of the draws says so."""
    counted = (1.0 + np.sum(drawn >= observed)) / (1.0 + drawn.size)
    start = float(np.quantile(drawn, 1.0 - TAIL))
    beyond = drawn[drawn > start] - start
    if drawn.size < FEWEST_FOR_A_TAIL or observed <= start or beyond.size == 0:
        return float(counted)
    mean = float(beyond.mean())

    def excess(scale: float) -> float:
        v = start / scale
        return float(scale * (chi2.sf(v, 3) / chi2.sf(v, 1) - v)) - mean

    low = max(0.3 * mean, start / FARTHEST)  # the factor of lambda is 1 at v = 0 and grows to 2
    scale = brentq(excess, low, mean) if excess(low) < 0.0 else low
    tail = chi2.sf(observed / scale, 1) / chi2.sf(start / scale, 1)
    return float(max(LEAST_P, beyond.size / drawn.size * tail))
