"""Refitting a model with mechanisms switched on, and moving between fits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.fit.memory import counted
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.solver import ITERATIONS, Fitted, fit, fit_thoroughly, from_states
from diagnosis.fit.starts import Origin, nominal, searched
from diagnosis.search.candidates import Candidate
from diagnosis.search.spells import in_spell
from models.base import FloatArray

RECOUNTS = 8
SHAPES, QUICK = 5, 6
"""Values of a shape tried anew, and the iterations of each."""
BETWEEN_STARTS = 30.0
"""What a refit from another start may promise to end behind the best before it."""
TURNS, STAYS = 4, 0.5
"""How often a fit goes on at most, and the gain under which its loss stays."""
SOON = 0.2
"""Of what a fit has to go, what some iterations must bring for the next."""


@dataclass(frozen=True)
class Explanation:
    """A fit with some mechanisms switched on; none for the base model."""

    candidates: tuple[Candidate, ...]
    fitted: Fitted

    @property
    def loss(self) -> float:
        return self.fitted.loss

    @property
    def measured(self) -> Measured:
        return self.fitted.measured

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(c.name for c in self.candidates)

    @property
    def classes(self) -> tuple[str, ...]:
        return tuple(c.effect_class for c in self.candidates)

    @property
    def in_spell(self) -> bool:
        """Whether an effect does not act always."""
        return any(c.spell is not None for c in self.candidates)

    @property
    def removable(self) -> tuple[Candidate, ...]:
        """The candidates beside which no further element of their kind stands."""
        firsts = {c.mechanism.beside for c in self.candidates}
        return tuple(c for c in self.candidates if c.name not in firsts)

    def part(self, candidate: Candidate) -> FloatArray:
        """Fitted coordinates of one of the candidates."""
        names = [x.name for x in self.fitted.misfit.unknowns]
        return np.array([self.fitted.u[names.index(x.name)] for x in candidate.unknowns])


def extend(
    explanation: Explanation,
    candidate: Candidate,
    start: FloatArray,
    iterations: int = ITERATIONS,
    most: float = np.inf,
) -> Explanation:
    """Fit with one more mechanism, from the explanation's optimum and the candidate's ``start``; the best of `ways`.

    Given up on the way where it promises no loss of ``most``.
    """
    base = explanation.fitted
    misfit = replace(
        in_spell(base.misfit, candidate.name, candidate.spell),
        unknowns=(*base.misfit.unknowns, *candidate.unknowns),
        fixed={**base.misfit.fixed, **candidate.held},
    )
    grown = Explanation(
        (*explanation.candidates, candidate), replace(base, misfit=misfit, u=np.concatenate([base.u, start]))
    )
    return best_of([further(way, iterations, most) for way in ways(grown)])


def from_starts(
    explanations: Sequence[Explanation], candidate: Candidate, starts: Sequence[FloatArray], most: float = np.inf
) -> list[Explanation]:
    """Quick fits of the ``explanations`` with one more mechanism, from each of its ``starts``.

    Given up on the way where one promises no loss of ``most``, or to end far behind the best before it.
    """
    fits: list[Explanation] = []
    for explanation, start in product(explanations, starts):
        near = min((fitted.loss + BETWEEN_STARTS for fitted in fits), default=most)
        fits.append(extend(explanation, candidate, start, QUICK, min(near, most)))
    return fits


def ways(explanation: Explanation) -> list[Explanation]:
    """About the motion with the events as they were, and without what they were: that may stand for a mechanism."""
    f = explanation.fitted
    if f.measured.as_it_was is None:
        return [explanation]
    return [explanation, replace(explanation, fitted=replace(f, misfit=f.misfit.undisturbed))]


def as_declared(explanation: Explanation) -> Explanation:
    """The same model at the specimen's own numbers and the measured states, not fitted; a range at its middle.

    A fit that lacks something adjusts what it has, numbers to their bounds and states to other motions; that may be
    further from the truth than where it began.
    """
    misfit = explanation.fitted.misfit
    misfit = misfit.at_level(np.zeros_like(misfit.level))
    start = nominal(misfit)
    return replace(explanation, fitted=fit(misfit, start.u, start.states, 0))


def recentred(explanation: Explanation) -> Explanation:
    """The same with the numbers that have but a range at the middle of it, all else as it stands; not fitted."""
    f = explanation.fitted
    effects = {x.name for c in explanation.candidates for x in c.unknowns}
    each = zip(f.misfit.unknowns, f.u, nominal(f.misfit).u, strict=True)
    u = np.array([at if x.prior is not None or x.name in effects else middle for x, at, middle in each])
    return replace(explanation, fitted=fit(f.misfit, u, f.states, 0))


def further(explanation: Explanation, iterations: int = ITERATIONS, most: float = np.inf) -> Explanation:
    """The same model fitted from where it stands."""
    f = explanation.fitted
    return replace(explanation, fitted=fit(f.misfit, f.u, f.states, iterations, most))


def reaching(explanation: Explanation, most: float) -> Explanation:
    """The same model fitted further until its loss is ``most``, or as long as it promises to get there soon."""
    while explanation.loss >= most:
        before = explanation.loss
        explanation = further(explanation, most=most)
        if before - explanation.loss <= SOON * (explanation.loss - most):
            break
    return explanation


def joined(explanation: Explanation, single: Explanation, most: float = np.inf) -> Explanation:
    """Fit with the mechanism of a single as it stands alone; the base parameters from the better of both."""
    (candidate,) = single.candidates
    base, alone = explanation.fitted, single.fitted
    theirs = dict(zip((x.name for x in alone.misfit.unknowns), alone.u, strict=True))
    led = np.array([theirs.get(x.name, c) for x, c in zip(base.misfit.unknowns, base.u, strict=True)])
    ways = (explanation, replace(explanation, fitted=replace(base, u=led)))
    return best_of([extend(way, candidate, single.part(candidate), QUICK, most) for way in ways])


def without(explanation: Explanation, candidate: Candidate, iterations: int = ITERATIONS) -> Explanation:
    """Fit without one of the mechanisms, from the explanation's own optimum; with no iteration all else stays there."""
    base = explanation.fitted
    gone = {x.name for x in candidate.unknowns}
    keep = [i for i, x in enumerate(base.misfit.unknowns) if x.name not in gone]
    misfit = replace(
        in_spell(base.misfit, candidate.name, None),
        unknowns=tuple(base.misfit.unknowns[i] for i in keep),
        fixed={k: v for k, v in base.misfit.fixed.items() if k not in candidate.held},
        smooth=None if base.misfit.smooth is None else base.misfit.smooth[:, keep],
    )
    rest = tuple(c for c in explanation.candidates if c is not candidate)
    return Explanation(rest, fit(misfit, base.u[keep], base.states, iterations))


