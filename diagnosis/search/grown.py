"""What was found, in windows that grow with it.

Where neighbouring trajectories part within a window, those of the base fit last as long as the base model can follow
(`diagnosis.fit.growing`), which is short where much is missing. The model with what was found follows further, and in
windows that grow with it more is left over of a law that is not the right one, or of a second effect.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.errors.followed import followed
from diagnosis.errors.model import disturbance_about, refitted
from diagnosis.fit.growing import fit_followed
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.setup import with_noise_of_the_base
from diagnosis.fit.starts import Origin
from diagnosis.fit.whitening import sensor_noise_only
from diagnosis.progress import Progress
from diagnosis.search.candidates import Candidate
from diagnosis.search.details import least
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation, again, without
from diagnosis.search.select import further_effects


def grown(found: Search, whole: Measured, keep: bool = True) -> Search:
    """The search with what it has found fitted anew, and its errors, in windows of ``whole`` as far as it follows.

    ``keep``: those that it was found in stay as long as they are.
    """
    chosen = found.chosen
    misfit, fitted = chosen.fitted.misfit, chosen.fitted
    predictor = replace(misfit.predictor, measured=whole)
    plain = Misfit(predictor, sensor_noise_only(predictor), misfit.unknowns, misfit.fixed)
    place = {(w.recording, w.first): k for k, w in enumerate(whole.windows)}
    own = [place[w.recording, w.first] for w in fitted.measured.windows]
    states, samples = whole.states.copy(), np.zeros(len(whole.windows), np.intp)
    states[own] = fitted.states
    if keep:
        samples[own] = [w.samples for w in fitted.measured.windows]
    origin = Origin(fitted.u, states, np.ones(len(misfit.unknowns), bool))
    first = followed(with_noise_of_the_base(fit_followed(plain, [origin], known=samples)))
    chosen_again, errors = refitted(first, disturbance_about(first))
    return replace(found, best=replace(chosen, fitted=chosen_again), errors=errors, about=None)


def beside_in_grown_windows(found: Search, whole: Measured, progress: Progress) -> Iterator[Search]:
    """Yields the search with a further effect that windows of ``whole`` ask for as they grow with what was found.

    If there is none, what was found in them is left in `Search.longer`.
    """
    if not whole.parts_quickly or found.best is None or found.best.in_spell:
        return
    progress("letting windows grow with what was found", 0.83)
    found.longer = longer = grown(found, whole)
    if not longer.tested(longer.chosen).flags(least(found, found.chosen)):
        return
    for stage in further_effects(_begun_anew(found, longer), progress):
        longer = stage
    if len(longer.chosen.candidates) > len(found.best.candidates):
        yield longer


def _begun_anew(found: Search, longer: Search) -> Search:
    """The search with the base model, and the effects one at a time, in the windows of what was found."""
    best = longer.chosen
    singles = [_only(best, candidate) for candidate in best.candidates]
    return replace(
        longer, base=again(_only(best)), singles=singles, tried=[best, *singles], at_null=None, outside=None,
        shorter=found, passed_over=set(), exchanged=set(), cut=set(), alike=set(),
    )  # fmt: skip


def _only(best: Explanation, *kept: Candidate) -> Explanation:
    """Fit with only some of its effects."""
    for candidate in best.candidates:
        if candidate not in kept:
            best = without(best, candidate)
    return best
