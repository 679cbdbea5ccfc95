"""Effects one after the other: every mechanism is tried, the best are looked at closely, chance is weighed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from diagnosis.fit.unknowns import Unknown
from diagnosis.outcomes.bank import Bank, Beside, Drawn, Kernels, Spread, filled, with_points
from diagnosis.outcomes.candidates import Repair
from diagnosis.outcomes.evidence import cannot_be_excluded, chance_of, gain, null_gains
from diagnosis.outcomes.ladder import Ladder
from diagnosis.progress import Progress
from grids.recordings.outcomes import Outcomes
from grids.specimen import Specimen
from models.base import FloatArray
from models.errors import InputError

SURE = 0.01
"""An effect counts when chance brings its gain, in the search for it, more rarely than this."""
EXCLUDED = 0.05
"""A rival stays while its own truth would bring the winner's lead more often than this."""
MOST = 2
"""Effects, at most."""
REFINED = 4
"""Mechanisms that are looked at closely, for each effect."""
FIRST, SCREENED, CLOSER = 32, 8, 24
"""Points of the base's first round, of each mechanism's screen, and of each closer round."""
CLOSER_ROUNDS = 3


@dataclass
class Found:
    """A set of effects with its bank, and the banks of its rivals for the last of them."""

    effects: tuple[Repair, ...]
    bank: Bank
    gain: float = 0.0
    p_value: float = 1.0
    rivals: list[tuple[Repair, float]] = field(default_factory=list)


@dataclass
class Search:
    """What has been filled: the base, the accepted steps, and every closely looked-at alternative."""

    specimen: Specimen
    outcomes: Outcomes
    ladder: Ladder
    base: Bank
    steps: list[Found] = field(default_factory=list)
    others: list[Found] = field(default_factory=list)
    p_value: float = 1.0
    not_tried: dict[str, str] = field(default_factory=dict)
    finished: bool = True

    @property
    def chosen(self) -> Found:
        return self.steps[-1] if self.steps else Found((), self.base)


def one_more(
    found: Search, possible: Sequence[Repair], flags: FloatArray, rng: np.random.Generator, progress: Progress
) -> bool:
    """Looks for one more effect; whether one was found."""
    before = found.chosen
    trials = _tried(found, possible, flags, rng, progress)
    if not trials:
        return False
    if before.bank.unknowns:
        before.bank = _searched_as_well(found.ladder, before.bank, trials[0].bank, flags)
        if not found.steps:
            found.base = before.bank
        for one in trials:
            one.gain = gain(one.bank, before.bank, flags)
        trials.sort(key=lambda one: -one.gain)
    null = null_gains([one.bank for one in trials], before.bank, flags, rng)
    winner, others = trials[0], trials[1:REFINED]
    winner.p_value = chance_of(winner.gain, null)
    if not found.steps:
        found.p_value = winner.p_value
    if winner.p_value > SURE:
        return False
    for other in others:
        if cannot_be_excluded(other.bank, winner.bank, flags, rng) > EXCLUDED:
            winner.rivals.append((other.effects[-1], winner.gain - other.gain))
    found.steps.append(winner)
    found.others += others
    return True


def _tried(
    found: Search, possible: Sequence[Repair], flags: FloatArray, rng: np.random.Generator, progress: Progress
) -> list[Found]:
    """Every mechanism beside what was found already, the best looked at closely; largest gain first."""
    before, number = found.chosen, len(found.steps)
    have = {repair.name for repair in before.effects}
    left = [repair for repair in possible if repair.name not in have]
    trials: list[Found] = []
    for count, repair in enumerate(left):
        progress(f"effect {number + 1}: trying {repair.name}", _share(number, 0.6 * count / len(left)))
        try:
            bank = _with(found.ladder, before.bank, repair, flags, [], rng)
        except InputError as error:
            found.not_tried[repair.name] = str(error)
            continue
        trials.append(Found((*before.effects, repair), bank, gain(bank, before.bank, flags)))
    trials.sort(key=lambda one: -one.gain)
    for count, one in enumerate(trials[:REFINED]):
        repair = one.effects[-1]
        progress(f"effect {number + 1}: {repair.name} more closely", _share(number, 0.6 + 0.4 * count / REFINED))
        one.bank = _with(found.ladder, before.bank, repair, flags, [CLOSER] * CLOSER_ROUNDS, rng)
        one.gain = gain(one.bank, before.bank, flags)
    return sorted(trials, key=lambda one: -one.gain)


def _searched_as_well(ladder: Ladder, before: Bank, winner: Bank, flags: FloatArray) -> Bank:
    """The bank without the new effect, tried where the winner fits best: a better base must not pass for an effect."""
    best_first = np.argsort(-winner.log_posterior(flags).max(axis=1))[:SCREENED]
    return with_points(before, ladder, winner.points[best_first, : len(before.unknowns)])


def _share(number: int, within: float) -> float:
    return 0.1 + 0.8 * (number + within) / MOST


def _with(
    ladder: Ladder,
    before: Bank,
    repair: Repair,
    flags: FloatArray,
    closer: Sequence[int],
    rng: np.random.Generator,
) -> Bank:
    """A bank with one mechanism more: beside what explains the runs without it, and anywhere in the prior."""
    unknowns: tuple[Unknown, ...] = (*before.unknowns, *repair.unknowns)
    shares = before.shares(before.log_likelihood(flags)).sum(axis=1)
    beside = Beside(Kernels.about(before, shares), Spread(repair.unknowns), len(before.unknowns))
    anywhere = Spread(unknowns)
    first: list[Drawn] = (
        [(beside, SCREENED // 2), (anywhere, SCREENED // 2)] if before.unknowns else [(anywhere, SCREENED)]
    )
    return filled(ladder, unknowns, flags, [first, *closer], rng)
