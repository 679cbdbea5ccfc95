"""How well chances of overturning agree with outcomes, with intervals by groups of runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import beta

from models.base import FloatArray

RESAMPLED = 2000
BINS = 5
LEAST_IN_BIN = 3


@dataclass(frozen=True)
class Score:
    """A figure with its 95 % interval (bootstrap over groups of runs)."""

    value: float
    low95: float
    high95: float


@dataclass(frozen=True)
class Scores:
    """``accuracy``: share of runs whose outcome was the likelier one; ``log_loss``: mean of -log of the chance that
    was given to what happened; ``false_falls``, ``false_stands``: runs wrongly predicted to overturn, to stand.
    """

    accuracy: Score
    log_loss: Score
    false_falls: int
    false_stands: int


@dataclass(frozen=True)
class Bin:
    """Runs with alike chances: their mean chance, and the share that overturned with its 95 % interval."""

    chance: float
    share: float
    low95: float
    high95: float
    runs: int


def scores(chance: FloatArray, outcomes: FloatArray, groups: Sequence[str], seed: int = 0) -> Scores:
    """Scores of chances (runs,) against outcomes (runs,) of 0 and 1."""
    fell = outcomes > 0.5
    right = ((chance > 0.5) == fell).astype(np.float64)
    loss = -np.log(np.where(fell, chance, 1.0 - chance))
    return Scores(
        _by_groups(right, groups, seed),
        _by_groups(loss, groups, seed),
        int(np.sum((chance > 0.5) & ~fell)),
        int(np.sum((chance <= 0.5) & fell)),
    )


def _by_groups(values: FloatArray, groups: Sequence[str], seed: int) -> Score:
    """Mean of values (runs,); runs of one group are drawn together."""
    names, member = np.unique(np.asarray(groups), return_inverse=True)
    totals, counts = np.bincount(member, values), np.bincount(member)
    chosen = np.random.default_rng(seed).integers(names.size, size=(RESAMPLED, names.size))
    means = totals[chosen].sum(axis=1) / counts[chosen].sum(axis=1)
    low, high = np.quantile(means, (0.025, 0.975))
    return Score(float(np.mean(values)), float(low), float(high))


def reliability(chance: FloatArray, outcomes: FloatArray) -> tuple[Bin, ...]:
    """Runs sorted into equal ranges of the chance; exact binomial intervals (Clopper and Pearson, 1934)."""
    found = []
    for low, high in zip(np.linspace(0, 1, BINS + 1)[:-1], np.linspace(0, 1, BINS + 1)[1:], strict=True):
        own = (chance >= low) & ((chance < high) | (high == 1.0))
        n, k = int(own.sum()), int(outcomes[own].sum())
        if n < LEAST_IN_BIN:
            continue
        found.append(
            Bin(
                float(chance[own].mean()), k / n,
                float(beta.ppf(0.025, k, n - k + 1)) if k else 0.0,
                float(beta.ppf(0.975, k + 1, n - k)) if k < n else 1.0, n,
            )
        )  # fmt: skip
    return tuple(found)
