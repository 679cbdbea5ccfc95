"""What the budget left untried of a screen, in the place of the strongest single: from where that one stands.

From the base a refit of a wall under a wrong law takes many steps, and a record of many samples leaves work for a few
of them only. The valley that the strongest has led to is mostly that of its rivals too, and they reach it in few.
"""

from __future__ import annotations

from collections.abc import Sequence

from diagnosis.search.beside import starts_of
from diagnosis.search.budget import ENDED
from diagnosis.search.found import Search, adjusted, enough
from diagnosis.search.refit import QUICK, again, extend, over_ranges, without
from diagnosis.search.screen import Score
from diagnosis.search.weighing import add_single


def in_its_place(found: Search, left: Sequence[Score]) -> None:
    """Add singles of what was ``left`` of the screen; the likeliest is fitted thoroughly if it is one of them."""
    if not left:
        return
    leader = found.singles[0]
    standing = without(leader, leader.candidates[0], 0)
    most = enough(found.singles)
    for entry in left:
        name = entry.candidate.name
        if name in leader.names or not found.affordable(name):
            continue
        fits = [extend(standing, entry.candidate, start, QUICK, most) for start in starts_of(entry, found.scores)]
        if fits:
            most = add_single(found, fits, most)
            if found.not_tried.get(name) == ENDED:
                del found.not_tried[name]
    found.singles.sort(key=adjusted)
    if found.singles[0] is not leader:
        found.singles[0] = over_ranges(again(found.singles[0]))
