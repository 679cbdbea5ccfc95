"""Which mechanisms are missing: refits of the strongest, forward selection, backward check, rivals.

The fit of the base may be stuck; a rival's optimum then shows it, and the base is refitted from
there. An effect counts when its gain in 2 log likelihood passes the threshold and still does without
the window that speaks loudest for it (and, with more than two recordings, without any one of them).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from diagnosis.candidates import Candidate
from diagnosis.fit import fit
from diagnosis.memory import counted
from diagnosis.null import Null, null_distribution
from diagnosis.outside import outside
from diagnosis.refit import Explanation, again, best_of, extend, from_other, gain_by_window, without
from diagnosis.result import Constancy
from diagnosis.screen import Score, open_screen, score
from models.base import FloatArray

MISSING = 15.0
"""Gain in 2 log likelihood that one more mechanism must bring."""
DETAIL = 0.0025
"""Share of the evidence that the details of a named effect's law may leave: 5 % of its amplitude."""
GAP = 10.0
"""Rivals: all within this gain of the best."""
PER_SHAPE = 2.0
"""What every unknown beyond the first costs a mechanism."""
WORTH = 4.0
"""Screen statistic under which a refit is not tried (the strongest FEWEST are tried all the same)."""
FEWEST, MOST = 5, 16
SHARE_OF_FIRST, SHARE_OF_SECOND = 0.05, 0.25
"""Of the strongest statistic: what a first or a further mechanism must reach to be refitted."""
HOPELESS = 8.0
"""Statistic of the strongest further mechanism under which an adequate model is not extended."""
TIE = 2.0
"""Gain within which two explanations are one for the data: the earlier in the catalogue is named."""
QUICK = 6
"""Iterations of a first refit; the strongest are then taken further."""
THOROUGH = 2
RECOUNTS = 4
NEAR, NEAR_ADEQUATE = 0.2, 0.6
"""Share of the leader's gain from which a single is refitted from the leader's optimum too."""
FIRST_POOL = 3
SECOND_TRIES = 6
MOST_EFFECTS = 3
POOL_SHARE = 0.25
"""Singles whose gain is this share of the best one's are tried as parts of a pair."""
ADEQUATE = 1.08
"""Misfit per sample under which one effect is enough to start a pair from."""

Progress = Callable[[str, float], None]


@dataclass
class Search:
    """What has been found so far; it grows, so that a stopped search leaves its state."""

    base: Explanation
    candidates: tuple[Candidate, ...]
    scores: list[Score] = field(default_factory=list)
    null: Null | None = None
    singles: list[Explanation] = field(default_factory=list)
    tried: list[Explanation] = field(default_factory=list)
    best: Explanation | None = None
    outside: Constancy | None = None
    """A force outside the library that explains what the best single leaves."""

    @property
    def chosen(self) -> Explanation:
        return self.base if self.best is None else self.best

    @property
    def more(self) -> float:
        """What a further effect, or a departure from constancy, must bring."""
        return MISSING + DETAIL * max(self.gain(self.chosen), 0.0)

    def gain(self, explanation: Explanation) -> float:
        """Gain over the base, less what shape parameters cost."""
        return self.base.loss - adjusted(explanation)


def adjusted(explanation: Explanation) -> float:
    """Loss plus the price of parameters beyond the first of each mechanism."""
    return explanation.loss + PER_SHAPE * (explanation.size - len(explanation.candidates))


def survives(before: Explanation, after: Explanation, threshold: float = MISSING) -> bool:
    """Whether the gain passes without its loudest window and, of more than two, any one recording."""
    gains = gain_by_window(before, after)
    total = before.loss - adjusted(after) + (adjusted(before) - before.loss)
    loudest = float(gains.max(initial=0.0))
    if total - loudest < threshold:
        return False
    measured = after.fitted.misfit.predictor.measured
    if len(measured.recordings) > 2:
        each = [float(gains[measured.recording_of == r].sum()) for r in range(len(measured.recordings))]
        return total - max(each) >= 0.3 * threshold
    return True


def search(base: Explanation, candidates: Sequence[Candidate], progress: Progress) -> Iterator[Search]:
    """Yields the growing search after each stage; the last one is the answer."""
    found = Search(base, tuple(candidates))
    yield found
    progress("screening the mechanisms", 0.1)
    _singles(found, progress)
    yield found
    if not found.singles:
        return
    take_best_single(found)
    if found.best is None:
        return
    yield found
    _pairs(found, progress)
    yield found
    _more(found, progress)
    yield found
    _backward(found)
    settle_ties(found)
    found.best = None if found.best is None else with_memory(again(found.best))
    yield found


