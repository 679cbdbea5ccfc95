"""Effects that come and go in every test: a strap that tightens, a guide that engages, at instants of its own in each.

Screened as in runs of the whole sequence (`diagnosis.search.runs`), with one run of windows in every recording, or
none: with one amplitude for all, the run of each recording in which the statistic of all together is largest, the
others held, in turn, from all windows on. As every recording has a run to choose, each costs what the choice of one
spell does.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.measured import Measured
from diagnosis.fit.linearisation import Linearisation
from diagnosis.search.asked import asked_for
from diagnosis.search.candidates import Candidate
from diagnosis.search.found import MISSING, Search, adjusted, settles
from diagnosis.search.refit import QUICK, Explanation, again, extend, gain_by_window
from diagnosis.search.runs import FEWEST, runs_of
from diagnosis.search.screen import Score
from diagnosis.search.spells import ALWAYS, NEVER, InEach, interval_of
from diagnosis.search.staged import moved, refitted_in, thorough
from diagnosis.search.weighing import by_white_noise
from models.base import FloatArray
from models.errors import InputError

MOST, TURNS = 3, 4


@dataclass(frozen=True)
class InOwnRuns:
    """One mechanism's statistic with one run of windows in each recording, its amplitude, and the runs."""

    score: Score
    statistic: float
    amplitude: float
    spell: InEach


def in_each(
    found: Search, start: Explanation, screens: Sequence[tuple[Linearisation, Sequence[Score]]],
    known: Sequence[Explanation], cost: float,
) -> list[Explanation]:  # fmt: skip
    """The explanation with one more mechanism in an interval of each recording, the best first.

    ``screens``: under the errors as they are and against white noise; ``known``: the same with one more that always
    acts or does in one spell, than which each must be likelier; ``cost``: the price of one spell.
    """
    m = found.measured
    moving = np.unique(m.recording_of).size
    if moving < 2:
        return []
    price = cost * moving
    bar = min(adjusted(one) for one in (start, *known)) - MISSING
    fits = list(_from_known(known, price))
    fits += _from_screen(found, start, [in_own_runs(screen, scores, m) for screen, scores in screens], price)
    leader, *others = _of_one_name_each(fits) or [start]
    if leader is start:
        return []
    best = thorough(leader)
    if not _in_each(best) or adjusted(best) >= bar:
        return []
    best = without_idle(best, cost)
    others = [again(in_its_spell) for one in others[:MOST] if (in_its_spell := _as(one, best)) is not None]
    return sorted((one for one in (best, *others) if _in_each(one) and adjusted(one) < bar), key=adjusted)


def without_idle(single: Explanation, cost: float) -> Explanation:
    """Without the instants of recordings that do not clearly ask for them: where it might as well act always or never.

    Where only one recording asks, it is a spell of the sequence.
    """
    for r in range(len(single.measured.recordings)):
        *others, candidate = single.candidates
        assert isinstance(candidate.spell, InEach)
        intervals = candidate.spell.intervals
        if intervals[r] in (ALWAYS, NEVER):
            continue
        cheaper = replace(single, candidates=(*others, replace(candidate, price=candidate.price - cost)))
        whole = [InEach((*intervals[:r], one, *intervals[r + 1 :])) for one in (ALWAYS, NEVER)]
        simpler = [again(refitted_in(cheaper, spell)) for spell in whole]
        if not all(asks_for_instants(single, one) for one in simpler):
            single = min(simpler, key=adjusted)
    return single


def asks_for_instants(single: Explanation, simpler: Explanation) -> bool:
    """Whether more than one window speaks for the instants, or one that fits to the noise with them, badly without."""
    largest = float(gain_by_window(simpler, single).max())
    gain = adjusted(simpler) - adjusted(single)
    return gain - largest >= MISSING or (gain >= MISSING and settles(simpler, single))


def _as(single: Explanation, leader: Explanation) -> Explanation | None:
    """The same mechanism in the intervals found for the leader, None where it cannot change at these."""
    spell = leader.candidates[-1].spell
    try:
        return None if spell is None else refitted_in(single, spell)
    except InputError:
        return None


def _from_known(known: Sequence[Explanation], price: float) -> Iterator[Explanation]:
    """Quick refits of those, in the interval of each recording that asks for the effect.

    Once more with its shape as it is where there is none: a gap may have stood for the times in which it does not act.
    """
    for single in _of_one_name_each(known)[:MOST]:
        candidate = single.candidates[-1]
        for one in (single, without_shape(single)) if len(candidate.unknowns) > 1 else (single,):
            asked = asked_for(_everywhere(one, price))
            if isinstance(asked, InEach) and not asked.is_spell:
                try:
                    yield moved(refitted_in(_everywhere(one, price), asked))
                except InputError:  # it cannot change within a recording
                    break


def _of_one_name_each(known: Sequence[Explanation]) -> list[Explanation]:
    """The best of each mechanism, the best first."""
    by_name: dict[str, Explanation] = {}
    for single in sorted(known, key=adjusted):
        by_name.setdefault(single.candidates[-1].name, single)
    return list(by_name.values())


def without_shape(single: Explanation) -> Explanation:
    """The same with the shape of its last mechanism as it is without one."""
    candidate, u = single.candidates[-1], single.fitted.u.copy()
    names = [x.name for x in single.fitted.misfit.unknowns]
    for x, null in list(zip(candidate.unknowns, candidate.null, strict=True))[1:]:
        u[names.index(x.name)] = null
    return replace(single, fitted=replace(single.fitted, u=u))


