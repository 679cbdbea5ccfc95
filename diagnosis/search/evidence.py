"""The evidence of each effect of an answer; effects without any are dropped.

Errors estimated without an effect may hold what it does, as a drift holds a wrong zero: under those it explains
nothing. It counts all the same where the recordings are likelier with it, each model under errors of its own. Where
they are not, the errors explain as much as the effect, and it is not told.
"""

from __future__ import annotations

from diagnosis.errors.model import refitted
from diagnosis.search.candidates import Candidate
from diagnosis.search.found import MISSING, LeftOut, Search, adjusted
from diagnosis.search.refit import Explanation, without
from diagnosis.search.weighing import reweighed, weigh_again


def evidence(found: Search) -> list[float]:
    """Gain of each effect of the answer over the best model without it, the errors estimated without it."""
    best = found.best
    if best is None:
        return []
    if len(best.candidates) == 1:
        start = found if found.at_null is None else found.at_null
        if same := [e for e in start.tried if e.candidates == best.candidates]:
            # a fit that came later, in place of another effect, may have found what the first one had not
            losses = [e.loss for e in (*same, reweighed(best, start.errors))]
            return [max(found.marginal, start.base.loss - min(losses))]
    return [one.gain for one in _each_left_out(found, best)]


def drop_without_evidence(found: Search) -> None:
    """Drop effects of which the evidence is not that of an effect, the least evident first."""
    while (best := found.best) is not None and len(best.candidates) > 1:
        each = zip(best.candidates, _each_left_out(found, best), strict=True)
        least = min((one for c, one in each if c in best.removable), key=lambda one: one.gain)
        if least.gain >= MISSING:
            return
        found.best = least.rest
        found.tried.append(least.rest)
        weigh_again(found)  # the errors hold now what the effect was taken for


def _each_left_out(found: Search, best: Explanation) -> list[LeftOut]:
    known = found.left_out
    if known is None or known[0] is not best or known[1] is not found.errors:
        found.left_out = known = (best, found.errors, [_left_out(found, best, c) for c in best.candidates])
    return known[2]


def _left_out(found: Search, best: Explanation, candidate: Candidate) -> LeftOut:
    """Its gain under the errors of the model without it or, if that is more, with errors of each."""
    rest = without(best, candidate)
    fitted, errors = refitted(rest.fitted, found.errors.base, found.errors)
    under = fitted.loss - reweighed(best, errors).loss
    each = errors.loss + adjusted(rest) - rest.loss - (found.errors.loss + adjusted(best) - best.loss)
    return LeftOut(rest, max(under, each, 0.0))
