"""What the score says of a weak effect alone: chance brings it as rarely as stated, which the gain of a refit is not.

The null distribution (`diagnosis.search.null`) is that of scores, of models that answer linearly. States that the
recordings hardly tell, such as those of a block on top, answer otherwise: with nothing missing, refits of hysteresis or
an arm in the top layer gained 21 to 25 in 5 of 95 walls, with scores of 0 to 11. Of simulated weak effects the score is
most of the gain.
"""

from __future__ import annotations

from diagnosis.search.candidates import Candidate
from diagnosis.search.found import Search, passes_for_white

SURE = 40.0
"""Evidence from which on an effect is none of chance, whatever its score and the recordings held out say."""


def as_scored(found: Search, candidate: Candidate, gain: float) -> float:
    """The ``gain`` of an effect alone, no larger than its score where it is weak.

    As it is where the screen has no derivative of the effect, as at a threshold or in a part of the recordings, and
    where errors other than white noise may hold what it does.
    """
    start = found if found.at_null is None else found.at_null
    entry = next((one for one in start.scores if one.candidate is candidate), None)
    if gain >= SURE or entry is None or not entry.slope or not passes_for_white(start.base, start.errors):
        return gain
    return min(gain, entry.statistic)
