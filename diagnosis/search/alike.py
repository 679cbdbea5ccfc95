"""What is easily taken for an effect, tried in its place whatever a screen says: its law at other joints, and
mechanisms that show where it does (`models.base.Mechanism.shows`).

With a large effect left out the small steps of a screen lead to something else, or nowhere: the stiffening of a layer
by one law has no score beside what another one left behind, though both fit all but equally well.
"""

from __future__ import annotations

from collections.abc import Iterator

from diagnosis.search.beside import joinable
from diagnosis.search.candidates import Candidate
from diagnosis.search.found import Search, within_reach
from diagnosis.search.joints import same_law, sizes_at_other_joints
from diagnosis.search.refit import QUICK, Explanation, again, beside_at_best_size, best_of, extend, reaching, without
from models.errors import InputError


def in_the_place_of_each(found: Search, best: Explanation, most: float) -> Iterator[list[Explanation]]:
    """Refits of the best with each effect exchanged: for its law at other joints, then for what is easily taken for it.

    Those that promise no loss of ``most`` are given up; those that come near the best are taken further.
    """
    found.alike.add(frozenset(best.candidates))
    standing = {candidate: without(best, candidate, 0) for candidate in best.removable}
    for easily_taken, refit in ((same_law, _at_other_joints), (_shows_there, _at_best_size)):
        fits = []
        for one, left in standing.items():
            for other in joinable(found, left):
                if easily_taken(one, other) and _asked(found, left, other):
                    try:
                        fits.append(refit(best, one, left, other, most))
                    except InputError as refusal:  # it does not act together with another effect
                        found.not_tried.setdefault(other.name, str(refusal))
        yield [again(e) if within_reach(e, best) else e for e in fits]


def _at_other_joints(
    best: Explanation, one: Candidate, left: Explanation, other: Candidate, most: float
) -> Explanation:
    starts = sizes_at_other_joints(best, one)
    return reaching(best_of([extend(left, other, start, QUICK, most) for start in starts]), most)


def _shows_there(one: Candidate, other: Candidate) -> bool:
    return other.name != one.name and other.mechanism.shows == one.mechanism.shows


def _at_best_size(_: Explanation, one: Candidate, left: Explanation, other: Candidate, most: float) -> Explanation:
    return beside_at_best_size(left, other, most)


def _asked(found: Search, left: Explanation, other: Candidate) -> bool:
    """Whether the two together are still to be tried, and there is work for it; then they count as tried."""
    both = frozenset((*left.candidates, other))
    if both in found.alike or not found.affordable(f"{other.name} beside {' and '.join(left.names)}"):
        return False
    found.alike.add(both)
    return True
