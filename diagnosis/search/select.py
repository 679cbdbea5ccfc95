"""Which mechanisms are missing: refits of the strongest, forward selection, exchange, rivals.

The fit of the base may be stuck; a rival's optimum then shows it, and the base is refitted from
there. What counts is in `diagnosis.search.found`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import isfinite

from diagnosis.errors.model import estimate, refitted
from diagnosis.fit.linearisation import linearise_about
from diagnosis.progress import Progress
from diagnosis.search.beside import (
    POOL_SHARE,
    THOROUGH,
    extended,
    heavy,
    one_of_each,
    seconds,
    starts_of,
    worth_a_refit,
)
from diagnosis.search.budget import FURTHER, JOINTS, LAST, UNTRIED
from diagnosis.search.candidates import Candidate, firsts
from diagnosis.search.details import least
from diagnosis.search.exchange import drop, exchanged
from diagnosis.search.found import (
    GAP,
    MISSING,
    STUCK,
    Search,
    adequate,
    adjusted,
    enough,
    explains_all,
    passes_for_white,
    survives,
    within_reach,
)
from diagnosis.search.hidden import hidden_beside, hidden_by_errors, take_hidden
from diagnosis.search.joints import at_other_joints
from diagnosis.search.left_out import predicts_worse
from diagnosis.search.null import null_distribution
from diagnosis.search.outside import outside
from diagnosis.search.refit import (
    Explanation,
    again,
    as_declared,
    best_of,
    from_other,
    from_starts,
    further,
    over_ranges,
    reshaped,
    ways,
    with_memory,
)
from diagnosis.search.screen import Score, score
from diagnosis.search.thresholds import from_measured, misfits, setting_in
from diagnosis.search.ties import settle_ties
from diagnosis.search.untried import in_its_place
from diagnosis.search.variants import with_other_numbers
from diagnosis.search.weighing import add_single, weigh_again
from diagnosis.search.white_screen import against_white_noise
from grids.instruments import INSTRUMENTS

FAINT = 8.0
"""Gain of the strongest single that is not taken further where the base model is adequate."""
FEWEST, FEWEST_ADEQUATE, MOST = 5, 2, 16
SHARE_OF_FIRST = 0.05
"""Of the strongest statistic: what a first mechanism must reach to be refitted."""
NEAR, NEAR_ADEQUATE = 0.2, 0.6
"""Share of the leader's gain from which a single is refitted from the leader's optimum too."""
NEAR_HEAVY = 0.3
"""Share of the largest statistic that a mechanism of many short steps must reach where another explains everything."""
COSTLY = "not alone: another explains everything, the screen gives it much less, and its fits take long"
THRESHOLD = "not alone: it sets in at a threshold, and another explains everything without it"
NEAR_FIRST, MOST_FIRST = 0.3, 4
"""Share of the largest statistic from which a mechanism is refitted before what has no slope; how many at most."""
FIRST_POOL = 3
LITTLE = 0.25
"""Share of what is missing that two effects must explain for one more to be sought beside them."""
FUTILE = "what was found explains less than a quarter of what is missing"


def first_effect(found: Search, progress: Progress) -> Iterator[Search]:
    """Yields the growing search after each stage, up to the best single mechanism under its own errors."""
    yield found
    progress("screening the mechanisms", 0.1)
    refit_singles(found, progress)
    yield found
    if not found.singles:
        return
    take_best_single(found)
    if found.best is None and found.measured.stretches is not None:
        return
    if found.best is None:
        progress("looking for what the errors hide", 0.46)
        take_hidden(found, found.base, found.singles)
    else:
        yield found
        progress("estimating the errors with what was found", 0.46)
        weigh_again(found)
    yield found


def further_effects(found: Search, progress: Progress) -> Iterator[Search]:
    """The same with a second and a third mechanism beside the first; the last one is the answer."""
    if found.best is None or found.best.in_spell:
        return
    with found.work_of_its_own(FURTHER * found.measured.identification.further_work):
        _pairs(found, progress)
        yield found
        if found.outside is None:
            _more(found, progress)
            yield found
    if found.best is not None and len(found.best.candidates) > 1:
        with found.work_of_its_own(LAST):  # goes on where the budget ended
            exchanged(found, progress)
    settle_ties(found)
    if found.best is not None:
        found.best = with_memory(again(found.best))
        if found.weighed_elsewhere:
            found.errors = estimate(found.best.fitted, found.errors.base, found.errors)
        drop(found)  # errors estimated with both, and fits taken further, may ask for one only
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


def refit_singles(found: Search, progress: Progress) -> None:
    """Screen the mechanisms and refit the strongest alone: ``scores``, ``null`` and ``singles``, the likeliest first.

    The leader is taken further: over its ranges, to other joints, and against what the budget left untried.
    """
    begins = starting_points(found)
    opened = linearise_about(found.base.fitted)
    found.scores = score(opened, firsts(found.candidates), found.not_tried, explains_all(found.base))
    found.null = null_distribution(opened, found.scores)
    fewest = FEWEST_ADEQUATE if adequate(found.base) else FEWEST
    wanted = worth_a_refit(found.scores, fewest, SHARE_OF_FIRST)[:MOST]
    late: list[Candidate] = []
    if found.measured.stretches is None and not passes_for_white(found.base, found.errors):
        white, scores = against_white_noise(found, found.base, firsts(found.candidates))
        wanted += hidden_by_errors(scores, {entry.candidate for entry in wanted}, fewest, SHARE_OF_FIRST)
        if misfits(white.fitted):
            late = setting_in(found.base, [entry.candidate for entry in found.scores])
    left = []
    wanted = in_turn(wanted, [entry for entry in found.scores if entry.candidate in late], found.scores)
    largest = max((entry.statistic for entry in wanted), default=0.0)
    most, creeps = enough(found.singles), found.measured.stretches is not None
    for k, entry in enumerate(wanted):
        explained = isfinite(most) or (creeps and any(explains_all(single) for single in found.singles))
        is_heavy = heavy(entry, found.scores)
        if explained and is_heavy and entry.statistic < NEAR_HEAVY * largest:
            found.not_tried.setdefault(entry.candidate.name, COSTLY)
            continue
        if not found.affordable(entry.candidate.name):
            left.append(entry)
            continue
        progress(f"refitting {entry.candidate.name}", 0.15 + 0.3 * k / len(wanted))
        starts = starts_of(entry, found.scores)
        own = begins[:1] if is_heavy else begins
        fits = from_starts(own, entry.candidate, starts, most)
        if entry.candidate in late and not explained:
            fits += from_measured(found.base, entry.candidate)
        elif entry.candidate in late and not fits:
            found.not_tried.setdefault(entry.candidate.name, THRESHOLD)
        if fits:
            most = add_single(found, fits, most)
    for single in found.singles:  # in another variant
        if found.not_tried.get(single.names[0]) in (COSTLY, THRESHOLD):
            del found.not_tried[single.names[0]]
    found.singles.sort(key=adjusted)
    if not found.singles:
        return
    if adequate(found.base) and found.gain(found.singles[0]) < FAINT:
        return
    found.singles[0] = over_ranges(again(reshaped(found.singles[0])))
    if found.gain(found.singles[0]) < MISSING:
        return
    if led_by(found, found.singles[0]):
        found.singles[0] = again(reshaped(found.singles[0]))
        tried = {single.candidates[0] for single in found.singles}
        worth = one_of_each(worth_a_refit(found.scores, fewest, SHARE_OF_FIRST))[:MOST]
        left = [s for s in worth if s.candidate not in tried and found.not_tried.get(s.candidate.name) != COSTLY]
    with found.work_of_its_own(min(JOINTS, found.spare)):
        at_other_joints(found)
    with found.work_of_its_own(min(UNTRIED, found.spare)):
        in_its_place(found, left)
    leader = found.singles[0]
    near = NEAR_ADEQUATE if adequate(leader) else NEAR
    for k, single in enumerate(found.singles[1:], start=1):
        if found.gain(single) <= near * found.gain(leader) or not found.affordable(single.names[0]):
            continue
        single = from_other(single, leader, enough([leader]))
        found.singles[k] = again(single) if k < THOROUGH and within_reach(single, leader) else single
    least = NEAR * found.gain(leader)  # of a law with a memory counts along its own motion may add much
    found.singles = [
        with_memory(single) if found.gain(single) > least and within_reach(single, leader) else single
        for single in found.singles
    ]
    found.singles.sort(key=adjusted)
    found.tried += found.singles


def starting_points(found: Search) -> list[Explanation]:
    """Where refits of singles begin: at the base model, and at the specimen as it is declared where the base misfits.

    If the base fits better from there it is taken there, with errors of its own, and is the only one.
    """
    if found.measured.stretches is not None or adequate(found.base) or found.spent:
        return [found.base]
    declared = as_declared(found.base)
    restarted = best_of([further(way) for way in ways(declared)])
    if restarted.loss >= found.base.loss - STUCK:
        return [found.base, declared]
    fitted, found.errors = refitted(restarted.fitted, found.errors.base, found.errors)
    found.base = replace(found.base, fitted=fitted)
    return [found.base]


def in_turn(wanted: Sequence[Score], late: Sequence[Score], scores: Sequence[Score]) -> list[Score]:
    """The strongest of a screen, then what has no slope at its null, then the others: a budget may end on the way.

    Of those that something else may make needless, what takes many short steps comes last.
    """
    strongest = one_of_each(wanted)
    near = sum(entry.statistic >= NEAR_FIRST * strongest[0].statistic for entry in strongest[:MOST_FIRST])
    first = max(FEWEST_ADEQUATE, near)
    others = sorted((*late, *strongest[first:]), key=lambda entry: heavy(entry, scores))
    return list({entry.candidate: entry for entry in (*strongest[:first], *others)}.values())


def led_by(found: Search, leader: Explanation) -> bool:
    """Take the base to the leader's optimum, and the singles with it, if it was stuck; whether it was.

    The screen is then that of the freed base.
    What one mechanism gains by freeing a window that was stuck says nothing for it: all others were fitted from there.
    Those that a screen of the freed base gives no chance, and that explain no more than it does, stay where they are.
    """
    restarted = from_other(found.base, leader)
    if restarted.loss >= found.base.loss - STUCK:
        return False
    found.base = restarted
    opened = linearise_about(restarted.fitted)
    found.scores = score(opened, firsts(found.candidates), found.not_tried, explains_all(found.base))
    found.null = null_distribution(opened, found.scores)
    fitted = {c for single in found.singles for c in single.candidates}
    again_worth = worth_a_refit([s for s in found.scores if s.candidate in fitted], FEWEST_ADEQUATE, SHARE_OF_FIRST)
    worth = {entry.candidate for entry in again_worth}
    led = (
        from_other(single, restarted) if worth.intersection(single.candidates) or found.gain(single) > 0.0 else single
        for single in found.singles
    )
    found.singles = sorted(led, key=adjusted)
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
        if any(adequate(e) for e in pairs):  # the others are still tried in its place
            break
    if found.outside is not None:
        if not any(adequate(e) for e in pairs):
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
    exchanged(found, progress)  # before a third: what stands in for another effect leaves traces of its own


def _pair_that_counts(found: Search, best: Explanation, pairs: Sequence[Explanation]) -> Explanation | None:
    """The likeliest pair that counts; what rests on one window, or may be a detail of a law, is passed over."""
    for pair in sorted(pairs, key=adjusted):
        alone = best_of([e for e in found.singles if e.names[0] in pair.names] or [best])
        needed = least(found, alone, next(c for c in pair.candidates if c.name not in alone.names))
        gain = adjusted(best) - adjusted(pair)
        if gain < found.more:
            return None
        if gain >= needed and survives(alone, pair, needed):
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
        found.best = best
        weigh_again(found)
        exchanged(found, progress)


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
