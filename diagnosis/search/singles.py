"""Which mechanisms explain what the base model leaves, each alone: a screen of all, refits of the strongest.

The fit of the base may be stuck; a leader's optimum then shows it, and the base is refitted from there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import isfinite

from diagnosis.errors.model import refitted
from diagnosis.fit.linearisation import linearise_about
from diagnosis.progress import Progress
from diagnosis.search.beside import THOROUGH, heavy, one_of_each, starts_of, worth_a_refit
from diagnosis.search.budget import JOINTS, UNTRIED
from diagnosis.search.candidates import Candidate, firsts
from diagnosis.search.found import (
    MISSING,
    STUCK,
    Search,
    adequate,
    adjusted,
    enough,
    explains_all,
    lost_in_a_window,
    passes_for_white,
    within_reach,
)
from diagnosis.search.hidden import hidden_by_errors
from diagnosis.search.joints import at_other_joints
from diagnosis.search.null import null_distribution
from diagnosis.search.refit import (
    Explanation,
    again,
    as_declared,
    best_of,
    from_other,
    from_starts,
    further,
    in_the_place_of,
    over_ranges,
    reshaped,
    ways,
    with_memory,
)
from diagnosis.search.screen import Score, score
from diagnosis.search.thresholds import from_measured, misfits, setting_in
from diagnosis.search.untried import in_its_place
from diagnosis.search.weighing import add_single
from diagnosis.search.white_screen import against_white_noise

FAINT = 8.0
"""Gain of the strongest single that is not taken further where the base model is adequate."""
FEWEST, FEWEST_ADEQUATE, MOST = 5, 2, 16
SHARE_OF_FIRST = 0.05
"""Of the strongest statistic: what a first mechanism must reach to be refitted."""
NEAR, NEAR_ADEQUATE = 0.2, 0.6
"""Share of the leader's gain from which a single is refitted from the leader's optimum too."""
NEAR_HEAVY = 0.3
"""Share of the largest statistic that a mechanism of many short steps must reach where another explains everything."""
PROMISING = 0.5
"""Share of the leader's gain that a fit in its place may promise to lack and goes on."""
COSTLY = "not alone: another explains everything, the screen gives it much less, and its fits take long"
THRESHOLD = "not alone: it sets in at a threshold, and another explains everything without it"
NEAR_FIRST, MOST_FIRST = 0.3, 4
"""Share of the largest statistic from which a mechanism is refitted before what has no slope; how many at most."""


def refit_singles(found: Search, progress: Progress) -> list[Score]:
    """Screen the mechanisms and refit the strongest alone: ``scores``, ``null`` and ``singles``, the likeliest first.

    Those that the budget left untried.
    """
    begins = starting_points(found)
    opened = linearise_about(found.base.fitted)
    found.scores = score(opened, firsts(found.candidates), found.not_tried, explains_all(found.base))
    found.null = null_distribution(opened, found.scores)
    fewest = _fewest(found)
    wanted = worth_a_refit(found.scores, fewest, SHARE_OF_FIRST)[:MOST]
    late: list[Candidate] = []
    if found.measured.stretches is None and misfits(found.base, found.errors):
        late = setting_in(found.base, [entry.candidate for entry in found.scores])
    wanted = in_turn(wanted, [entry for entry in found.scores if entry.candidate in late], found.scores)
    left = _refit_in_turn(found, wanted, begins, late, (0.15, 0.35), progress)
    if _may_hide(found):
        _, white = against_white_noise(found, found.base, firsts(found.candidates))
        hidden = hidden_by_errors(white, {entry.candidate for entry in wanted}, fewest, SHARE_OF_FIRST)
        left += _refit_in_turn(found, in_turn(hidden, [], found.scores), begins, [], (0.35, 0.45), progress)
    for single in found.singles:  # in another variant
        if found.not_tried.get(single.names[0]) in (COSTLY, THRESHOLD):
            del found.not_tried[single.names[0]]
    found.singles.sort(key=adjusted)
    return left


def _fewest(found: Search) -> int:
    return FEWEST_ADEQUATE if adequate(found.base) else FEWEST


