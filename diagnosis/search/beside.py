"""One more mechanism beside an explanation: which are worth a refit, and where these refits start."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.unknowns import clip
from diagnosis.search.candidates import Candidate
from diagnosis.search.found import MISSING, Search, adjusted, enough, explains_all, lost_in_a_window, within_reach
from diagnosis.search.refit import QUICK, Explanation, again, best_of, extend, from_starts, joined, reaching
from diagnosis.search.screen import Score, score
from models.base import FloatArray
from models.errors import InputError

WORTH = 4.0
"""Linearisation statistic under which a refit is not tried (the strongest FEWEST are tried all the same)."""
SHARE_OF_SECOND = 0.25
"""Of the strongest statistic: what a further mechanism must reach to be refitted."""
FEWEST_SECOND, SECOND_TRIES = 2, 6
HOPELESS = 8.0
"""Statistic under which a further mechanism does not extend a model that explains all windows, and one of many short
steps is not refitted."""
HEAVY = 5.0
"""Lane-steps of a trial, over those of most mechanisms, from which a mechanism counts as one of many short steps."""
APART = 3.0
"""Factor by which the shapes of two elements of a kind differ from those of one where both start."""
THOROUGH = 2
POOL_SHARE = 0.25
"""Singles whose gain is this share of the best one's are tried as parts of a pair."""


def worth_a_refit(scores: Sequence[Score], fewest: int, share: float) -> list[Score]:
    """Those whose statistic is worth it beside the strongest one's, and the ``fewest`` first in any case.

    But not those of many short steps where the statistic, which of them is a gain at values tried, leaves no hope.
    """
    largest = max((s.statistic for s in scores), default=0.0)
    least = max(WORTH, share * largest)
    hopeful = [s for s in scores if s.starts and not (s.statistic < HOPELESS and heavy(s, scores))]
    return [s for k, s in enumerate(hopeful) if k < fewest or s.statistic >= least]


def starts_of(entry: Score, scores: Sequence[Score]) -> tuple[FloatArray, ...]:
    """Where its refits start; from the better one alone where the kernel needs many short steps."""
    return entry.starts[:1] if heavy(entry, scores) else entry.starts


def heavy(entry: Score, scores: Sequence[Score]) -> bool:
    """Whether its kernel needs many short steps beside that of most mechanisms."""
    return bool(entry.work > HEAVY * float(np.median([s.work for s in scores])))


def seconds(found: Search, explanation: Explanation) -> list[Score]:
    """The screen of what may stand beside the effects of an explanation."""
    screen, others = linearise_about(explanation.fitted), joinable(found, explanation)
    return score(screen, others, found.not_tried, explains_all(explanation))


def joinable(found: Search, explanation: Explanation) -> list[Candidate]:
    """The candidates of other classes than the effects of an explanation, and further elements of one of them."""

    def joins(candidate: Candidate) -> bool:
        first = candidate.mechanism.beside
        if first:
            return first in explanation.names and candidate.name not in explanation.names
        return candidate.effect_class not in explanation.classes

    return [candidate for candidate in found.candidates if joins(candidate)]


def one_of_each(scores: Sequence[Score]) -> list[Score]:
    """The strongest variant of every mechanism before its others: laws at other joints, other orders."""
    first: dict[str, Score] = {}
    for entry in scores:
        first.setdefault(entry.candidate.name, entry)
    return list({entry.candidate: entry for entry in (*first.values(), *scores)}.values())


