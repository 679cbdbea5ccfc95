"""What outcomes say for one bank against another: gains, their null distribution, rivals, adequacy.

Everything here is sums over banks that are filled already; nothing is simulated anew.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from diagnosis.outcomes.bank import Bank
from models.base import FloatArray

DRAWS = 999


@dataclass(frozen=True)
class Best:
    """The best point of a bank for the outcomes: its index, the index of its scatter, its log posterior."""

    point: int
    scatter: int
    log: float


def best(bank: Bank, outcomes: FloatArray) -> Best:
    """The most probable point and scatter for ``outcomes`` (runs,)."""
    log = bank.log_posterior(outcomes)
    point, scatter = np.unravel_index(int(np.argmax(log)), log.shape)
    return Best(int(point), int(scatter), float(log[point, scatter]))


def drawn(bank: Bank, outcomes: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Outcomes (runs, draws) as they may come out if the bank's best point is the truth."""
    at = best(bank, outcomes)
    chance = bank.chances[at.point, :, at.scatter]
    return (rng.random((chance.size, DRAWS)) < chance[:, None]).astype(np.float64)


def largest(bank: Bank, outcomes: FloatArray) -> FloatArray:
    """Log posterior (draws,) of the best point for each set of outcomes (runs, draws)."""
    return np.asarray(bank.log_posterior(outcomes).max(axis=(0, 1)))


def gain(bank: Bank, base: Bank, outcomes: FloatArray) -> float:
    """Gain in 2 log likelihood of the best point over the best of ``base``; at least 0, which the null gives."""
    return 2.0 * max(best(bank, outcomes).log - best(base, outcomes).log, 0.0)


def null_gains(banks: Sequence[Bank], base: Bank, outcomes: FloatArray, rng: np.random.Generator) -> FloatArray:
    """The largest gain (draws,) of any of ``banks`` when ``base`` is the truth: the search counts in it."""
    sets = drawn(base, outcomes, rng)
    floor = largest(base, sets)
    found = np.zeros(sets.shape[1])
    for bank in banks:
        found = np.maximum(found, 2.0 * (largest(bank, sets) - floor))
    return found


def chance_of(value: float, null: FloatArray) -> float:
    """Share of the null distribution (draws,) at or above ``value``, the value itself counted."""
    return float((1 + np.sum(null >= value)) / (1 + null.size))


def cannot_be_excluded(rival: Bank, chosen: Bank, outcomes: FloatArray, rng: np.random.Generator) -> float:
    """Probability that ``chosen`` beats ``rival`` by as much as it does when ``rival`` is the truth.

    Source: Cox, J. R. Stat. Soc. B 24 (1962), tests of separate families, by simulation.
    """
    sets = drawn(rival, outcomes, rng)
    lead = largest(chosen, sets) - largest(rival, sets)
    return chance_of(best(chosen, outcomes).log - best(rival, outcomes).log, lead)


def expected(bank: Bank, outcomes: FloatArray) -> FloatArray:
    """Chance (runs,) of overturning, averaged over the posterior."""
    shares = bank.shares(bank.log_likelihood(outcomes))
    return np.asarray(np.einsum("ns,nrs->r", shares, bank.chances))


def left_out(bank: Bank, outcomes: FloatArray, kept: FloatArray) -> FloatArray:
    """Chance (runs,) of overturning from the posterior of the ``kept`` runs (runs,) of 0 and 1 alone."""
    shares = bank.shares(_of(bank, outcomes, kept))
    return np.asarray(np.einsum("ns,nrs->r", shares, bank.chances))


def log_of_kept(bank: Bank, outcomes: FloatArray, kept: FloatArray) -> float:
    """The largest log posterior of the ``kept`` runs."""
    return float(np.max(_of(bank, outcomes, kept) + bank.log_tolerance[:, None]))


def _of(bank: Bank, outcomes: FloatArray, kept: FloatArray) -> FloatArray:
    yes, no = np.log(bank.chances), np.log1p(-bank.chances)
    return np.asarray(np.tensordot(yes, outcomes * kept, (1, 0)) + np.tensordot(no, (1 - outcomes) * kept, (1, 0)))


def slopes(chance: FloatArray, outcomes: FloatArray, measures: Mapping[str, FloatArray]) -> dict[str, float]:
    """By measure: standard score of the residuals' slope along its logarithm, normal where the chances hold.

    z = sum r x / sqrt(sum P (1 - P) x^2), r = outcome - P, x = log measure less its mean weighted with P (1 - P).
    """
    variance = chance * (1.0 - chance)
    found = {}
    for name, measure in measures.items():
        x = np.log(measure)
        x = x - np.sum(variance * x) / np.sum(variance)
        found[name] = float(np.sum((outcomes - chance) * x) / np.sqrt(max(float(np.sum(variance * x**2)), 1e-300)))
    return found


def misfit(chance: FloatArray, outcomes: FloatArray, groups: Sequence[str]) -> float:
    """Squared sum of residuals of each group over its variance, summed: large where whole groups are off."""
    names = np.asarray(groups)
    total = 0.0
    for name in dict.fromkeys(groups):
        own = names == name
        total += float(np.sum(outcomes[own] - chance[own])) ** 2 / float(np.sum(chance[own] * (1.0 - chance[own])))
    return total


def chance_of_misfit(
    chance: FloatArray, outcomes: FloatArray, groups: Sequence[str], rng: np.random.Generator
) -> float:
    """Probability of a `misfit` as large when every run's chance is right (posterior predictive)."""
    sets = (rng.random((DRAWS, chance.size)) < chance).astype(np.float64)
    return chance_of(misfit(chance, outcomes, groups), np.array([misfit(chance, one, groups) for one in sets]))
