"""What a search has found, and what counts in it: gains, thresholds, adequacy, rivals.

An effect counts when its gain in 2 log likelihood passes the threshold and still does without
the window that weighs most (and, with more than two recordings, without any one of them),
or when it alone makes that window fit (`settles`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field, replace
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.stats import chi2

from diagnosis.data.measured import Measured
from diagnosis.errors.adequacy import errs
from diagnosis.errors.model import Errors
from diagnosis.fit.linearisation import Linearisation
from diagnosis.fit.solver import Fitted
from diagnosis.fit.whitening import sensor_noise_only
from diagnosis.forces.constancy import About, Constancy
from diagnosis.search.budget import ENDED, FURTHER, SEARCH, Budget
from diagnosis.search.candidates import Candidate
from diagnosis.search.null import Null
from diagnosis.search.refit import Explanation, from_other, gain_by_window
from diagnosis.search.screen import Score
from models.base import FloatArray

MISSING = 15.0
"""Gain in 2 log likelihood that one more mechanism must bring."""
DETAIL = 0.0025
"""Share of the evidence that the details of a named effect's law may leave: 5 % of its amplitude; MISSING at most."""
GAP = 10.0
"""Rivals: all within this gain of the best."""
BEHIND = 100.0
"""Loss behind what explains everything from which an explanation is not taken further: ten times what rivals have."""
PER_SHAPE = 2.0
"""What every unknown beyond the first costs a mechanism."""
ADEQUATE = 1.08
"""Misfit per sample under which an explanation is adequate."""
BY_CHANCE = 1e-6
"""Of drifts as far from zero as they are found, under which they hold more than a sensor's."""
ALONE, SETTLED, BADLY = 4.0, 1.3, 3.0
"""When one window may decide: its gain in thresholds, its misfit per sample with the mechanism and without."""
STUCK = 1.0
"""Gain by which a fit has left the valley in which it was."""


@dataclass(frozen=True)
class WhiteScreen:
    """The screen of some mechanisms about a fit, and under errors of which only those of the base motion count."""

    of: Fitted
    errors: Errors
    candidates: frozenset[Candidate]
    screen: Linearisation
    scores: list[Score]


class LeftOut(NamedTuple):
    """The best model with one effect left out, and what the effect gains over it and errors estimated with it."""

    rest: Explanation
    gain: float


class Doubted(NamedTuple):
    """A weak effect that is not told, its evidence, and what that rests on (`diagnosis.answer.unconfirmed`)."""

    explanation: Explanation
    gain: float
    rests_on: str