def _everywhere(single: Explanation, price: float) -> Explanation:
    """The same as an effect with an interval in each recording, of all those in which it acts now."""
    *others, candidate = single.candidates
    names = [r.name for r in single.measured.recordings]
    stages = candidate.spell.stages(names) if candidate.spell else ()
    spell = InEach(tuple((one.begins, one.ends) for one in stages) or (ALWAYS,) * len(names))
    return replace(single, candidates=(*others, replace(candidate, spell=spell, price=price)))


def _from_screen(
    found: Search, start: Explanation, screened: Sequence[Sequence[InOwnRuns]], price: float
) -> Iterator[Explanation]:
    """Quick refits of the strongest of all screens, those of which an effect that always acts explains less."""
    worth: dict[Candidate, InOwnRuns] = {}
    for screen in screened:
        always = max((one.score.statistic for one in screen), default=0.0)
        for one in screen:
            known = worth.get(one.score.candidate)
            if one.spell.is_spell or one.statistic - price <= always:
                continue
            if known is None or one.statistic > known.statistic:
                worth[one.score.candidate] = one
    for one in sorted(worth.values(), key=lambda entry: -entry.statistic)[:MOST]:
        staged = replace(one.score.candidate, spell=one.spell, price=price)
        try:
            single = extend(start, staged, one.score.starts_from(one.amplitude)[0], QUICK)
            yield moved(by_white_noise(single, found.errors) if found.best is None else single)
        except InputError:  # it cannot change within a recording
            continue


def _in_each(explanation: Explanation) -> bool:
    spell = explanation.candidates[-1].spell
    return isinstance(spell, InEach) and not spell.is_spell


def in_own_runs(screen: Linearisation, scores: Sequence[Score], measured: Measured) -> list[InOwnRuns]:
    """All mechanisms in their best runs, one in each recording or none, the strongest first."""
    recording_of = measured.recording_of
    choices = {r: _rows(recording_of, r) for r in np.unique(recording_of).tolist()}
    found = []
    for one in scores:
        column = _Column.of(screen, one)
        statistic, acting = column.climbed(choices, np.ones(recording_of.size, bool))
        amplitude = float(column.statistics(acting[None])[1][0])
        found.append(InOwnRuns(one, statistic, amplitude, _spell(measured, acting)))
    return sorted(found, key=lambda entry: -entry.statistic)


def _rows(recording_of: NDArray[np.int64], recording: int) -> NDArray[np.bool_]:
    """The windows (n, W) of each run of a recording; of the last row none."""
    ends, window = runs_of(recording_of, recording), np.arange(recording_of.size)
    inside = (ends[:, :1] <= window) & (window <= ends[:, 1:])
    return np.concatenate([inside, np.zeros((1, recording_of.size), bool)])


def _spell(measured: Measured, acting: NDArray[np.bool_]) -> InEach:
    intervals = [NEVER] * len(measured.recordings)
    for r in np.unique(measured.recording_of[acting]).tolist():
        own = np.flatnonzero(acting & (measured.recording_of == r))
        intervals[r] = interval_of(measured, int(own[0]), int(own[-1]))
    return InEach(tuple(intervals))


@dataclass(frozen=True)
class _Column:
    """One mechanism's information (W,), score along the residual (W,) and along the base (W, k), in each window."""

    screen: Linearisation
    information: FloatArray
    along: FloatArray
    path: FloatArray
    side: int

    @classmethod
    def of(cls, screen: Linearisation, score: Score) -> _Column:
        weighted = screen.weights[:, None] * score.column
        return cls(
            screen,
            np.einsum("wm,wm->w", weighted, score.column),
            np.einsum("wm,wm->w", weighted, screen.residual),
            np.einsum("wmi,wm->wi", screen.by_unknown, weighted, optimize=True),
            score.side,
        )

    def statistics(self, acting: NDArray[np.bool_]) -> tuple[FloatArray, FloatArray]:
        """Statistic and amplitude (n,) with the mechanism in these windows (n, W) alone."""
        path = acting @ self.path
        free = acting @ self.information - np.einsum("ni,ij,nj->n", path, self.screen.inverse, path)
        usable = free > FEWEST * max(float(self.information.sum()), 1e-9)
        amount = acting @ self.along - path @ self.screen.inverse @ self.screen.gradient
        amplitude = -amount / np.where(usable, free, np.inf)
        right = usable & ((self.side * amplitude >= 0.0) if self.side else True)
        return np.where(right, amplitude**2 * free, 0.0), amplitude

    def climbed(
        self, choices: Mapping[int, NDArray[np.bool_]], acting: NDArray[np.bool_]
    ) -> tuple[float, NDArray[np.bool_]]:
        """The largest statistic from some windows on, one recording's run changed at a time, with its windows."""
        largest = float(self.statistics(acting[None])[0][0])
        for _ in range(TURNS):
            before = largest
            for rows in choices.values():
                options = (acting & ~rows.any(axis=0)) | rows
                statistic = self.statistics(options)[0]
                if float(statistic.max()) > largest:
                    largest, acting = float(statistic.max()), options[int(np.argmax(statistic))]
            if largest == before:
                break
        return largest, acting