def take_further(found: Search, left: Sequence[Score]) -> None:
    """The likeliest single over its ranges, to other joints and against what is ``left`` untried; others beside it."""
    if not found.singles or (adequate(found.base) and found.gain(found.singles[0]) < FAINT):
        return
    found.singles[0] = over_ranges(again(reshaped(found.singles[0])))
    if found.gain(found.singles[0]) < MISSING:
        return
    if led_by(found, found.singles[0]):
        found.singles[0] = again(reshaped(found.singles[0]))
        tried = {single.candidates[0] for single in found.singles}
        worth = one_of_each(worth_a_refit(found.scores, _fewest(found), SHARE_OF_FIRST))[:MOST]
        left = [s for s in worth if s.candidate not in tried and found.not_tried.get(s.candidate.name) != COSTLY]
    with found.work_of_its_own(min(JOINTS, found.spare)):
        at_other_joints(found)
    with found.work_of_its_own(min(UNTRIED, found.spare)):
        in_its_place(found, left)
    leader = found.singles[0]
    near = NEAR_ADEQUATE if adequate(leader) else NEAR
    replaceable = _replaceable(found, leader)
    for k, single in enumerate(found.singles[1:], start=1):
        far = found.gain(single) <= near * found.gain(leader) and not lost_in_a_window(single, leader)
        if (far and single.candidates[0] not in replaceable) or not found.affordable(single.names[0]):
            continue
        if far:
            single = in_the_place_of(single, leader, leader.loss + PROMISING * found.gain(leader))
        else:
            single = from_other(single, leader, enough([leader]))
        thoroughly = (k < THOROUGH and within_reach(single, leader)) or lost_in_a_window(single, leader)
        found.singles[k] = again(single) if thoroughly else single
    least = NEAR * found.gain(leader)  # of a law with a memory counts along its own motion may add much
    found.singles = [
        with_memory(single) if found.gain(single) > least and within_reach(single, leader) else single
        for single in found.singles
    ]
    found.singles.sort(key=adjusted)
    found.tried += found.singles


def _replaceable(found: Search, leader: Explanation) -> set[Candidate]:
    """Which may explain as much as a leader that explains everything, however little their fits do; not the costly."""
    if found.measured.stretches is not None or not explains_all(leader):
        return set()
    return {entry.candidate for entry in found.scores if not heavy(entry, found.scores)}


def _may_hide(found: Search) -> bool:
    """Whether the errors may hold a mechanism: white noise explains neither what the base leaves nor a single does."""
    if found.measured.stretches is not None:
        return False
    return not any(passes_for_white(one, found.errors) for one in (found.base, *found.singles))


def _refit_in_turn(
    found: Search,
    wanted: Sequence[Score],
    begins: Sequence[Explanation],
    late: Sequence[Candidate],
    between: tuple[float, float],
    progress: Progress,
) -> list[Score]:
    """Add refits of those ``wanted`` to the singles, of what is ``late`` from the measured states too.

    Those that the budget leaves are returned. ``between``: the progress from the first to the last.
    """
    first, last = between
    largest = max((entry.statistic for entry in (*found.scores, *wanted)), default=0.0)
    most, creeps = enough(found.singles), found.measured.stretches is not None
    left = []
    for k, entry in enumerate(wanted):
        explained = isfinite(most) or (creeps and any(explains_all(single) for single in found.singles))
        is_heavy = heavy(entry, found.scores)
        if explained and is_heavy and entry.statistic < NEAR_HEAVY * largest:
            found.not_tried.setdefault(entry.candidate.name, COSTLY)
            continue
        if not found.affordable(entry.candidate.name):
            left.append(entry)
            continue
        progress(f"refitting {entry.candidate.name}", first + (last - first) * k / len(wanted))
        starts = starts_of(entry, found.scores)
        own = begins[:1] if is_heavy else begins
        fits = from_starts(own, entry.candidate, starts, most)
        if entry.candidate in late and not explained:
            fits += from_measured(found.base, entry.candidate)
        elif entry.candidate in late and not fits:
            found.not_tried.setdefault(entry.candidate.name, THRESHOLD)
        if fits:
            most = add_single(found, fits, most)
    return left


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
