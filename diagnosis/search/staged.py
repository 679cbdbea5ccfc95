"""Refits of an effect that does not always act: parameters with its spell held, then the spell, in turn.

First the run of windows that the recordings ask for (`diagnosis.search.asked`), last the instants within the windows
(`diagnosis.search.instants`).
"""

from __future__ import annotations

from dataclasses import replace

from diagnosis.search.asked import asked_for
from diagnosis.search.for_a_while import exact
from diagnosis.search.instants import WHOLE, ends_of
from diagnosis.search.refit import QUICK, Explanation, again, best_of, further, ways
from diagnosis.search.spells import InEach, When, in_spell
from models.errors import InputError

TURNS = 3


def refitted_in(single: Explanation, spell: When) -> Explanation:
    """The same model refitted with its last mechanism in another spell. Raises InputError where that cannot change."""
    *others, candidate = single.candidates
    moved = replace(single.fitted, misfit=in_spell(single.fitted.misfit, candidate.name, spell))
    single = Explanation((*others, replace(candidate, spell=spell)), moved)
    return best_of([further(way, QUICK) for way in ways(single)])


def moved(single: Explanation) -> Explanation:
    """The same mechanism in the run of windows that asks for it, refitted, until that stays."""
    for _ in range(TURNS):
        spell = asked_for(single)
        if spell == single.candidates[-1].spell:
            break
        try:
            other = refitted_in(single, spell)
        except InputError:
            break
        if with_instants(other) >= with_instants(single):
            break
        single = other
    return single


def thorough(single: Explanation) -> Explanation:
    """Refitted thoroughly, with the instants found within the windows."""
    single = moved(single)
    for _ in range(TURNS):
        candidate = single.candidates[-1]
        if candidate.spell is None:
            break
        try:
            spell = _exact(single, candidate.name, candidate.spell)
        except InputError:  # acts in whole recordings only
            break
        if spell == candidate.spell:
            break
        single = min(single, refitted_in(single, spell), key=with_instants)
        if single.candidates[-1].spell != spell:
            break
    return again(single)


def _exact(single: Explanation, name: str, spell: When) -> When:
    """The spell with its instants found within the windows."""
    if not isinstance(spell, InEach):
        return ends_of(single, name, spell).spell
    f = single.fitted
    return InEach(tuple(exact(f.frozen, name, f.states, r, one) for r, one in enumerate(spell.intervals)))


def with_instants(single: Explanation) -> float:
    """Loss with what the instants of the last mechanism's spell cost: spells of whole recordings are simpler."""
    spell = single.candidates[-1].spell
    return single.loss + (WHOLE * spell.instants if spell is not None else 0.0)
