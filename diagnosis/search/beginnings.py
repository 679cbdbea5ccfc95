"""Effects that begin or end: what explains the recordings when it acts in one spell of their sequence only.

Tests go in sequence and things happen: a joint cracks, a strap slips off, a sensor is knocked. Where nothing that
always acts explains the recordings, every mechanism is screened in every run of successive windows
(`diagnosis.search.runs`), and the strongest are refitted in their spells, at a price (`diagnosis.search.in_spells`).
What comes and goes in every test has an interval of its own in each (`diagnosis.search.in_each`).

What acts for a moment, less than the shortest window, is no mechanism at work but a blow: many mechanisms make one up,
and none can be told by it. It is said, with its instants, and nothing is named.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.solver import fit
from diagnosis.forces.constancy import BLOW, FOR_A_WHILE, Constancy
from diagnosis.progress import Progress
from diagnosis.search.beside import seconds
from diagnosis.search.budget import RESERVED
from diagnosis.search.details import least
from diagnosis.search.found import ALONE, MISSING, Search, adjusted, explains_all, price, settles, survives
from diagnosis.search.in_each import in_each
from diagnosis.search.in_spells import Screened, at_an_instant, in_part, in_spells, price_of_a_spell
from diagnosis.search.refit import Explanation, gain_by_window, with_memory, without
from diagnosis.search.runs import runs
from diagnosis.search.spells import When, holds, in_spell
from diagnosis.search.staged import thorough
from diagnosis.search.weighing import weigh_again
from models.errors import InputError

FEWEST_WINDOWS = 4


def alone(found: Search, progress: Progress) -> Iterator[Search]:
    """Yields the search with one effect in a spell, if that explains everything and the strongest effect does not.

    One that leaves something is kept, to be held against further effects that always act.
    """
    if found.null is None or _settled(found):
        return
    progress("looking for an effect that begins or ends", 0.48)
    with found.work_of_its_own(min(RESERVED, found.spare)):
        found.begun = _begun(found, found.base)
    begun = found.begun
    if begun is not None and begun.best is not None and explains_all(begun.best) and not begun.incomplete:
        yield begun


def beside(found: Search, progress: Progress) -> Iterator[Search]:
    """Yields the search with an effect in a spell alone or beside the one found, if that is likelier than what stands.

    Comes after the search for further effects that always act.
    """
    if found.null is None or (found.best is not None and found.best.in_spell) or _settled(found):
        return
    if found.begun is not None and _likelihood(found.begun) < _likelihood(found):
        yield found.begun
    elif found.best is not None and found.measured.stretches is None:
        progress("looking for effects that begin or end", 0.82)
        several = len(found.best.candidates) > 1
        with found.work_of_its_own(RESERVED):
            if not found.affordable("effects that begin or end"):
                return
            begun = _one_of_several(found, found.best) if several else _begun(found, found.best)
        if begun is not None:
            yield begun


def _begun(found: Search, start: Explanation) -> Search | None:
    """The search with one more effect that does not always act beside those of ``start``, if it counts."""
    through = found.measured.stretches is not None  # runs through whole recordings cannot be cut at an instant
    if through or len(found.measured.windows) < FEWEST_WINDOWS:
        return None
    of_base = found.best is None and start is found.base
    scores = found.scores if of_base else seconds(found, start)
    screened = Screened.of(found, start, scores)
    fits = in_spells(found, start, screened)
    whole = [one for one in found.singles if found.gain(one) >= MISSING] if start is found.base else []
    if found.affordable("effects that come and go in every recording"):
        screens = screened.screens if fits or screened.hides else screened.screens[:1]
        fits += in_each(found, start, screens, [*fits, *whole], screened.cost)
    return _taken(found, [single for single in fits if _needed(found, start, single)])


def _one_of_several(found: Search, best: Explanation) -> Search | None:
    """The search with one of several effects in a spell, where what they leave is not the same everywhere."""
    if len(found.measured.windows) < FEWEST_WINDOWS or not found.measured.identification.forces:
        return None
    if not found.tested(best).flags(least(found, best)):
        return None
    screen, scores = linearise_about(best.fitted), seconds(found, best)
    cost = price_of_a_spell(screen, scores, runs(len(found.measured.windows)))
    fits = []
    for candidate in best.removable:
        others = tuple(one for one in best.candidates if one is not candidate)
        if not found.affordable(at_an_instant(candidate.name)):
            continue
        part = in_part(replace(best, candidates=(*others, candidate)), cost)
        if part is not None and _needed(found, without(best, candidate), single := thorough(part)):
            fits.append(single)
    return _taken(found, fits)


def _taken(found: Search, fits: Sequence[Explanation]) -> Search | None:
    """The search with the best of ``fits``; None where what stood is likelier, or it acts for a moment only."""
    weighed = _weighed(found, sorted(fits, key=adjusted)) if fits else None
    if weighed is None or weighed.best is None:
        return None
    for candidate in weighed.best.candidates:
        if candidate.spell is not None and (when := _for_a_moment(found.measured, candidate.spell)):
            gain = weighed.gain(weighed.best) - (0.0 if found.best is None else found.gain(found.best))
            found.struck = Constancy(BLOW, FOR_A_WHILE, gain, when)
            return None
    return weighed


def _for_a_moment(measured: Measured, spell: When) -> str:
    """When it acts if it ends before the shortest window that tells one motion from another is over, else nothing."""
    acting = [one for one in spell.stages([r.name for r in measured.recordings]) if one.ends > one.begins]
    if measured.lengths is None or any(one.ends - one.begins >= measured.lengths.shortest for one in acting):
        return ""
    return " and ".join(f"from {one.begins:.2f} s to {one.ends:.2f} s of {one.recording}" for one in acting)


def _needed(found: Search, start: Explanation, single: Explanation) -> bool:
    """Whether the effect counts, and that it does not always act does too: against the same one always acting."""
    if adjusted(start) - adjusted(single) < MISSING or not survives(start, single):
        return False
    *others, candidate = single.candidates
    f = single.fitted
    fitted = fit(in_spell(f.misfit, candidate.name, None), f.u, f.states)
    always = Explanation((*others, replace(candidate, spell=None, price=0.0)), fitted)
    if found.best is not None and set(found.best.names) == set(always.names):
        always = min(always, found.best, key=adjusted)
    if adjusted(always) - adjusted(single) < least(found, always):
        return False
    return survives(always, single) or had_not_begun(always, single, candidate.spell)


def had_not_begun(always: Explanation, single: Explanation, spell: When | None) -> bool:
    """Whether one window says that an effect does not always act, which others have: it had not begun there, or ended.

    The effect does not act in all of that window, which fits to the noise so, and badly with the effect acting always.
    """
    gains = gain_by_window(always, single)
    window = int(np.argmax(gains))
    rest = adjusted(always) - adjusted(single) - float(gains[window])
    if spell is None or holds(single.measured, spell, window):
        return False
    return gains[window] >= ALONE * MISSING and rest > -MISSING and settles(always, single)


def _settled(found: Search) -> bool:
    """Whether one effect that always acts explains everything, and events repeat with it.

    Events that scatter may be a law that changes.
    """
    if found.best is None or found.outside is not None or len(found.best.candidates) > 1:
        return False
    if found.errors.scatters or not explains_all(found.best):
        return False
    if not found.measured.identification.forces:
        return True
    return not found.tested(found.best).flags(least(found, found.best))


def _weighed(found: Search, fits: Sequence[Explanation]) -> Search | None:
    """The search with the best of ``fits``, under errors estimated with it; None where what stood is likelier."""
    before = found.best
    if before is not None and adjusted(fits[0]) >= adjusted(before):
        return None
    trial = replace(found, best=fits[0], tried=[*fits, *([before] if before is not None else [])], outside=None)
    weigh_again(trial)
    if trial.best is None or not trial.best.in_spell:
        return None
    if before is not None and _likelihood(trial) >= _likelihood(found):
        return None
    for candidate in trial.best.candidates:  # what stood in for the one that begins is needed no more
        rest = without(trial.best, candidate)
        if rest.in_spell and adjusted(rest) - adjusted(trial.best) < MISSING:
            trial.best = rest
    for simpler in others_in_the_spell(trial.best):
        if adjusted(simpler) - adjusted(trial.best) < MISSING:
            trial.best = simpler
            break
    trial.best = with_memory(thorough(trial.best))
    return trial


def others_in_the_spell(best: Explanation) -> Iterator[Explanation]:
    """Yields each effect that always acts in the spell of the one beside it, and alone.

    Where it is the one that begins, always acting it takes too little, and another one makes up for the rest.
    """
    *others, begins = best.candidates
    if begins.spell is None:
        return
    for other in others:
        f = without(best, begins, 0).fitted
        staged = replace(other, spell=begins.spell, price=begins.price)
        try:
            yield Explanation(
                (*(one for one in others if one is not other), staged),
                fit(in_spell(f.misfit, other.name, begins.spell), f.u, f.states),
            )
        except InputError:  # it cannot change within a recording
            continue


def _likelihood(found: Search) -> float:
    """-2 log likelihood under errors of its own, with what the details cost."""
    return found.errors.loss + sum(price(c) for c in found.chosen.candidates)