def again(explanation: Explanation) -> Explanation:
    """The same fit taken further from where it stands, stuck windows started again, until its loss stays.

    Where whole runs are compared a fit creeps, and each time it is taken further is enough.
    """
    f = explanation.fitted
    found = fit_thoroughly(f.misfit, f.u, f.states)
    for _ in range(TURNS if f.measured.stretches is None else 0):
        before, found = found.loss, fit(found.misfit, found.u, found.states)
        if before - found.loss < STAYS:
            break
    return replace(explanation, fitted=found)


def from_other(explanation: Explanation, other: Explanation, most: float = np.inf) -> Explanation:
    """The same model refitted from another one's base parameters and states (a cross restart).

    Given up where that promises no loss of ``most``.
    """
    misfit, u = explanation.fitted.misfit, _at_values_of(explanation, other)
    tried = Explanation(explanation.candidates, fit(misfit, u, other.fitted.states, most=most))
    return min((explanation, tried), key=lambda e: e.loss)


def in_the_place_of(single: Explanation, other: Explanation, most: float = np.inf) -> Explanation:
    """The same from the size of its effect, over its range, that fits best where another one ended.

    A fit that begins at a small effect may not reach a large one. What does nearly the same as the other's effect is
    near its own optimum there. Given up where that promises no loss of ``most``.
    """
    led = replace(single, fitted=replace(single.fitted, u=_at_values_of(single, other), states=other.fitted.states))
    tried = further(_at_best_size(led), most=most)
    return min((single, tried), key=lambda e: e.loss)


def beside_at_best_size(explanation: Explanation, candidate: Candidate, most: float = np.inf) -> Explanation:
    """Fit with one more mechanism, from the size that fits best where the explanation stands.

    Quick, and taken further as long as it promises a loss of ``most``.
    """
    begun = _at_best_size(extend(explanation, candidate, candidate.null, 0))
    return reaching(further(begun, QUICK, most), most)


