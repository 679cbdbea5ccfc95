"""Errors estimated anew with what was found, and what they make of the evidence.

Until an effect is in, the errors hold part of what it does: scatter of events a wrong law of them, for instance. So
gains under the base model's errors are bounded. They name the effect and say how sure it is; everything after that
(further effects, rivals, constancy, intervals) stands under the errors estimated with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from diagnosis.errors.adequacy import errs
from diagnosis.errors.model import Errors, estimate, fit_under, refitted
from diagnosis.fit.solver import Fitted, fit
from diagnosis.fit.whitening import sensor_noise_only
from diagnosis.search.budget import Budget
from diagnosis.search.candidates import Candidate
from diagnosis.search.found import STUCK, Search, adjusted, enough, passes_for_white, within_reach
from diagnosis.search.refit import Explanation, best_of, from_states_of, further, ways
from models.base import FloatArray

NEAR, OWN = 0.3, 0.4
"""Share of the leader's gain from which an explanation is taken along, and from which its own errors are estimated."""
ASTRAY = 0.2
"""Share of the best gain so far from which a mechanism alone is fitted against white noise too."""
MOST, MOST_OWN, ALIKE = 6, 4, 2
"""Explanations weighed, those of them with errors of their own, and of these that differ in joints or orders only."""
TURNS = 2
AHEAD = 3.0
"""Times what the states of others gain an explanation under its errors that it is trusted to gain under new ones."""
CLOSE = 30.0
"""Gain from the best within which an explanation is fitted under errors of its own, and led by others, and which a
refit in the place of an effect must promise: three times what rivals have."""


def reweighed(explanation: Explanation, errors: Errors) -> Explanation:
    """The explanation refitted under these errors, about the events as these have them or without."""
    f = explanation.fitted
    weighed = replace(explanation, fitted=replace(f, misfit=errors.on(f.misfit)))
    return best_of([further(way) for way in ways(weighed)])


def as_white_noise(fitted: Fitted, errors: Errors) -> Fitted:
    """The fit as if the sensors' errors were white, beside those of the base motion."""
    white = sensor_noise_only(fitted.misfit.predictor).with_columns(errors.base)
    return fit(replace(fitted.misfit, whitening=white), fitted.u, fitted.states)


def by_white_noise(explanation: Explanation, errors: Errors) -> Explanation:
    """The explanation refitted as if the sensors' errors were white, then under these errors, if that is better.

    Errors that hold part of an effect make its valley flat; white noise leads into it. Where white noise explains all
    that is left they hold nothing, and it stays as it is.
    """
    if passes_for_white(explanation, errors):
        return explanation
    f, led = explanation.fitted, as_white_noise(explanation.fitted, errors)
    back = replace(explanation, fitted=fit(f.misfit, led.u, led.states))
    return min(explanation, back, key=lambda e: e.loss)


def add_single(found: Search, fits: Sequence[Explanation], most: float) -> float:
    """Add the best of some fits to the singles, `by_white_noise` too where its loss is less than ``most``.

    Not where it explains little beside the best of them; a fit that is worse than the base model is stuck, and white
    noise may free it. The loss that the next must promise.
    """
    single = best_of(fits)
    gain, best = found.base.loss - single.loss, found.base.loss - min((e.loss for e in found.singles), default=np.inf)
    if single.loss < most and not 0.0 < gain < ASTRAY * best:
        single = by_white_noise(single, found.errors)
    found.singles.append(single)
    return min(most, enough([single]))


class Judged(NamedTuple):
    """An explanation and errors of its own; ``loss``: of these, with its price."""

    loss: float
    explanation: Explanation
    errors: Errors

    @classmethod
    def of(cls, explanation: Explanation, before: Errors) -> Judged:
        """Its errors estimated once more after a fit under the first estimate of them."""
        first = estimate(explanation.fitted, before.base, before)
        fitted, errors = fit_under(explanation.fitted, first)
        errors = estimate(fitted, before.base, errors)
        price = adjusted(explanation) - explanation.loss
        return cls(errors.loss + price, replace(explanation, fitted=fitted), errors)

    def fitted_under(self) -> Judged:
        """The same fitted under its errors."""
        fitted, errors = fit_under(self.explanation.fitted, self.errors)
        return Judged(self.loss - self.errors.loss + errors.loss, replace(self.explanation, fitted=fitted), errors)


