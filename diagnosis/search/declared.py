"""Pairs of effects from the specimen as it is declared, where no effect alone explains what is missing.

A fit that lacks much makes up for it with what it has: a stiffness of the layers twice what was declared, say. About
such numbers a screen ranks what fits them, and a fit of both missing effects ends beside them. So the screen is made
about the declared numbers and the measured motion; the strongest mechanisms stand at the sizes where it starts them,
unfitted, for alone they would lead the numbers away again; and each is screened and fitted with others beside it.

Where two effects were found about numbers that had gone astray, each is led from the middle of the ranges likewise.
"""

from __future__ import annotations

import numpy as np

from diagnosis.errors.model import Errors
from diagnosis.fit.linearisation import linearise_about
from diagnosis.progress import Progress
from diagnosis.search.beside import SHARE_OF_SECOND, one_of_each, seconds, starts_of, worth_a_refit
from diagnosis.search.candidates import firsts
from diagnosis.search.found import MISSING, Search, adjusted, left_over_white_noise, passes_for_white
from diagnosis.search.refit import (
    Explanation,
    again,
    as_declared,
    best_of,
    extend,
    from_starts,
    reaching,
    recentred,
    without,
)
from diagnosis.search.screen import Score, score
from grids.instruments import INSTRUMENTS

REST, FAR = 0.25, 20.0
"""Share of what is missing that an explanation of most of it may leave, and the misfit per sample over white noise from
which a mechanism leaves much, whatever it explains."""
LEADING, SECONDS = 3, 4
"""Classes of mechanisms beside which a second is sought, and the mechanisms that are fitted beside each."""
END = 0.01
"""Share of its range within which a number is at an end of it: a fit that is drawn there may not arrive."""


def explains_most(one: Explanation, of: Explanation, errors: Errors) -> bool:
    """Whether an explanation leaves little of what another leaves, both over white noise.

    Over that, for errors estimated with a wrong mechanism hold what it does not explain.
    """
    left, missing = (left_over_white_noise(e, errors) - 1.0 for e in (one, of))
    return left < REST * max(missing, 1.0)


def leaves_much(single: Explanation, found: Search) -> bool:
    """Whether the best mechanism alone explains something and leaves so much that two may act."""
    if single.measured.stretches is not None or found.gain(single) < MISSING:  # fits of whole runs creep
        return False
    much = left_over_white_noise(single, found.errors) > FAR
    return much or not explains_most(single, found.base, found.errors)


def pairs_as_declared(found: Search, alone: Explanation, progress: Progress) -> list[Explanation]:
    """Pairs beside each of the strongest of a screen about the declared specimen, each better than those before.

    Until white noise explains what one leaves. Those that promise no less loss than the best so far, or than the best
    mechanism ``alone``, are given up on the way. If that is an instrument's effect, it is led first, as it was fitted:
    what an instrument does to a recording leads the numbers of the specimen less astray.
    """
    declared, most = as_declared(found.base), adjusted(alone)
    screened = score(linearise_about(declared.fitted), firsts(found.candidates), found.not_tried)
    leading: list[Score | Explanation] = [*_of_each_class(screened)[:LEADING]]
    if any(name in INSTRUMENTS for name in alone.names):
        leading.insert(0, alone)
    pairs: list[Explanation] = []
    for k, one in enumerate(leading):
        name = one.candidate.name if isinstance(one, Score) else one.names[0]
        what = f"a second effect beside {name}, from the specimen as declared"
        progress(f"looking for {what}", 0.35 + 0.03 * k)
        if not found.affordable(what):
            break
        first = _unfitted(declared, one, screened) if isinstance(one, Score) else one
        pair = _beside(found, first, most)
        if pair is not None:
            pairs.append(pair)
            most = adjusted(pair)
            if passes_for_white(pair, found.errors):
                break
    return pairs


def astray(found: Search) -> bool:
    """Whether the base model has a number at an end of its range: it makes up for what it lacks with what it has."""
    f = found.base.fitted
    if f.measured.stretches is not None:  # fits of whole runs creep
        return False
    free = [(u, *x.bounds) for u, x in zip(f.u, f.misfit.unknowns, strict=True) if x.prior is None]
    return any(min(u - low, high - u) < END * (high - low) for u, low, high in free)


def beside_recentred(found: Search, pair: Explanation, most: float) -> list[Explanation]:
    """For each of two effects, the surest first, the best with one other, the layers' numbers from their middles on.

    Of these those whose loss is less than ``most``. The states stay, lest a window lose its way from so far. Each pair
    is led from there once.
    """
    rests, own = [without(pair, one, 0) for one in pair.removable], frozenset(pair.candidates)
    fits: list[Explanation] = []
    for rest in () if own in found.recentred else sorted(rests, key=lambda rest: rest.loss):
        if found.affordable(f"others beside {rest.names[0]}, from the middle of the ranges"):
            found.recentred.add(own)
            best = _beside(found, recentred(rest), most)
            fits += [] if best is None else [best]
    return fits


def _beside(found: Search, first: Explanation, most: float) -> Explanation | None:
    """The best fit of ``first`` with one of the strongest beside it, if its loss is less than ``most``.

    From so far away a fit promises little at first: only one that is behind another of these is given up on the way.
    """
    scores = seconds(found, first)
    fits: list[Explanation] = []
    for entry in one_of_each(worth_a_refit(scores, SECONDS, SHARE_OF_SECOND))[:SECONDS]:
        if found.affordable(entry.candidate.name):
            least = min((adjusted(e) for e in fits), default=np.inf)
            fits.append(best_of(from_starts([first], entry.candidate, starts_of(entry, scores), least)))
    if not fits:
        return None
    best = reaching(best_of(fits), most)
    return again(best) if best.loss <= most else None


def _unfitted(declared: Explanation, entry: Score, screened: list[Score]) -> Explanation:
    """The declared specimen with a mechanism at the likeliest of the sizes where its refits start."""
    return best_of([extend(declared, entry.candidate, start, 0) for start in starts_of(entry, screened)])


def _of_each_class(scores: list[Score]) -> list[Score]:
    first: dict[str, Score] = {}
    for entry in scores:
        if entry.starts:
            first.setdefault(entry.candidate.effect_class, entry)
    return list(first.values())