def _at_best_size(explanation: Explanation) -> Explanation:
    """With the size of its last effect, over its range, that fits best with all else as it stands."""
    f, candidate = explanation.fitted, explanation.candidates[-1]
    names, trials = [x.name for x in f.misfit.unknowns], []
    own = [names.index(x.name) for x in candidate.unknowns]
    for size in candidate.grid():
        trials.append(f.u.copy())
        trials[-1][own] = size
    residuals = f.misfit.residuals([f.misfit.point(u, f.states) for u in trials])
    best = trials[int(np.argmin(f.misfit.losses(residuals).sum(axis=-1)))]
    return replace(explanation, fitted=replace(f, u=best))


def _at_values_of(explanation: Explanation, other: Explanation) -> FloatArray:
    """Coordinates of an explanation at another one's values of the parameters that both have."""
    mine, theirs = explanation.fitted, other.fitted.values
    each = zip(mine.misfit.unknowns, mine.u, strict=True)
    return np.array([x.coordinate(theirs[x.name]) if x.name in theirs else c for x, c in each])


def from_states_of(explanation: Explanation, others: Sequence[Explanation]) -> Explanation:
    """The same model refitted with the states of other models in windows that fit better from there.

    A window may hold several minima, which no misfit shows as long as none is bad; models that move nearly alike end
    in different ones.
    """
    f = explanation.fitted
    if not others or not f.states.size:
        return explanation
    starts = np.stack([other.fitted.states for other in others])
    states = from_states(f, np.arange(len(f.measured.windows)), starts)
    if states is None:
        return explanation
    return best_of([explanation, replace(explanation, fitted=fit(f.misfit, f.u, states))])


def over_ranges(explanation: Explanation) -> Explanation:
    """The best of this fit and of one from elsewhere in the ranges of the specimen's parameters; the effects stay.

    A model that lacks something goes astray in its ranges, layers to their softest and their dashpots to their
    strongest, and a fit with what it lacked ends in that valley.
    """
    fitted = explanation.fitted
    effects = {x.name for c in explanation.candidates for x in c.unknowns}
    known = np.array([x.prior is not None or x.name in effects for x in fitted.misfit.unknowns], bool)
    if known.all() or fitted.measured.stretches is not None:
        return explanation
    origins = [Origin(fitted.u, states, known) for states in (fitted.states, fitted.measured.states)]
    tried = again(replace(explanation, fitted=searched(fitted.misfit, origins)))
    return min((explanation, tried), key=lambda e: e.loss)


def reshaped(explanation: Explanation) -> Explanation:
    """The best of this fit and of fits from other shapes of its mechanisms, one shape at a time.

    Where a shape does nothing (a floor that is never reached, a gap never closed) its derivative is no guide.
    """
    fitted, tried = explanation.fitted, [explanation]
    shapes = {x.name for c in explanation.candidates for x in c.unknowns[1:]}
    for i, unknown in enumerate(fitted.misfit.unknowns):
        if unknown.name not in shapes:
            continue
        for at in np.linspace(*unknown.bounds, SHAPES + 2)[1:-1]:
            u = fitted.u.copy()
            u[i] = at
            tried.append(replace(explanation, fitted=fit(fitted.misfit, u, fitted.states, QUICK)))
    return best_of(tried)


def with_memory(explanation: Explanation) -> Explanation:
    """The same model refitted with the events before each window counted along its own motion, if that is better.

    Counts and parameters depend on each other: repeated until the loss stays, stuck windows started again. A model that
    remembers no events, or does not under these mechanisms, predicts the same however they are counted. Where whole
    runs are compared a fit creeps along its valley, and is taken further until the loss stays all the same.
    """
    fitted = explanation.fitted
    for _ in range(RECOUNTS):
        before, predictor, point = fitted.loss, fitted.misfit.predictor, fitted.point
        recounted = replace(predictor, measured=counted(predictor, point))
        if predictor.measured.stretches is None and _alike(recounted, predictor, point):
            break
        fitted = fit_thoroughly(replace(fitted.misfit, predictor=recounted), fitted.u, fitted.states)
        if abs(before - fitted.loss) < STAYS:
            break
    return replace(explanation, fitted=fitted) if fitted.loss < explanation.loss else explanation


def _alike(one: Predictor, other: Predictor, point: Point) -> bool:
    """Whether both predict the same at a point."""
    return one.measured is other.measured or np.array_equal(one.predict([point]), other.predict([point]))


def gain_by_window(before: Explanation, after: Explanation) -> FloatArray:
    """Gain in 2 log likelihood of each window (W,)."""
    return before.fitted.window_losses - after.fitted.window_losses


def best_of(explanations: Sequence[Explanation]) -> Explanation:
    return min(explanations, key=lambda e: e.loss)
