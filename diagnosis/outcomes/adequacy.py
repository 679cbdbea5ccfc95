"""Whether what was found explains the outcomes, and whether these look as if 0 and 1 were swapped."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from diagnosis.outcomes.answer import Compared
from diagnosis.outcomes.evidence import DRAWS, chance_of, slopes
from models.base import FloatArray

INADEQUATE = 0.01
"""Chance of what is left (by groups, or along a measure) below which the extended model does not explain the runs."""
EVEN = float(np.log(2.0))
"""Log-loss of saying one half of every run."""


def chance_of_slopes(
    chance: FloatArray, outcomes: FloatArray, measures: Mapping[str, FloatArray], rng: np.random.Generator
) -> float:
    """Probability of residuals that slope as much along any measure when every run's chance is right.

    By simulation, for one outcome against all odds makes the score of few runs far from normal.
    """
    sets = (rng.random((DRAWS, chance.size)) < chance).astype(np.float64)
    return chance_of(_steepest(chance, outcomes, measures), np.array([_steepest(chance, o, measures) for o in sets]))


def _steepest(chance: FloatArray, outcomes: FloatArray, measures: Mapping[str, FloatArray]) -> float:
    return max(abs(score) for score in slopes(chance, outcomes, measures).values())


def worse_than_even(compared: Iterable[Compared], by: str) -> bool:
    """Whether ``by`` predicts runs that it has not learned from clearly worse than a coin does."""
    return any(one.cross_validated and one.by == by and one.scores.log_loss.low95 > EVEN for one in compared)


def swapped(base: FloatArray, outcomes: FloatArray) -> bool:
    """Whether the base model's chances (runs,) are worse than a coin, and better than one with 0 and 1 swapped."""
    fell = outcomes > 0.5
    as_given = -float(np.mean(np.log(np.where(fell, base, 1.0 - base))))
    turned = -float(np.mean(np.log(np.where(fell, 1.0 - base, base))))
    return as_given > EVEN > turned
