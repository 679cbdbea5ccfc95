"""A bank of simulated specimens: points of the parameters with the chance of every run's outcome.

The bank is filled in rounds. The first spreads its points over the prior; each later one draws them from kernels
about the points that explain the outcomes best. A point's weight is the prior over the mixture of all rounds
(deterministic mixture), so expectations over the posterior, leaving runs out, and the likelihood of any other
outcomes are sums over the bank, without a new simulation.
Source: Cornuet, Marin, Mira, Robert, Scand. J. Stat. 39 (2012), adaptive multiple importance sampling.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np
from scipy.special import logsumexp
from scipy.stats import norm, qmc, truncnorm

from diagnosis.fit.unknowns import Unknown, values_of
from diagnosis.outcomes.ladder import LOG_SCALES, Ladder, probabilities
from models.base import FloatArray

NARROWEST = 0.02
"""Width of a kernel, at least, as a share of the range."""
ENOUGH = 60.0
"""Effective number of points (1/sum of squared weights) at which a bank is full."""


@dataclass(frozen=True)
class Bank:
    """Points (n, d) of ``unknowns`` as coordinates; ``chances`` (n, runs, scatters) of overturning;
    ``log_weight`` (n,): prior over the density that the points were drawn from.
    """

    unknowns: tuple[Unknown, ...]
    points: FloatArray
    chances: FloatArray
    log_tolerance: FloatArray
    """(n,): log of the normal densities of toleranced parameters over their largest value."""
    log_weight: FloatArray

    def log_likelihood(self, outcomes: FloatArray) -> FloatArray:
        """(n, scatters) for ``outcomes`` (runs,), or (n, scatters, sets) for (runs, sets), of 0 and 1."""
        yes, no = np.log(self.chances), np.log1p(-self.chances)
        return np.asarray(np.tensordot(yes - no, outcomes, (1, 0)) + _ended(no.sum(axis=1), outcomes.ndim))

    def log_posterior(self, outcomes: FloatArray) -> FloatArray:
        """As `log_likelihood`, less what departures from toleranced values cost."""
        return np.asarray(self.log_likelihood(outcomes) + _ended(self.log_tolerance, outcomes.ndim, 1))

    def shares(self, log_likelihood: FloatArray) -> FloatArray:
        """Posterior probabilities (n, scatters) of points and scatters: likelihood x weight, of sum 1."""
        log = log_likelihood + self.log_weight[:, None]
        return np.asarray(np.exp(log - logsumexp(log)))

    def values(self, index: int) -> dict[str, float]:
        return values_of(self.unknowns, self.points[index])


def _ended(values: FloatArray, outcome_axes: int, missing: int = 0) -> FloatArray:
    """Axes of length one at the end, as many as the likelihood of several sets of outcomes has more."""
    return values.reshape(values.shape + (1,) * (missing + outcome_axes - 1))


class Proposal(Protocol):
    """Where points are drawn from: coordinates (count, d), and the log density (n,) of coordinates (n, d)."""

    def draw(self, count: int, rng: np.random.Generator) -> FloatArray: ...

    def log_density(self, u: FloatArray) -> FloatArray: ...


@dataclass(frozen=True)
class Spread:
    """The prior itself, its points spread evenly (Sobol); a power of two of them best."""

    unknowns: tuple[Unknown, ...]

    def draw(self, count: int, rng: np.random.Generator) -> FloatArray:
        if not self.unknowns:
            return np.zeros((count, 0))
        found = qmc.Sobol(len(self.unknowns), rng=rng).random(count)
        for column, one in enumerate(self.unknowns):
            low, high = one.bounds
            if one.prior is None:
                found[:, column] = low + (high - low) * found[:, column]
            else:
                found[:, column] = _of_tolerance(one).ppf(found[:, column])
        return np.asarray(found)

    def log_density(self, u: FloatArray) -> FloatArray:
        total = np.zeros(u.shape[0])
        for column, one in zip(u.T, self.unknowns, strict=True):
            total += -np.log(np.ptp(one.bounds)) if one.prior is None else _of_tolerance(one).logpdf(column)
        return total


@dataclass(frozen=True)
class Beside:
    """The first coordinates from one proposal, the others from another, independently."""

    first: Proposal
    second: Proposal
    split: int

    def draw(self, count: int, rng: np.random.Generator) -> FloatArray:
        return np.hstack([self.first.draw(count, rng), self.second.draw(count, rng)])

    def log_density(self, u: FloatArray) -> FloatArray:
        return self.first.log_density(u[:, : self.split]) + self.second.log_density(u[:, self.split :])


def _of_tolerance(one: Unknown) -> Any:
    """The truncated normal distribution of a toleranced parameter's coordinate."""
    assert one.prior is not None
    centre, width = one.prior[0] / one.scale, one.prior[1] / one.scale
    low, high = one.bounds
    return truncnorm((low - centre) / width, (high - centre) / width, centre, width)