def take_best_single(found: Search) -> None:
    """The strongest single so far, if it counts."""
    best = min(found.singles, key=adjusted, default=None)
    if best is not None and found.gain(best) >= MISSING and survives(found.base, best):
        found.best = best


def worth_a_refit(scores: Sequence[Score], fewest: int, share: float) -> list[Score]:
    """Those whose statistic is worth it beside the strongest one's, and the ``fewest`` first in any case."""
    largest = max((s.statistic for s in scores), default=0.0)
    least = max(WORTH, share * largest)
    return [s for k, s in enumerate(scores) if s.starts and (k < fewest or s.statistic >= least)]


def _refits(explanation: Explanation, scores: Sequence[Score], fewest: int, most: int) -> list[Explanation]:
    """The strongest of a screen, each from its starts."""
    wanted = worth_a_refit(scores, fewest, SHARE_OF_SECOND)[:most]
    fits = [best_of([extend(explanation, s.candidate, start, QUICK) for start in s.starts]) for s in wanted]
    fits.sort(key=adjusted)
    return [again(e) if k < THOROUGH else e for k, e in enumerate(fits)]


def _singles(found: Search, progress: Progress) -> None:
    opened = open_screen(found.base.fitted)
    found.scores = score(opened, found.candidates)
    found.null = null_distribution(opened, found.scores)
    wanted = worth_a_refit(found.scores, FEWEST, SHARE_OF_FIRST)[:MOST]
    for k, entry in enumerate(wanted):
        progress(f"refitting {entry.candidate.name}", 0.15 + 0.3 * k / len(wanted))
        fits = [extend(found.base, entry.candidate, start, QUICK) for start in entry.starts]
        found.singles.append(best_of(fits))
    found.singles.sort(key=adjusted)
    if not found.singles:
        return
    leader = found.singles[0] = again(found.singles[0])
    if found.gain(leader) < MISSING:
        return
    restarted = from_other(found.base, leader)
    if restarted.loss < found.base.loss - 1.0:
        found.base = restarted
    near = NEAR_ADEQUATE if adequate(leader) else NEAR
    for k, single in enumerate(found.singles[1:], start=1):
        if found.gain(single) > near * found.gain(leader):
            found.singles[k] = from_other(again(single) if k < THOROUGH else single, leader)
    found.singles.sort(key=adjusted)
    found.singles[0] = with_memory(found.singles[0])
    found.tried += found.singles


def with_memory(explanation: Explanation) -> Explanation:
    """The same model refitted with the impacts before each window counted along its own motion, if that is better.

    Counts and parameters depend on each other: repeated until the loss stays.
    """
    fitted = explanation.fitted
    for _ in range(RECOUNTS):
        before = fitted.loss
        point = fitted.misfit.point(fitted.u, fitted.states)
        measured = counted(fitted.misfit.predictor, point)
        misfit = replace(fitted.misfit, predictor=replace(fitted.misfit.predictor, measured=measured))
        fitted = fit(misfit, fitted.u, fitted.states)
        if abs(before - fitted.loss) < 0.5:
            break
    return replace(explanation, fitted=fitted) if fitted.loss < explanation.loss else explanation


def misfit_per_sample(explanation: Explanation) -> float:
    """Squared whitened residual per sample, without the worst tenth (at least one) of the windows."""
    misfit = explanation.fitted.misfit
    residual = misfit.residuals([misfit.point(explanation.fitted.u, explanation.fitted.states)])[0]
    each = np.sort(np.sum(residual**2, axis=1) / misfit.predictor.measured.count)
    return float(np.mean(each[: max(1, int(0.9 * each.size))]))


def adequate(explanation: Explanation) -> bool:
    """Whether the misfit is that of the noise."""
    return misfit_per_sample(explanation) < ADEQUATE


def pool(found: Search) -> list[Explanation]:
    """The best single of each of the strongest classes."""
    if found.best is not None and adequate(found.best):
        return [found.best]
    best = found.gain(found.singles[0])
    chosen: list[Explanation] = []
    for single in found.singles:
        if len(chosen) == FIRST_POOL or found.gain(single) < max(MISSING, POOL_SHARE * best):
            break
        if single.classes[0] not in {c.classes[0] for c in chosen}:
            chosen.append(single)
    return chosen


