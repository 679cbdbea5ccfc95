"""Which mechanisms are missing: the strongest alone, forward selection, exchange, rivals.

What counts is in `diagnosis.search.found`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import nullcontext

from diagnosis.errors.model import estimate
from diagnosis.progress import Progress
from diagnosis.search.beside import POOL_SHARE, extended, joinable, seconds
from diagnosis.search.budget import DECLARED, FURTHER, LAST, NUMBERS, THIRD, WEIGHING
from diagnosis.search.declared import explains_most, leaves_much, pairs_as_declared
from diagnosis.search.details import least
from diagnosis.search.evidence import drop_without_evidence
from diagnosis.search.exchange import drop, exchanged
from diagnosis.search.found import GAP, MISSING, Search, adequate, adjusted, passes_for_white, survives
from diagnosis.search.hidden import hidden_beside, take_hidden
from diagnosis.search.left_out import predicts_worse
from diagnosis.search.outside import outside
from diagnosis.search.refit import QUICK, Explanation, again, best_of, extend, over_ranges, reshaped, with_memory
from diagnosis.search.shapes import in_the_place_of_shapes, without_idle_shapes
from diagnosis.search.singles import refit_singles, take_further
from diagnosis.search.ties import settle_ties
from diagnosis.search.variants import with_other_numbers
from diagnosis.search.weighing import weigh_again
from grids.instruments import INSTRUMENTS
from models.errors import InputError

FIRST_POOL = 3
RIVALS = 2
"""Explanations beside which an effect that came last is tried too."""
LITTLE = 0.25
"""Share of what is missing that two effects must explain for one more to be sought beside them."""
FUTILE = "what was found explains less than a quarter of what is missing"


def first_effect(found: Search, progress: Progress) -> Iterator[Search]:
    """Yields the growing search after each stage, up to the best single mechanism under its own errors.

    Or to two, where no mechanism alone explains much and two do from the specimen as declared.
    """
    yield found
    progress("screening the mechanisms", 0.1)
    left = refit_singles(found, progress)
    yield found
    if not found.singles:
        return
    if _take_pair_as_declared(found, progress):
        yield found
        return
    take_further(found, left)
    take_best_single(found)
    if found.best is None and found.measured.stretches is not None:
        return
    if found.best is None:
        progress("looking for what the errors hide", 0.46)
        take_hidden(found, found.base, found.singles)
    else:
        yield found
        progress("estimating the errors with what was found", 0.46)
        weigh_again(found, max(found.spare, WEIGHING))
    yield found


def further_effects(found: Search, progress: Progress) -> Iterator[Search]:
    """The same with a second and a third mechanism beside the first; the last one is the answer.

    With work of its own where the first leaves much, or more than white noise: whatever was spent before, something
    else acts there, or the errors may hold what does. With some for a third where two leave more than noise.
    """
    if found.best is None or found.best.in_spell:
        return
    hides = found.measured.stretches is None and not passes_for_white(found.best, found.errors)
    more = hides or leaves_much(found.best, found)
    with found.work_of_its_own(FURTHER * found.measured.identification.further_work, beyond=more):
        _pairs(found, progress)
        yield found
        if found.outside is None:
            lacks = found.measured.stretches is None and found.incomplete
            with found.at_least(THIRD) if lacks else nullcontext():
                _more(found, progress)
            yield found
    if found.best is not None and len(found.best.candidates) > 1:
        with found.work_of_its_own(LAST, beyond=True):  # goes on where the budget ended
            exchanged(found, progress)
    settle_ties(found)
    if found.best is not None:
        found.best = with_memory(again(found.best))
        if found.weighed_elsewhere:
            found.errors = estimate(found.best.fitted, found.errors.base, found.errors)
        drop(found)  # errors estimated with both, and fits taken further, may ask for one only
        drop_without_evidence(found)
        with_other_numbers(found)
    yield found


def take_best_single(found: Search) -> None:
    """The strongest single so far that counts; a stronger one may rest on one window that needs another effect too."""
    for single in sorted(found.singles, key=adjusted):
        if found.gain(single) < MISSING:
            return
        if survives(found.base, single):
            found.best = single
            return
        found.pass_over(single)


def _take_pair_as_declared(found: Search, progress: Progress) -> bool:
    """Take two mechanisms that explain most of what the best of them alone leaves, where that is much; whether it did.

    What of the two is not needed is dropped later.
    """
    single = min(found.singles, key=adjusted)
    if not leaves_much(single, found):
        return False
    with found.work_of_its_own(DECLARED):
        pairs = pairs_as_declared(found, single, progress)
    pair = _pair_that_counts(found, single, pairs)
    if pair is None or not explains_most(pair, single, found.errors):
        return False
    found.tried += [*found.singles, *pairs]
    found.best = over_ranges(again(reshaped(pair)))
    progress("estimating the errors with what was found", 0.46)
    weigh_again(found)
    return True


def pool(found: Search, best: Explanation) -> list[list[Explanation]]:
    """The best singles of each of the strongest classes, that of ``best`` first and alone where it is adequate.

    Of a class one of the specimen and one of its instruments where both explain as much: a lean of the base and an
    offset of its accelerometer are alike alone, and need not be beside another effect.
    """
    most = 1 if adequate(best) else FIRST_POOL
    least = max(MISSING, POOL_SHARE * found.gain(best))
    chosen: dict[str, dict[bool, Explanation]] = {}
    for single in (best, *found.singles):
        effect_class, gain = single.classes[0], found.gain(single)
        if gain < least or (effect_class not in chosen and len(chosen) == most):
            continue
        alike = chosen.setdefault(effect_class, {})
        if all(found.gain(one) - gain < GAP for one in alike.values()):
            alike.setdefault(single.names[0] in INSTRUMENTS, single)
    return [list(alike.values()) for alike in chosen.values()]


def _pairs(found: Search, progress: Progress) -> None:
    if found.best is None:
        return
    if len(found.best.candidates) > 1:
        _settle_numbers(found)
        exchanged(found, progress)
        return
    progress("comparing with laws outside the library", 0.48)
    others = seconds(found, found.best)
    if not adequate(found.best):
        found.outside = outside(found, found.best, others)
    leading, widely = pool(found, found.best), found.incomplete
    pairs: list[Explanation] = []
    for k, alike in enumerate(leading):
        for single in alike:
            name = single.names[0]
            progress(f"looking for a second effect beside {name}", 0.5 + 0.25 * k / len(leading))
            if found.affordable(f"a second effect beside {name}"):
                screened = others if single is found.best else seconds(found, single)
                pairs += extended(found, single, screened, widely)
                pairs += in_the_place_of_shapes(found, single)
        if any(adequate(e) or explains_most(e, found.best, found.errors) for e in pairs):
            break  # others are tried in its place later
    if found.outside is not None:
        if not any(adequate(e) for e in pairs) and not _with_an_instrument(pairs):
            return
        found.outside = None
    found.tried += pairs
    pair = _pair_that_counts(found, found.best, pairs)
    if pair is not None:
        found.best = over_ranges(again(reshaped(pair)))
        weigh_again(found)
    elif found.measured.stretches is None:
        progress("looking for a second effect that the errors hide", 0.77)
        take_hidden(found, found.best, [*pairs, *hidden_beside(found, found.best, pairs)])
    _settle_numbers(found)
    exchanged(found, progress)  # before a third: what stands in for another effect leaves traces of its own


def _settle_numbers(found: Search) -> None:
    """Other whole numbers of two effects that leave something, lest others be sought for what a wrong one leaves.

    Not where whole runs are compared: there all models leave something.
    """
    standing = found.best
    if standing is None or len(standing.candidates) < 2 or standing.measured.stretches is not None:
        return
    if not found.incomplete:
        return
    with found.work_of_its_own(NUMBERS, beyond=True):
        with_other_numbers(found)
        if found.best is not standing:
            weigh_again(found)


def _with_an_instrument(pairs: Sequence[Explanation]) -> bool:
    """Whether the likeliest pair is a mechanism and an instrument.

    What an instrument does to a recording is no law of the wall: whether one acts is asked again beside it.
    """
    return bool(pairs) and sum(name in INSTRUMENTS for name in min(pairs, key=adjusted).names) == 1


def _pair_that_counts(found: Search, best: Explanation, pairs: Sequence[Explanation]) -> Explanation | None:
    """The likeliest pair that counts; what rests on one window, or may be a detail of a law, is passed over."""
    for pair in sorted(pairs, key=adjusted):
        alone = best_of([e for e in found.singles if e.names[0] in pair.names] or [best])
        second = next(c for c in pair.candidates if c.name not in alone.names)
        gain = adjusted(best) - adjusted(pair)
        if gain < found.more:
            return None
        before = without_idle_shapes(alone, pair)
        if before is not alone:
            gain = adjusted(before) - adjusted(pair)
        needed = least(found, before, second)
        if gain >= needed and survives(before, pair, needed):
            return pair
        found.pass_over(pair)
    return None


def _more(found: Search, progress: Progress) -> None:
    """A third effect, by the same rule, unless a law outside the library explains more."""
    most = found.measured.identification.most_effects
    while found.best is not None and 2 <= len(found.best.candidates) < most and found.affordable("a third effect"):
        if found.measured.stretches is None and found.explained < LITTLE:
            found.not_tried.setdefault("a third effect", FUTILE)
            return
        progress("looking for a further effect", 0.8)
        others = seconds(found, found.best)
        if not adequate(found.best):
            found.outside = outside(found, found.best, others)
            if found.outside is not None:
                return
        more = extended(found, found.best, others, found.incomplete)
        if not more:
            return
        found.tried += more
        best = _next(found, found.best, more)
        if best is None:
            return
        found.tried += _beside_rivals(found, found.best, best)
        found.best = best
        weigh_again(found)
        exchanged(found, progress)


def _beside_rivals(found: Search, before: Explanation, after: Explanation) -> list[Explanation]:
    """What came last, beside explanations as large as ``before`` that are less behind it than what came last gains.

    Of two that explain nearly as much without it either may be the one that stands for the other.
    """
    if found.measured.stretches is not None:  # fits of whole runs creep
        return []
    last, gain = after.candidates[-1], adjusted(before) - adjusted(after)
    rivals: dict[frozenset[str], Explanation] = {}  # other orders, or other joints, of the same laws are none
    for one in sorted(found.tried, key=adjusted):
        joins = found.eligible(one) and last in joinable(found, one)
        if len(one.candidates) == len(before.candidates) and joins and adjusted(one) < adjusted(before) + gain:
            rivals.setdefault(frozenset(one.names), one)
    rivals.pop(frozenset(before.names), None)
    fits = []
    for one in list(rivals.values())[:RIVALS]:
        if found.affordable(f"{last.name} beside {' and '.join(one.names)}"):
            try:
                fits.append(again(extend(one, last, after.part(last), QUICK, one.loss)))
            except InputError as refusal:  # it does not act together with an effect of the rival
                found.not_tried.setdefault(last.name, str(refusal))
    return fits


def _next(found: Search, before: Explanation, more: Sequence[Explanation]) -> Explanation | None:
    """The likeliest with one more effect, if it counts.

    Where no model explains everything, what they all get wrong is part of what is weighed: then one that predicts
    recordings worse that are left out in turn is passed over.
    """
    incomplete = found.incomplete
    for one in sorted(more, key=adjusted):
        needed, gain = least(found, before, one.candidates[-1]), adjusted(before) - adjusted(one)
        if gain < found.more:
            return None
        if gain >= needed and survives(before, one, needed) and not (incomplete and predicts_worse(before, one)):
            return one
        found.pass_over(one)  # it rests on one window, or is a detail of a law of the joints
    return None
