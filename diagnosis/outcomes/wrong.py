"""Where predictions of outcomes are wrong: along which measure of the motion, and in which groups of runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from diagnosis.outcomes.answer import Wrong
from diagnosis.outcomes.evidence import slopes
from diagnosis.outcomes.measures import UNITS
from models.base import FloatArray

NOTABLE = 3.0
"""Standard score from which a measure is named."""
RARE = 0.01
"""Chance, times the number of groups, under which a group is named."""
MOST_GROUPS = 5


def wrong_predictions(
    chance: FloatArray, outcomes: FloatArray, groups: Sequence[str], measures: Mapping[str, FloatArray]
) -> tuple[Wrong, ...]:
    """All runs first, then measures and groups whose residuals stand out, strongest first.

    ``chance`` (runs,) of overturning, ``outcomes`` (runs,) of 0 and 1.
    """
    everywhere = np.ones(outcomes.size, bool)
    found = [_wrong("all runs", "", None, everywhere, chance, outcomes, _sum_score(chance, outcomes))]
    along = slopes(chance, outcomes, measures)
    for name, score in sorted(along.items(), key=lambda one: -abs(one[1])):
        if abs(score) >= NOTABLE:
            found.append(_along(name, measures[name], chance, outcomes, score))
    names = np.asarray(groups)
    each = dict.fromkeys(groups)
    if len(each) < outcomes.size:
        tails = {name: _tail(chance[names == name], int(outcomes[names == name].sum())) for name in each}
        for name in sorted(tails, key=lambda one: tails[one])[:MOST_GROUPS]:
            if tails[name] * len(each) < RARE:
                score = _sum_score(chance[names == name], outcomes[names == name])
                found.append(_wrong(f"group {name}", "", None, names == name, chance, outcomes, score))
    return tuple(found)


def _tail(chance: FloatArray, fell: int) -> float:
    """Probability, both tails, that so few or so many of independent runs overturn: their exact distribution."""
    spread = np.ones(1)
    for p in chance:
        spread = np.convolve(spread, [1.0 - p, p])
    return 2.0 * min(float(spread[: fell + 1].sum()), float(spread[fell:].sum()))


def _sum_score(chance: FloatArray, outcomes: FloatArray) -> float:
    """Sum of the residuals over its standard deviation."""
    return float(np.sum(outcomes - chance) / np.sqrt(np.sum(chance * (1.0 - chance))))


def _along(name: str, measure: FloatArray, chance: FloatArray, outcomes: FloatArray, score: float) -> Wrong:
    """The range of a measure that holds the middle nine tenths of the wrong predictions of the commoner kind."""
    missed = (chance <= 0.5) & (outcomes > 0.5)
    false = (chance > 0.5) & (outcomes <= 0.5)
    of_kind = missed if missed.sum() >= false.sum() else false
    if not of_kind.any():
        of_kind = np.ones(outcomes.size, bool)
    low, high = np.quantile(measure[of_kind], (0.05, 0.95))
    inside = (measure >= low) & (measure <= high)
    return _wrong(name, UNITS[name], (float(low), float(high)), inside, chance, outcomes, score)


def _wrong(
    over: str,
    unit: str,
    ends: tuple[float, float] | None,
    inside: FloatArray,
    chance: FloatArray,
    outcomes: FloatArray,
    score: float,
) -> Wrong:
    fell, said = outcomes[inside] > 0.5, chance[inside] > 0.5
    missed, false = int(np.sum(fell & ~said)), int(np.sum(~fell & said))
    low, high = ends if ends else (None, None)
    predicted = "stands" if missed >= false else "overturns"
    return Wrong(over, low, high, unit, predicted, max(missed, false), int(fell.size), score)
