"""A law of the layers at the other joints: from where the strongest stands.

From a base that went astray, the top layer at the end of its range because the base layer lacked something, the law in
both layers is further off than the law in one, and its refit ends where it began. Taken from the valley that the law in
one layer has led to, it gets to its own.
"""

from __future__ import annotations

from collections.abc import Iterator

from diagnosis.search.candidates import Candidate
from diagnosis.search.details import of_joints
from diagnosis.search.found import Search, adequate, adjusted
from diagnosis.search.refit import QUICK, Explanation, again, best_of, extend, over_ranges, without
from models.base import FloatArray

NEAR = 0.7
"""Share of the leader's gain from which its law at other joints is taken further."""
SIZES = (1.0, 0.5)
"""Of the effect, over that of the leader: two layers share what one does."""
TURNS = 2


def at_other_joints(found: Search) -> None:
    """Add the law of the strongest single at the other joints, if it leaves something; again from a stronger one."""
    for _ in range(TURNS):
        leader = found.singles[0]
        (candidate,) = leader.candidates
        if adequate(leader) or not of_joints(candidate, leader):
            return
        standing = without(leader, candidate, 0)
        for other in found.candidates:
            if same_law(candidate, other) and found.affordable(f"{candidate.name} at other joints"):
                single = best_of(
                    [extend(standing, other, start, QUICK) for start in sizes_at_other_joints(leader, candidate)]
                )
                if found.gain(single) > NEAR * found.gain(leader):
                    single = over_ranges(again(single))
                found.singles.append(single)
        found.singles = _best_of_each(found.singles)
        if found.singles[0].candidates == leader.candidates:
            return


def sizes_at_other_joints(leader: Explanation, candidate: Candidate) -> Iterator[FloatArray]:
    """Coordinates (d,) at which the law of one of its effects may begin at other joints."""
    for size in SIZES:
        start = leader.part(candidate)
        start[0] = candidate.null[0] + size * (start[0] - candidate.null[0])
        yield start


def same_law(one: Candidate, other: Candidate) -> bool:
    """Whether they are one law at different joints, with the same whole numbers."""
    if one.name != other.name or other.mechanism.beside:
        return False
    elsewhere = [x.name for x in one.unknowns] != [x.name for x in other.unknowns]
    return elsewhere and list(one.held.values()) == list(other.held.values())


def _best_of_each(singles: list[Explanation]) -> list[Explanation]:
    """The best fit of every candidate, the likeliest first."""
    best: dict[Candidate, Explanation] = {}
    for single in sorted(singles, key=adjusted):
        best.setdefault(single.candidates[0], single)
    return list(best.values())