def _pairs(found: Search, progress: Progress) -> None:
    if found.best is None:
        return
    if not adequate(found.best):
        progress("comparing with laws outside the library", 0.48)
        found.outside = outside(found.best, seconds(found, found.best))
    singles = pool(found) if found.outside is None else [found.best]
    pairs: list[Explanation] = []
    for k, single in enumerate(singles):
        progress(f"looking for a second effect beside {single.names[0]}", 0.5 + 0.25 * k / len(singles))
        pairs += _extended(found, single)
    if not pairs:
        return
    if found.outside is not None:
        if not any(adequate(e) for e in pairs):
            return
        found.outside = None
    found.tried += pairs
    pair = min(pairs, key=adjusted)
    alone = best_of([e for e in found.singles if e.names[0] in pair.names] or [found.best])
    if adjusted(found.best) - adjusted(pair) >= found.more and survives(alone, pair, found.more):
        found.best = again(pair)


def seconds(found: Search, explanation: Explanation) -> list[Score]:
    """The screen of mechanisms of other classes beside those of an explanation."""
    others = [c for c in found.candidates if c.effect_class not in explanation.classes]
    return score(open_screen(explanation.fitted), others)


def _extended(found: Search, explanation: Explanation) -> list[Explanation]:
    """Refits with one more mechanism of another class."""
    scores = seconds(found, explanation)
    if adequate(explanation) and max((s.statistic for s in scores), default=0.0) < HOPELESS:
        return []
    return _refits(explanation, scores, 2, SECOND_TRIES)


def _more(found: Search, progress: Progress) -> None:
    """A third effect, by the same rule."""
    while found.best is not None and 2 <= len(found.best.candidates) < MOST_EFFECTS:
        progress("looking for a further effect", 0.8)
        further = _extended(found, found.best)
        if not further:
            return
        found.tried += further
        best = min(further, key=adjusted)
        if adjusted(found.best) - adjusted(best) < found.more or not survives(found.best, best, found.more):
            return
        found.best = best


def _backward(found: Search) -> None:
    """Drop what is no longer needed; try other mechanisms in the place of each effect."""
    if found.best is None or len(found.best.candidates) < 2:
        return
    dropping = True
    while dropping and len(found.best.candidates) > 1:
        dropping = False
        for candidate in found.best.candidates:
            rest = without(found.best, candidate)
            if adjusted(rest) - adjusted(found.best) < found.more:
                found.best, dropping = rest, True
                break
    if len(found.best.candidates) < 2:
        return
    for candidate in found.best.candidates:
        rest = without(found.best, candidate)
        found.tried += _extended(found, rest)
    same = [e for e in found.tried if len(e.candidates) == len(found.best.candidates)]
    better = min(same, key=adjusted)
    if adjusted(better) < adjusted(found.best):
        found.best = better


def settle_ties(found: Search) -> None:
    """Name the earlier in the catalogue of explanations that the data cannot tell apart at all."""
    if found.best is None:
        return
    place = {c: k for k, c in enumerate(found.candidates)}
    same = [e for e in [found.best, *found.tried] if len(e.candidates) == len(found.best.candidates)]
    near = [e for e in same if adjusted(e) - adjusted(found.best) < TIE]
    found.tried.append(found.best)
    found.best = min(near, key=lambda e: (sum(place[c] for c in e.candidates), adjusted(e)))


def rivals(found: Search) -> list[tuple[Explanation, Candidate, float]]:
    """Explanations with one effect exchanged, within the gap: (explanation, the other effect, gap)."""
    if found.best is None:
        return []
    best, near = found.best, []
    seen = set(best.names)
    for other in sorted(found.tried, key=adjusted):
        if len(other.candidates) != len(best.candidates):
            continue
        gap = adjusted(other) - adjusted(best)
        new = [c for c in other.candidates if c.name not in best.names]
        if gap > GAP or len(new) != 1 or new[0].name in seen:
            continue
        seen.add(new[0].name)
        near.append((other, new[0], max(gap, 0.0)))
    return near


def evidence(found: Search) -> FloatArray:
    """Gain of each effect over the best model without it (n_effects,)."""
    if found.best is None:
        return np.zeros(0)
    if len(found.best.candidates) == 1:
        return np.array([found.base.loss - found.best.loss])
    return np.array([without(found.best, c).loss - found.best.loss for c in found.best.candidates])