@dataclass
class Search:
    """What has been found so far; it grows, so that a stopped search leaves its state."""

    base: Explanation
    candidates: tuple[Candidate, ...]
    errors: Errors
    """Of the recordings, about the base model or about the best one found."""
    scores: list[Score] = field(default_factory=list)
    null: Null | None = None
    singles: list[Explanation] = field(default_factory=list)
    tried: list[Explanation] = field(default_factory=list)
    best: Explanation | None = None
    passed_over: set[frozenset[Candidate]] = field(default_factory=set)
    """What is likelier than what was taken and does not count: it rests on one window, or is a detail of a law."""
    exchanged: set[frozenset[Candidate]] = field(default_factory=set)
    """The mechanisms beside which others were tried in the place of one, under the errors as they are."""
    cut: set[frozenset[Candidate]] = field(default_factory=set)
    """Beside which not all others were tried, for the budget ended."""
    recentred: set[frozenset[Candidate]] = field(default_factory=set)
    """Pairs each of whose effects was led from the middle of the ranges, with others beside it."""
    alike: set[frozenset[Candidate]] = field(default_factory=set)
    """Effects that stood together, and what was tried for being easily taken for one (`diagnosis.search.alike`)."""
    weighed: Explanation | None = None
    """That with which the errors were estimated."""
    at_null: Search | None = None
    """This search as it stood under the errors of the base model, once they were estimated anew."""
    marginal: float = 0.0
    """Evidence of a single that hid in the errors, the variances estimated with it (`diagnosis.search.hidden`)."""
    not_tried: dict[str, str] = field(default_factory=dict)
    """By mechanism: why the model refused it, or that the budget ended."""
    budget: Budget = field(default_factory=Budget)
    whole: Budget = field(default_factory=partial(Budget, SEARCH))
    """Of all searches of an answer together."""
    outside: Constancy | None = None
    """A force outside the library that explains what the best single leaves."""
    struck: Constancy | None = None
    """A force that acts for a moment, too short to say which, seen when the search had not ended (`blow`)."""
    begun: Search | None = None
    """This search with one effect that begins or ends, that leaves something unexplained."""
    longer: Search | None = None
    """What was found, in windows that have grown with it (`diagnosis.search.grown`)."""
    shorter: Search | None = None
    """The search that this one goes on from in longer windows: its screen and singles are of all mechanisms."""
    strongest_law: tuple[Explanation, float] | None = None
    """Of an explanation of several effects, with the evidence of its strongest law (`diagnosis.search.details`)."""
    about: About | None = None
    """What was tested last for constancy."""
    white: WhiteScreen | None = None
    """The last screen against white noise (`diagnosis.search.white_screen`)."""
    left_out: tuple[Explanation, Errors, list[LeftOut]] | None = None
    """Of an explanation under some errors, each of its effects left out (`diagnosis.search.evidence`)."""
    doubted: Doubted | None = None
    """What was found and is not told, for it makes recordings held out less likely."""

    @property
    def measured(self) -> Measured:
        return self.base.measured

    @property
    def chosen(self) -> Explanation:
        return self.base if self.best is None else self.best

    @property
    def incomplete(self) -> bool:
        """Whether what stands leaves more than noise: in its misfit, or in a smooth error that the errors then hold."""
        return not adequate(self.chosen) or errs(self.errors)

    @property
    def explained(self) -> float:
        """Share that what stands explains of what the base model leaves beyond noise."""
        gain = max(self.base.loss - self.chosen.loss, 1e-9)
        return gain / max(self.base.loss - self.base.fitted.misfit.of_noise, gain)

    @property
    def more(self) -> float:
        """What a further effect, or a departure from constancy, must bring."""
        return MISSING + min(DETAIL * max(self.gain(self.chosen), 0.0), MISSING)

    @property
    def blow(self) -> Constancy | None:
        """A force that acts for a moment, unless what stands explains every window without one."""
        return None if self.struck is None or explains_all(self.chosen) else self.struck

    def tested(self, explanation: Explanation) -> About:
        """The tests for constancy of an explanation under the errors as they are."""
        known = self.about
        if known is None or known.forces.fitted is not explanation.fitted or known.errors is not self.errors:
            self.about = known = About.of(explanation.fitted, self.errors)
        return known

    @property
    def spare(self) -> float:
        """Seconds of work that may be done before further effects are looked for, which need theirs."""
        return self.whole.left - FURTHER

    @property
    def spent(self) -> bool:
        """Whether a budget has ended."""
        return self.budget.spent or self.whole.spent

    @property
    def weighed_elsewhere(self) -> bool:
        """Whether the errors were estimated with other mechanisms than the best, or in a valley that it has left."""
        best, weighed = self.best, self.weighed
        if best is None or weighed is None:
            return best is not None
        return best.candidates != weighed.candidates or best.loss < weighed.loss - STUCK

    def affordable(self, *names: str) -> bool:
        """Whether the budgets last; if not, that these mechanisms or stages were not tried (further) is noted."""
        if self.spent:
            for name in names:
                self.not_tried.setdefault(name, ENDED)
        return not self.spent

    @contextmanager
    def work_of_its_own(self, most: float, beyond: bool = False) -> Iterator[None]:
        """Within, the budget is ``most`` s; what is spent there is not taken off the budget outside.

        ``beyond``: even if that of all searches has ended.
        """
        outer, whole, own = self.budget, self.whole, Budget(most)
        self.budget, self.whole = own, own if beyond else whole
        try:
            yield
        finally:
            self.budget, self.whole = outer.after(own), whole

    def at_least(self, work: float) -> AbstractContextManager[None]:
        """Within, the budget is what is left of it, and ``work`` s of its own where that is less."""
        enough = min(self.budget.left, self.whole.left) >= work
        return nullcontext() if enough else self.work_of_its_own(work, beyond=True)

    def pass_over(self, explanation: Explanation) -> None:
        """It does not count, and is not taken later either."""
        self.passed_over.add(frozenset(explanation.candidates))

    def eligible(self, explanation: Explanation) -> bool:
        """Whether it may be taken: it was not passed over."""
        return frozenset(explanation.candidates) not in self.passed_over

    def gain(self, explanation: Explanation) -> float:
        """Gain over the base, less what shape parameters cost."""
        return self.base.loss - adjusted(explanation)


def adjusted(explanation: Explanation) -> float:
    """Loss plus what the choice of its mechanisms' details costs."""
    return explanation.loss + sum(price(c) for c in explanation.candidates)


def price(candidate: Candidate) -> float:
    """Of parameters beyond the first, chosen ones (an order) included, and of the time in which it acts."""
    return PER_SHAPE * (len(candidate.unknowns) - 1 + len(candidate.held)) + candidate.price


def survives(before: Explanation, after: Explanation, threshold: float = MISSING) -> bool:
    """Whether the gain passes without its most influential window and, of more than two, any one recording.

    What does not always act may rest on one recording, never on one window.
    """
    gains = gain_by_window(before, after)
    total = before.loss - adjusted(after) + (adjusted(before) - before.loss)
    largest = float(gains.max(initial=0.0))
    if total - largest < threshold:
        return (
            not after.in_spell
            and largest >= ALONE * threshold
            and total - largest > -threshold
            and settles(before, after)
        )
    measured = after.measured
    moving = np.unique(measured.recording_of)
    if moving.size > 2 and not after.in_spell:
        each = [float(gains[measured.recording_of == r].sum()) for r in moving]
        return total - max(each) >= 0.3 * threshold
    return True


