"""Effects taken one by one, held against the others again: a search that only adds ends at what came first.

The effect that explains most alone need not be among those that explain most together: a relaxing arm takes the place
of hysteresis beside a law that softens, until something else is there too. So each effect taken is left out in turn,
for good if nothing is lost, and every other one tried in its place, under the rule by which it was taken.
"""

from __future__ import annotations

import numpy as np

from diagnosis.progress import Progress
from diagnosis.search.alike import in_the_place_of_each
from diagnosis.search.beside import extended, seconds
from diagnosis.search.candidates import Candidate
from diagnosis.search.declared import astray, beside_recentred
from diagnosis.search.details import least
from diagnosis.search.found import MISSING, STUCK, Search, adjusted
from diagnosis.search.left_out import predicts_worse
from diagnosis.search.refit import Explanation, again, from_states_of, gain_by_window, over_ranges, reshaped, without
from diagnosis.search.weighing import CLOSE, weigh_again

ROUNDS = 4


def exchanged(found: Search, progress: Progress) -> None:
    """Exchange effects until none gets better.

    Where an exchange gains clearly the errors are estimated anew at once, and everything is tried again under these;
    where it gains little, as a filter does in the place of a delay, once at the end.
    """
    held: set[frozenset[Candidate]] = set()
    unweighed = False
    for _ in range(ROUNDS):
        drop(found)
        if found.best is None or len(found.best.candidates) < 2:
            return
        held.add(frozenset(found.best.candidates))
        progress("trying others in the place of each effect", 0.85)
        incomplete = found.incomplete
        _try_others(found, incomplete)
        standing, better = found.best, _better(found, incomplete)
        if better is None and len(standing.candidates) == 2 and astray(found):
            found.tried += beside_recentred(found, standing, standing.loss + CLOSE)
            better = _better(found, incomplete)
        if better is None:
            break
        found.best = better
        if frozenset(better.candidates) in held:
            break
        found.best = over_ranges(again(reshaped(better)))
        if adjusted(standing) - adjusted(found.best) < MISSING:
            found.best = min(found.best, from_states_of(standing, [found.best]), key=adjusted)
            found.tried.append(found.best)
            unweighed = unweighed or found.best.candidates != standing.candidates
            continue
        weigh_again(found)
        unweighed = False
        found.exchanged.clear()  # what was tried beside effects that had not settled tells little
        if frozenset(found.best.candidates) in held:
            break
    if unweighed:
        weigh_again(found)


def _better(found: Search, incomplete: bool) -> Explanation | None:
    """The likeliest of as many effects, if it is likelier than the best.

    Where no model explains everything, what they all get wrong is part of what is weighed, and it is alike all along a
    recording: an exchange then has to gain without the window that speaks most for it and without any one recording,
    and must not predict recordings worse that are left out in turn.
    """
    best = found.best
    if best is None:
        return None
    for other in sorted(found.tried, key=adjusted):
        if adjusted(other) >= adjusted(best):
            return None
        same = set(other.candidates) == set(best.candidates)
        if len(other.candidates) != len(best.candidates) or not (same or found.eligible(other)):
            continue
        if same or not incomplete or (_everywhere(best, other) and not predicts_worse(best, other)):
            return other
    return None


def _everywhere(before: Explanation, after: Explanation) -> bool:
    """Whether the gain does not rest on one window, or on one of several recordings."""
    gains = gain_by_window(before, after)
    total = adjusted(before) - adjusted(after)
    of = after.measured.recording_of
    recordings = [float(gains[of == r].sum()) for r in np.unique(of)]
    return total > max([float(gains.max()), *(recordings if len(recordings) > 1 else [])])


def drop(found: Search) -> None:
    """Drop what is not needed, or no longer, the least needed first; what is left without the others are rivals."""
    while found.best is not None and len(found.best.candidates) > 1:
        best, spare = found.best, []
        for candidate in best.removable:
            rest = without(best, candidate)
            spare.append((adjusted(rest) - adjusted(best) - least(found, rest, candidate), rest))
        excess, rest = min(spare, key=lambda entry: entry[0])
        if excess >= 0.0:
            return
        found.best = rest
        found.tried += [other for _, other in spare]


def _try_others(found: Search, widely: bool) -> None:
    """Refits of the best with each effect exchanged, but where that was tried beside the others before.

    From where the others stand: fitted again without the effect they may move into another valley, as a clock does
    without the filter whose lag it then takes for its own. Where what stands is incomplete, from that valley too.
    First in the place of the effect without which least is lost: it is the least sure, and its refits are the shortest;
    but last where the budget ended on others before. Refits that do not come near what stands, or the best of those
    before, are given up. What is easily taken for an effect comes before all others, which wait if that fits better.
    """
    if (best := found.best) is None:
        return
    # where whole runs are compared fits creep, and what is ahead of one tells little of where it ends
    near = np.inf if best.measured.stretches is not None else CLOSE
    reached = best.loss
    if best.measured.stretches is None:
        for fits in in_the_place_of_each(found, best, reached + near):
            found.tried += fits
            if _better(found, widely) is not None:
                return
    standing = {candidate: without(best, candidate, 0) for candidate in best.removable}

    def later(entry: tuple[Candidate, Explanation]) -> tuple[bool, float]:
        return frozenset(best.candidates) - {entry[0]} in found.cut, entry[1].loss

    for candidate, left in sorted(standing.items(), key=later):
        others = frozenset(best.candidates) - {candidate}
        if others not in found.exchanged and found.affordable(f"others in the place of {candidate.name}"):
            for rest in [left, *(_elsewhere(best, candidate, left) if widely else [])]:
                fits = extended(found, rest, seconds(found, rest), widely, candidate, reached + near)
                reached = min([reached, *(one.loss for one in fits)])
                found.tried += fits
            # where the budget ended the others are tried when there is work left
            (found.cut if found.spent else found.exchanged).add(others)


def _elsewhere(best: Explanation, candidate: Candidate, left: Explanation) -> list[Explanation]:
    """The others fitted again without a candidate, unless that leads nowhere from where they are ``left``."""
    elsewhere = without(best, candidate)
    return [elsewhere] if elsewhere.loss < left.loss - STUCK else []
