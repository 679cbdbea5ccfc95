"""Effects that begin or end: what explains the recordings when it acts in one spell of their sequence only.

Tests go in sequence and things happen: a joint cracks, a strap slips off, a sensor is knocked. Where nothing that
always acts explains the recordings, every mechanism is screened in every run of successive windows
(`diagnosis.search.runs`), and the strongest are refitted in their spells (`diagnosis.search.staged`). What comes and
goes in every test has an interval of its own in each (`diagnosis.search.in_each`).

Many runs are searched, so a spell has a price: how much more of the largest statistic chance brings (its 5 % level,
from noise drawn under the estimated errors) with runs than without. It is taken off the gain, so that an effect in a
spell is named by chance as rarely as one that always acts, and an effect always acting is preferred to it.

What acts for a moment, less than the shortest window, is no mechanism at work but a blow: many mechanisms make one up,
and none can be told by it. It is said, with its instants, and nothing is named.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.measured import Measured
from diagnosis.fit.linearisation import Linearisation, linearise_about
from diagnosis.fit.solver import fit
from diagnosis.forces.constancy import BLOW, FOR_A_WHILE, Constancy
from diagnosis.progress import Progress
from diagnosis.search.asked import asked_for
from diagnosis.search.beside import seconds
from diagnosis.search.budget import RESERVED, SHARED
from diagnosis.search.candidates import Candidate
from diagnosis.search.details import least
from diagnosis.search.found import ALONE, MISSING, Search, adjusted, explains_all, price, settles, survives
from diagnosis.search.in_each import in_each
from diagnosis.search.null import null_distribution
from diagnosis.search.refit import QUICK, Explanation, best_of, extend, gain_by_window, with_memory, without
from diagnosis.search.runs import InRuns, chance, in_runs, runs
from diagnosis.search.screen import Score
from diagnosis.search.spells import When, holds, in_spell, of_windows
from diagnosis.search.staged import moved, refitted_in, thorough
from diagnosis.search.weighing import by_white_noise, weigh_again
from diagnosis.search.white_screen import against_white_noise
from models.base import FloatArray
from models.errors import InputError

FAINT = 8.0
"""Statistic less the price of a spell under which nothing is refitted."""
SHARE, NEAR = 0.25, 0.85
"""Of the strongest statistic, what a mechanism must reach to be refitted; of the largest gain, to be refined."""
MOST, MOST_HIDDEN, MOST_SINGLES, THOROUGH = 6, 3, 2, 3
FEWEST_WINDOWS = 4


def alone(found: Search, progress: Progress) -> Iterator[Search]:
    """Yields the search with one effect in a spell, if that explains everything and the strongest effect does not.

    One that leaves something is kept, to be held against further effects that always act.
    """
    if found.null is None or _settled(found):
        return
    progress("looking for an effect that begins or ends", 0.48)
    with found.work_of_its_own(min(RESERVED, SHARED * found.left)):
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
    elif found.best is not None and len(found.best.candidates) == 1:
        progress("looking for effects that begin or end", 0.82)
        with found.work_of_its_own(RESERVED):
            begun = _begun(found, found.best)
        if begun is not None:
            yield begun
    elif found.best is not None and len(found.best.candidates) > 1:
        progress("looking for effects that begin or end", 0.82)
        with found.work_of_its_own(RESERVED):
            begun = _one_of_several(found, found.best)
        if begun is not None:
            yield begun


def _begun(found: Search, start: Explanation) -> Search | None:
    """The search with one more effect that does not always act beside those of ``start``, if it counts."""
    through = found.measured.stretches is not None  # runs through whole recordings cannot be cut at an instant
    if through or len(found.measured.windows) < FEWEST_WINDOWS:
        return None
    of_base = found.best is None and start is found.base
    scores = found.scores if of_base else seconds(found, start)
    screened = _Screened.of(found, start, scores)
    fits = _in_spells(found, start, screened)
    whole = [one for one in found.singles if found.gain(one) >= MISSING] if start is found.base else []
    if found.affordable("effects that come and go in every recording"):
        fits += in_each(found, start, screened.both, [*fits, *whole], screened.cost)
    return _taken(found, [single for single in fits if _needed(found, start, single)])


def _one_of_several(found: Search, best: Explanation) -> Search | None:
    """The search with one of several effects in a spell, where what they leave is not the same everywhere."""
    through = found.measured.stretches is not None
    if through or len(found.measured.windows) < FEWEST_WINDOWS or not found.measured.identification.forces:
        return None
    if not found.tested(best).flags(least(found, best)):
        return None
    screen, scores = linearise_about(best.fitted), seconds(found, best)
    cost = _price(screen, scores, runs(len(found.measured.windows)))
    fits = []
    for candidate in best.candidates:
        others = tuple(one for one in best.candidates if one is not candidate)
        if not found.affordable(at_an_instant(candidate.name)):
            continue
        part = _in_part(replace(best, candidates=(*others, candidate)), cost)
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


@dataclass(frozen=True)
class _Screened:
    """The screen of an explanation under its errors and against white noise, and the price of a spell.

    Scatter of events holds much of a law of them that changes, and so white noise shows it.
    """

    both: tuple[tuple[Linearisation, Sequence[Score]], ...]
    ends: NDArray[np.int64]
    cost: float

    @classmethod
    def of(cls, found: Search, start: Explanation, scores: Sequence[Score]) -> _Screened:
        screen = linearise_about(start.fitted)
        white = against_white_noise(found, start, [one.candidate for one in scores])
        ends = runs(len(found.measured.windows))
        return cls(((screen, scores), white), ends, _price(screen, scores, ends))

    def in_runs(self) -> list[list[InRuns]]:
        return [in_runs(screen, scores, self.ends) for screen, scores in self.both]


def _price(screen: Linearisation, scores: Sequence[Score], ends: NDArray[np.int64]) -> float:
    """What a spell costs: how much larger chance makes the largest statistic with all runs of windows than without."""
    return max(0.0, chance(screen, scores, ends).band - null_distribution(screen, scores).band)


def _in_spells(found: Search, start: Explanation, screened: _Screened) -> list[Explanation]:
    """The explanation with one more mechanism, in its spell, the best first; none that gains too little."""
    ends, cost = screened.ends, screened.cost
    plain, white = screened.in_runs()
    fits = list(_quick(found, start, plain, ends, cost))
    hidden = list(_quick(found, start, white, ends, cost, MOST_HIDDEN))
    fits += hidden
    if start is found.base:
        strongest = (one for one in found.singles[:MOST_SINGLES] if found.affordable(at_an_instant(one.names[0])))
        fits += [single for one in strongest if (single := _in_part(one, cost)) is not None]
    fits.sort(key=adjusted)
    if not fits:
        return []
    enough = max(MISSING, NEAR * (adjusted(start) - adjusted(fits[0])))
    near = [single for single in _different(fits) if adjusted(start) - adjusted(single) >= enough][:THOROUGH]
    # a sensor that was knocked passes for noise that drifts: which is likelier is told under errors of its own
    near += [e for e in hidden[:1] if e.names not in [one.names for one in near]]
    wanted = (single for single in near if found.affordable(at_an_instant(single.names[-1])))
    return sorted((thorough(single) for single in wanted), key=adjusted)


def at_an_instant(name: str) -> str:
    """What was not tried of a mechanism."""
    return f"{name} from or to an instant"


def _different(fits: Sequence[Explanation]) -> list[Explanation]:
    """Without those of the same mechanism in the same spell: both screens find them."""
    found: dict[tuple[object, ...], Explanation] = {}
    for one in fits:
        last = one.candidates[-1]
        found.setdefault((last.name, tuple(last.held.items()), last.spell), one)
    return list(found.values())


def _in_part(single: Explanation, cost: float) -> Explanation | None:
    """The last effect in the run of windows that asks for it, if that gains: begun early, it explains most always."""
    *others, candidate = single.candidates
    spell = asked_for(single)
    staged = replace(single, candidates=(*others, replace(candidate, price=cost)))
    try:
        part = refitted_in(staged, spell)
    except InputError:  # it cannot change within a recording
        return None
    return moved(part) if adjusted(single) - adjusted(part) >= MISSING else None


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


def _quick(
    found: Search,
    start: Explanation,
    screened: Sequence[InRuns],
    ends: NDArray[np.int64],
    cost: float,
    most: int = MOST,
) -> Iterator[Explanation]:
    """Quick refits of the strongest mechanisms, each in the run in which its statistic is largest.

    None where by the screen something that always acts explains as much: to what began late the windows before that
    say no.
    """
    m = found.measured
    strongest = sorted(screened, key=lambda one: -float(one.statistic.max()))
    largest = float(strongest[0].statistic.max()) if strongest else 0.0
    if largest - cost <= max((one.score.statistic for one in screened), default=0.0):
        return
    whole = _of_whole_recordings(m.recording_of, ends)
    for one in strongest[:most]:
        name = one.score.candidate.name
        if float(one.statistic.max()) < max(FAINT + cost, SHARE * largest) or not found.affordable(at_an_instant(name)):
            return
        for allowed in (np.ones(len(ends), bool), whole):
            if not allowed.any():
                continue
            run = int(np.argmax(np.where(allowed, one.statistic, -1.0)))
            staged = replace(one.score.candidate, spell=of_windows(m, *ends[run].tolist()), price=cost)
            try:
                yield _in_run(found, start, staged, one.starts(run))
                break
            except InputError:  # it cannot change within a recording
                continue


def _in_run(found: Search, start: Explanation, staged: Candidate, coordinates: Sequence[FloatArray]) -> Explanation:
    """Quick refits in a spell, and again in the run of windows that they ask for."""
    single = best_of([extend(start, staged, u, QUICK) for u in coordinates])
    if found.best is None:
        single = by_white_noise(single, found.errors)
    return moved(single)


def _of_whole_recordings(recording_of: NDArray[np.int64], ends: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Which runs (R, 2) begin and end with recordings."""
    new = np.flatnonzero(np.diff(recording_of)) + 1
    firsts, lasts = [0, *new.tolist()], [*(new - 1).tolist(), recording_of.size - 1]
    return np.isin(ends[:, 0], firsts) & np.isin(ends[:, 1], lasts)


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
            yield Explanation((staged,), fit(in_spell(f.misfit, other.name, begins.spell), f.u, f.states))
        except InputError:  # it cannot change within a recording
            continue


def _likelihood(found: Search) -> float:
    """-2 log likelihood under errors of its own, with what the details cost."""
    return found.errors.loss + sum(price(c) for c in found.chosen.candidates)