def led_by_each_other(judged: Sequence[Judged], base: FloatArray, budget: Budget) -> list[Judged]:
    """The same, each from the states of the others where some windows fit better from there, and once more from those.

    Two models of which one is stuck in windows would else be told apart by that.
    """
    led = list(judged)
    for _ in range(TURNS):
        moved, least = False, min(one.loss for one in led)
        for k, one in enumerate(led):
            if budget.spent:
                return led
            others = [other.explanation for i, other in enumerate(led) if i != k]
            explanation = from_states_of(one.explanation, others)
            gain = one.explanation.loss - explanation.loss
            if gain <= STUCK or one.loss - AHEAD * gain > least + CLOSE:
                continue
            fitted, errors = refitted(explanation.fitted, base, one.errors)
            if (loss := one.loss - one.errors.loss + errors.loss) < one.loss:
                led[k], moved = Judged(loss, replace(explanation, fitted=fitted), errors), True
        if not moved:
            break
    return led


def weigh_again(found: Search, most: float = np.inf) -> None:
    """Estimate the errors with each of the leading explanations in, and refit the others under those of the best.

    Which is best is told by their likelihoods, each under its own errors. ``most``: s of work that this is worth.
    """
    if found.best is None:
        return
    budget = Budget(min(most, found.whole.left))
    if found.at_null is None:
        found.at_null = replace(found)
    size = len(found.best.candidates)
    fewer = [adjusted(e) for e in (*found.singles, *found.tried) if len(e.candidates) == size - 1]
    before = min(fewer, default=found.base.loss)
    least = NEAR * (before - adjusted(found.best))
    holds = errs(found.errors)  # part of what is missing: under such errors nothing explains everything
    leading: dict[frozenset[Candidate], Explanation] = {}
    for explanation in sorted([found.best, *found.tried], key=adjusted):
        near_enough = before - adjusted(explanation) > least and (holds or within_reach(explanation, found.best))
        if len(explanation.candidates) == size and near_enough:
            leading.setdefault(frozenset(explanation.candidates), explanation)
    first: dict[frozenset[str], Explanation] = {}  # other orders, or other joints, of the same laws come last
    for explanation in leading.values():
        first.setdefault(frozenset(explanation.names), explanation)
    near = list({id(e): e for e in (*first.values(), *leading.values())}.values())[:MOST]
    if all(set(e.candidates) != set(found.best.candidates) for e in near):
        near.append(found.best)
    judged = _judged(near, before, found, budget)
    judged = led_by_each_other(judged, found.errors.base, budget)
    _, found.best, found.errors = min(judged, key=lambda one: one.loss)
    found.weighed = found.best
    found.base = reweighed(found.base, found.errors)
    others = [reweighed(e, found.errors) for e in near if e.candidates != found.best.candidates]
    others = [from_states_of(e, [found.best]) for e in others]
    found.tried = [found.best, *others]
    found.best = min([found.best, *filter(found.eligible, others)], key=adjusted)
    found.singles = sorted((e for e in found.tried if len(e.candidates) == 1), key=adjusted)


def _judged(near: Sequence[Explanation], before: float, found: Search, budget: Budget) -> list[Judged]:
    """The nearest under errors of their own; only those that come close to the best of them are fitted under these.

    ``before``: loss of the best with one effect less.
    """
    best = found.chosen
    judged: list[Judged] = []
    for explanation in near:
        if judged and budget.spent:
            break
        is_best = set(explanation.candidates) == set(best.candidates)
        alike = sum(set(one.explanation.names) == set(explanation.names) for one in judged)
        if len(judged) == MOST_OWN or not (is_best or (alike < ALIKE and found.eligible(explanation))):
            continue
        # what was passed over with one effect less may fit better than the best
        if is_best or before - adjusted(explanation) > OWN * (before - adjusted(best)):
            judged.append(Judged.of(explanation, found.errors))
    fitted: set[int] = set()
    while close := [k for k in range(len(judged)) if k not in fitted and _is_close(judged[k], judged)]:
        for k in close:
            judged[k] = judged[k].fitted_under()
        fitted.update(close)
    return judged


def _is_close(one: Judged, judged: Sequence[Judged]) -> bool:
    return one.loss < min(other.loss for other in judged) + CLOSE