def extended(
    found: Search,
    explanation: Explanation,
    scores: Sequence[Score],
    widely: bool = False,
    but: Candidate | None = None,
    most: float = np.inf,
) -> list[Explanation]:
    """Refits with one more mechanism, ``but`` one that was tried, best first: the strongest of a screen beside it.

    Refits that promise no loss of ``most``, or to come near one that explains everything, are given up on the way.

    ``widely``: those that explain much alone too, from where they stand alone, and second elements of a kind, whatever
    their scores. A law that carries part of what another parameter carried so far (the yielding of a spring and its
    stiffness, one element of two) has no score there before both have moved.
    """
    if explains_all(explanation) and max((s.statistic for s in scores), default=0.0) < HOPELESS:
        return []
    fits: list[Explanation] = []
    worth = one_of_each(worth_a_refit(scores, FEWEST_SECOND + (but is not None), SHARE_OF_SECOND))
    tried = [entry for entry in worth if entry.candidate != but][:SECOND_TRIES]
    for entry in tried:
        if found.affordable(entry.candidate.name):
            ways = from_starts([explanation], entry.candidate, starts_of(entry, scores), most)
            if entry.candidate.mechanism.beside:
                ways.append(split(explanation, entry.candidate, most))
            fits.append(best_of(ways))
            most = min(most, enough(fits[-1:]))
    for element in _second_elements(scores) if widely else ():
        if element not in (but, *(entry.candidate for entry in tried)) and found.affordable(element.name):
            fits.append(split(explanation, element, most))
    for single in _strong_alone(found, explanation) if widely else ():
        if not found.affordable(*single.names):
            continue
        try:
            fits.append(joined(explanation, single, most))
        except InputError as refusal:  # it does not act together with an effect of the explanation
            found.not_tried.setdefault(single.names[0], str(refusal))
    fits.sort(key=adjusted)  # quick fits that have not ended may promise to reach what they are to reach
    fits = [e if k >= THOROUGH or _may_reach(e, most) else reaching(e, most) for k, e in enumerate(fits)]
    fits.sort(key=adjusted)
    taken = [(k < THOROUGH and within_reach(e, fits[0])) or lost_in_a_window(e, fits[0]) for k, e in enumerate(fits)]
    return [again(e) if goes_on and _may_reach(e, most) else e for e, goes_on in zip(fits, taken, strict=True)]


def _may_reach(explanation: Explanation, most: float) -> bool:
    """Whether its loss is less than ``most`` but for the worst window, whose motion may have lost its way."""
    return explanation.loss - float(explanation.fitted.window_losses.max(initial=0.0)) < most


def _second_elements(scores: Sequence[Score]) -> list[Candidate]:
    """Of each kind that a screen holds, the one that scores highest."""
    return list({s.candidate.name: s.candidate for s in reversed(scores) if s.candidate.mechanism.beside}.values())


def split(explanation: Explanation, candidate: Candidate, most: float = np.inf) -> Explanation:
    """Fit with the element that a further one stands beside split in two: half of it each, the shapes moved apart."""
    f = explanation.fitted
    first = next(c for c in explanation.candidates if c.name == candidate.mechanism.beside)
    names, u = [x.name for x in f.misfit.unknowns], f.u.copy()
    start = candidate.null
    for k, (own, new) in enumerate(zip(first.unknowns, candidate.unknowns, strict=True)):
        at = names.index(own.name)
        if k == 0:
            u[at] = start[0] = 0.5 * (f.u[at] + start[0])
        else:
            value = own.value(float(f.u[at]))
            u[at], start[k] = own.coordinate(value / APART), new.coordinate(value * APART)
    apart = replace(explanation, fitted=replace(f, u=clip(f.misfit.unknowns, u)))
    return extend(apart, candidate, clip(candidate.unknowns, start), QUICK, most)


def _strong_alone(found: Search, explanation: Explanation) -> list[Explanation]:
    """The best single of each mechanism of another class that explained much under the base model's errors."""
    start = found if found.at_null is None else found.at_null
    singles = sorted(start.singles, key=adjusted)
    least = max((POOL_SHARE * start.gain(single) for single in singles[:1]), default=0.0)
    best: dict[str, Explanation] = {}
    for single in singles:
        if single.classes[0] not in explanation.classes and start.gain(single) >= max(MISSING, least):
            best.setdefault(single.names[0], single)
    return list(best.values())[:SECOND_TRIES]
