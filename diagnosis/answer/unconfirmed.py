"""A weak effect needs a score beyond chance and has to make the recordings held out likelier; else it is a suspect.

Chance that leads parameters astray by a gain G (2 log likelihood) on the recordings fitted to makes others that tell
as much less likely by about G; an effect that acts makes them likelier by about its evidence.
"""

from __future__ import annotations

from dataclasses import replace

from diagnosis.answer.by_score import SURE, as_scored
from diagnosis.answer.heldout import likelier
from diagnosis.answer.judgement import CHANCE, FITTED, REFIT, p_value
from diagnosis.data.measured import Measured
from diagnosis.search.evidence import evidence
from diagnosis.search.found import Doubted, Search


def unless_unconfirmed(found: Search, held: Measured | None) -> Search:
    """The search; without its one effect where that is weak and chance brings its score, or where it makes recordings
    held out less likely.

    As it stood before any effect then, with what is ``doubted``. What begins or ends need not act in recordings held
    out, and of several effects each was weighed beside the others.
    """
    best = found.best
    if best is None or len(best.candidates) > 1 or best.in_spell or (gain := evidence(found)[0]) >= SURE:
        return found
    if p_value(found, as_scored(found, best.candidates[0], gain)) >= CHANCE:
        rests_on = REFIT
    elif held is not None and likelier(found.base, best, held, found.errors) < 0.0:
        rests_on = FITTED
    else:
        return found
    return replace(found.at_null or found, best=None, outside=None, doubted=Doubted(best, gain, rests_on))
