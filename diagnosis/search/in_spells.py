"""Refits of mechanisms in spells: the strongest of a screen of every mechanism in every run of successive windows.

Many runs are searched, so a spell has a price: how much more of the largest statistic chance brings (its 5 % level,
from noise drawn under the estimated errors) with runs than without. It is taken off the gain, so that an effect in a
spell is named by chance as rarely as one that always acts, and an effect always acting is preferred to it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from diagnosis.fit.linearisation import Linearisation, linearise_about
from diagnosis.search.asked import asked_for
from diagnosis.search.candidates import Candidate
from diagnosis.search.found import MISSING, Search, adjusted, passes_for_white
from diagnosis.search.null import null_distribution
from diagnosis.search.refit import QUICK, Explanation, best_of, extend
from diagnosis.search.runs import InRuns, chance, in_runs, runs
from diagnosis.search.screen import Score
from diagnosis.search.spells import of_windows
from diagnosis.search.staged import moved, refitted_in, thorough
from diagnosis.search.weighing import by_white_noise
from diagnosis.search.white_screen import against_white_noise
from models.base import FloatArray
from models.errors import InputError

FAINT = 8.0
"""Statistic less the price of a spell under which nothing is refitted."""
SHARE, NEAR = 0.25, 0.85
"""Of the strongest statistic, what a mechanism must reach to be refitted; of the largest gain, to be refined."""
MOST, MOST_HIDDEN, MOST_SINGLES, THOROUGH = 6, 3, 2, 3


@dataclass(frozen=True)
class Screened:
    """The screen of an explanation under its errors, and against white noise unless that explains all that is left.

    ``ends`` (R, 2): runs of windows; ``cost``: the price of a spell.
    Scatter of events holds much of a law of them that changes, and so white noise shows it.
    """

    screens: tuple[tuple[Linearisation, Sequence[Score]], ...]
    ends: NDArray[np.int64]
    cost: float

    @cached_property
    def in_runs(self) -> tuple[list[InRuns], ...]:
        """All mechanisms in all runs, by both screens."""
        return tuple(in_runs(screen, scores, self.ends) for screen, scores in self.screens)

    @cached_property
    def hides(self) -> bool:
        """Whether white noise shows more than chance brings under the errors as they are, which may be coloured."""
        if len(self.screens) < 2:
            return False
        (screen, _), (white, scores) = self.screens
        largest = max((float(one.statistic.max(initial=0.0)) for one in self.in_runs[1]), default=0.0)
        return largest > chance(white, scores, self.ends, screen)

    @classmethod
    def of(cls, found: Search, start: Explanation, scores: Sequence[Score]) -> Screened:
        screen = linearise_about(start.fitted)
        screens = [(screen, scores)]
        if not passes_for_white(start, found.errors):
            screens.append(against_white_noise(found, start, [one.candidate for one in scores]))
        ends = runs(len(found.measured.windows))
        return cls(tuple(screens), ends, price_of_a_spell(screen, scores, ends))


def price_of_a_spell(screen: Linearisation, scores: Sequence[Score], ends: NDArray[np.int64]) -> float:
    """What a spell costs: how much larger chance makes the largest statistic with all runs of windows than without."""
    return max(0.0, chance(screen, scores, ends) - null_distribution(screen, scores).band)


def in_spells(found: Search, start: Explanation, screened: Screened) -> list[Explanation]:
    """The explanation with one more mechanism, in its spell, the best first; none that gains too little."""
    ends, cost = screened.ends, screened.cost
    plain, *white = screened.in_runs
    fits = list(quick(found, start, plain, ends, cost))
    hidden: list[Explanation] = []
    if white and (fits or screened.hides):
        hidden = list(quick(found, start, white[0], ends, cost, MOST_HIDDEN))
    fits += hidden
    if start is found.base:
        strongest = (one for one in found.singles[:MOST_SINGLES] if found.affordable(at_an_instant(one.names[0])))
        fits += [single for one in strongest if (single := in_part(one, cost)) is not None]
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


def in_part(single: Explanation, cost: float) -> Explanation | None:
    """The last effect in the run of windows that asks for it, if that gains: begun early, it explains most always."""
    *others, candidate = single.candidates
    spell = asked_for(single)
    staged = replace(single, candidates=(*others, replace(candidate, price=cost)))
    try:
        part = refitted_in(staged, spell)
    except InputError:  # it cannot change within a recording
        return None
    return moved(part) if adjusted(single) - adjusted(part) >= MISSING else None


def quick(
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
                yield in_run(found, start, staged, one.starts(run))
                break
            except InputError:  # it cannot change within a recording
                continue


def in_run(found: Search, start: Explanation, staged: Candidate, coordinates: Sequence[FloatArray]) -> Explanation:
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