def settles(before: Explanation, after: Explanation) -> bool:
    """Whether one window, rightly fitted, decides: a peak that was clipped may be the only one.

    The window with the largest gain fits to the noise with the mechanism, and badly without it even from
    the states found with it: it was not stuck.
    """
    window = int(np.argmax(gain_by_window(before, after)))
    alone = from_other(before, after)
    return bool(by_window(after)[window] < SETTLED and by_window(alone)[window] > BADLY)


def by_window(explanation: Explanation) -> FloatArray:
    """Squared whitened residual per sample of each window (W,)."""
    misfit = explanation.fitted.misfit
    residual = misfit.residuals([explanation.fitted.point])[0]
    return np.asarray(np.sum(residual**2, axis=1) / misfit.measured.count)


def misfit_per_sample(explanation: Explanation) -> float:
    """Squared whitened residual per sample, without the worst tenth (at least one) of the windows."""
    each = np.sort(by_window(explanation))
    return float(np.mean(each[: max(1, int(0.9 * each.size))]))


def over_white_noise(explanation: Explanation, errors: Errors) -> Explanation:
    """The same fit with white noise of the sensors and the noise of the base motion as its only errors."""
    fitted = explanation.fitted
    white = sensor_noise_only(fitted.misfit.predictor).with_columns(errors.base)
    return replace(explanation, fitted=replace(fitted, misfit=replace(fitted.misfit, whitening=white)))


def left_over_white_noise(explanation: Explanation, errors: Errors) -> float:
    """Misfit per sample over the white noise of the sensors and that of the base motion alone."""
    return misfit_per_sample(over_white_noise(explanation, errors))


def passes_for_white(explanation: Explanation, errors: Errors) -> bool:
    """Whether white noise explains what is left in every window: other errors then hold nothing that is missing."""
    return explains_all(over_white_noise(explanation, errors))


def strained(explanation: Explanation) -> bool:
    """Whether drifts that windows share lie where they hardly would by chance: they hold what a model lacks."""
    level = explanation.fitted.misfit.level
    return bool(level.size) and bool(chi2.sf(level @ level, level.size) < BY_CHANCE)


def adequate(explanation: Explanation) -> bool:
    """Whether the misfit is that of the noise, and drifts are what the errors say of them."""
    return misfit_per_sample(explanation) < ADEQUATE and not strained(explanation)


def explains_all(explanation: Explanation) -> bool:
    """Whether no window is badly off either: a peak that was clipped may be the only one."""
    return adequate(explanation) and bool(np.max(by_window(explanation)) < BADLY)


def enough(known: Iterable[Explanation]) -> float:
    """Loss from which another is no rival of those that are known to explain everything; infinite where none does.

    And where whole runs are compared: their fits creep, and what stands tells little of where they end.
    """
    in_windows = (one for one in known if one.measured.stretches is None)
    return min((adjusted(one) for one in in_windows if explains_all(one)), default=np.inf) + BEHIND


def within_reach(explanation: Explanation, leader: Explanation) -> bool:
    """Whether it may still turn out better than a ``leader`` that explains everything: it is not `BEHIND` that."""
    loss = adjusted(explanation)
    return loss < adjusted(leader) + BEHIND or loss < enough([leader])


def lost_in_a_window(explanation: Explanation, leader: Explanation) -> bool:
    """Whether it is out of reach of a ``leader`` that explains everything by one window alone.

    The motion of a window may have lost its way, to one with other events, and the parameters with it.
    """
    if within_reach(explanation, leader):
        return False
    furthest = float(np.max(gain_by_window(explanation, leader)))
    return adjusted(explanation) - furthest < enough([leader])


class Near(NamedTuple):
    """An explanation with one effect exchanged, within the gap: ``candidate`` in the place of those ``replaced``."""

    explanation: Explanation
    candidate: Candidate
    gap: float
    replaced: tuple[str, ...]


def rivals(found: Search) -> list[Near]:
    """Explanations with one effect exchanged, the nearest first.

    And with one more than others that are rivals already: beside a delay in the place of a filter, say, what stands in
    the place of the other effect.
    """
    if found.best is None:
        return []
    best, near = found.best, []
    places = {name: {name} for name in best.names}
    alike = [e for e in found.tried if len(e.candidates) == len(best.candidates)]
    for most in range(1, len(best.candidates) + 1):
        for other in sorted(alike, key=adjusted):
            gap = adjusted(other) - adjusted(best)
            new = [c for c in other.candidates if c.name not in places]
            if gap > GAP or len(new) != 1 or len(set(other.names) - set(best.names)) != most:
                continue
            standing = set().union(*(places[name] for name in other.names if name in places))
            gone = tuple(name for name in best.names if name not in other.names)
            replaced = tuple(name for name in gone if name not in standing) or gone
            places[new[0].name] = set(replaced)
            near.append(Near(other, new[0], max(gap, 0.0), replaced))
    return sorted(near, key=lambda one: one.gap)