@dataclass(frozen=True)
class Kernels:
    """A mixture of normal kernels within the bounds, independent along the coordinates, about ``centres`` (m, d)."""

    centres: FloatArray
    shares: FloatArray
    widths: FloatArray
    bounds: FloatArray

    @classmethod
    def about(cls, bank: Bank, shares: FloatArray) -> Kernels:
        """About the points of a bank, with their posterior ``shares`` (n,); Silverman's widths."""
        effective = 1.0 / np.sum(shares**2)
        mean = shares @ bank.points
        deviation = np.sqrt(shares @ (bank.points - mean) ** 2)
        bounds = np.array([one.bounds for one in bank.unknowns]).reshape(-1, 2)
        dimensions = len(bank.unknowns)
        width = deviation * (4.0 / ((dimensions + 2.0) * max(effective, 2.0))) ** (1.0 / (dimensions + 4.0))
        return cls(bank.points, shares, np.maximum(width, NARROWEST * np.ptp(bounds, axis=1)), bounds)

    def draw(self, count: int, rng: np.random.Generator) -> FloatArray:
        if not self.bounds.size:
            return np.zeros((count, 0))
        chosen = self.centres[rng.choice(self.shares.size, count, p=self.shares)]
        a, b = (self.bounds[:, 0] - chosen) / self.widths, (self.bounds[:, 1] - chosen) / self.widths
        return np.asarray(truncnorm.rvs(a, b, chosen, self.widths, random_state=rng))

    def log_density(self, u: FloatArray) -> FloatArray:
        if not self.bounds.size:
            return np.zeros(u.shape[0])
        kept = np.flatnonzero(self.shares > 1e-9)
        centres = self.centres[kept]
        inside = norm.cdf((self.bounds[:, 1] - centres) / self.widths) - norm.cdf(
            (self.bounds[:, 0] - centres) / self.widths
        )
        each = norm.logpdf(u[:, None], centres, self.widths) - np.log(inside)
        return np.asarray(logsumexp(each.sum(axis=2) + np.log(self.shares[kept]), axis=1))


def with_points(bank: Bank, ladder: Ladder, points: FloatArray) -> Bank:
    """The bank with further points (m, d) that no proposal drew: they have no weight and may be the best."""
    values = [values_of(bank.unknowns, u) for u in points]
    return replace(
        bank,
        points=np.vstack([bank.points, points]),
        chances=np.concatenate([bank.chances, probabilities(ladder.fell(values))]),
        log_tolerance=np.append(bank.log_tolerance, tolerated(bank.unknowns, points)),
        log_weight=np.append(bank.log_weight, np.full(points.shape[0], -np.inf)),
    )


Drawn = tuple[Proposal, int]
"""A proposal and how many points to draw from it."""


def filled(
    ladder: Ladder,
    unknowns: Sequence[Unknown],
    outcomes: FloatArray,
    rounds: Sequence[Sequence[Drawn] | int],
    rng: np.random.Generator,
) -> Bank:
    """A bank from rounds of proposals; a number stands for so many points from kernels about the best so far.

    Rounds of kernels end when the effective number of points is `ENOUGH`.
    """
    prior = Spread(tuple(unknowns))
    drawn: list[Drawn] = []
    points, fell = np.zeros((0, len(unknowns))), np.zeros((0, outcomes.size, LOG_SCALES.size))
    bank: Bank | None = None
    for one in rounds:
        if isinstance(one, int):
            assert bank is not None
            shares = bank.shares(bank.log_likelihood(outcomes)).sum(axis=1)
            if 1.0 / np.sum(shares**2) >= ENOUGH or not unknowns:
                break
            proposals: Sequence[Drawn] = [(Kernels.about(bank, shares), one)]
        else:
            proposals = one
        new = np.vstack([proposal.draw(count, rng) for proposal, count in proposals])
        drawn += proposals
        fell = np.concatenate([fell, ladder.fell([values_of(unknowns, u) for u in new])])
        points = np.vstack([points, new])
        total = sum(count for _, count in drawn)
        mixture = logsumexp([np.log(count / total) + q.log_density(points) for q, count in drawn], axis=0)
        bank = Bank(
            tuple(unknowns), points, probabilities(fell), tolerated(unknowns, points),
            prior.log_density(points) - mixture,
        )  # fmt: skip
    assert bank is not None
    return bank


def tolerated(unknowns: Sequence[Unknown], points: FloatArray) -> FloatArray:
    """Log of the normal densities of toleranced parameters (n,), over their largest value."""
    total = np.zeros(points.shape[0])
    for column, one in zip(points.T, unknowns, strict=True):
        if one.prior is not None:
            total -= 0.5 * ((one.scale * column - one.prior[0]) / one.prior[1]) ** 2
    return total
