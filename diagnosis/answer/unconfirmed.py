"""A weak effect has to make the recordings held out likelier too; else it is a suspect and no name.

Chance that leads parameters astray by a gain G (2 log likelihood) on the recordings fitted to makes others that tell
as much less likely by about G; an effect that acts makes them likelier by about its evidence.
"""

from __future__ import annotations

from dataclasses import replace

from diagnosis.answer.heldout import likelier
from diagnosis.data.measured import Measured
from diagnosis.search.evidence import evidence
from diagnosis.search.found import Doubted, Search

SURE = 40.0
"""Evidence from which on an effect is none of chance, whatever is held out."""


def unless_unconfirmed(found: Search, held: Measured | None) -> Search:
    """The search; without its one effect where that is weak and makes recordings held out less likely.

    As it stood before any effect then, with what is ``doubted``. What begins or ends need not act in recordings held
    out, and of several effects each was weighed beside the others.
    """
    best = found.best
    if held is None or best is None or len(best.candidates) > 1 or best.in_spell:
        return found
    gain = evidence(found)[0]
    if gain >= SURE or likelier(found.base, best, held, found.errors) >= 0.0:
        return found
    return replace(found.at_null or found, best=None, outside=None, doubted=Doubted(best, gain))
