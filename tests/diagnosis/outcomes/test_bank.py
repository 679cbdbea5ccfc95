"""Banks of simulated specimens against posteriors that are known in closed form or by direct integration."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pytest
from scipy.stats import norm

from diagnosis.fit.unknowns import Unknown
from diagnosis.outcomes.bank import Bank, Spread, filled, with_points
from diagnosis.outcomes.evidence import best, chance_of, expected, gain, left_out, null_gains
from diagnosis.outcomes.ladder import LOG_SCALES, ODD, SCATTERS, Ladder, probabilities, weights
from models.base import FloatArray

RUNS = 60


class Threshold(Ladder):
    """Overturns where the scaled measure of a run exceeds exp(level + extra): a specimen in closed form."""

    def __init__(self, measure: FloatArray) -> None:
        object.__setattr__(self, "measure", measure)

    def fell(self, points: Sequence[Mapping[str, float]], progress: object = None) -> FloatArray:
        measure: FloatArray = self.measure  # type: ignore[attr-defined]
        level = np.array([one["level"] + one.get("extra", 0.0) for one in points])
        margin = np.log(measure)[None, :, None] + LOG_SCALES - level[:, None, None]
        return (margin > 0.0).astype(np.float64)


LEVEL = Unknown("level", "1", -1.0, 1.0, 0.0, 0.1)
EXTRA = Unknown("extra", "1", 0.0, 1.0, 0.0, 0.05)


def drawn(seed: int, level: float = 0.1, scatter: float = 0.3) -> tuple[Threshold, FloatArray]:
    rng = np.random.default_rng(seed)
    measure = np.exp(rng.uniform(-1.0, 1.2, RUNS))
    return Threshold(measure), (np.log(measure) + scatter * rng.normal(size=RUNS) > level).astype(np.float64)


def bank_of(ladder: Ladder, outcomes: FloatArray, *unknowns: Unknown, seed: int = 0) -> Bank:
    first = [(Spread(unknowns), 64)]
    return filled(ladder, unknowns, outcomes, [first, 64, 64, 64], np.random.default_rng(seed))


def test_the_scales_of_the_ladder_have_the_probabilities_of_a_normal() -> None:
    found = weights(SCATTERS)
    np.testing.assert_allclose(found.sum(axis=1), 1.0, rtol=1e-12)
    np.testing.assert_allclose(found @ LOG_SCALES, 0.0, atol=1e-12)
    inside = SCATTERS < 0.4
    np.testing.assert_allclose((found @ LOG_SCALES**2)[inside], SCATTERS[inside] ** 2 + 0.15**2 / 12, rtol=0.06)


def test_the_chance_is_that_of_a_lognormal_margin() -> None:
    """Where scales above m overturn, P = Phi(-log m / sigma), at the edges between two scales exactly."""
    for k in (3, 7, 11):
        fell = (LOG_SCALES[k] <= LOG_SCALES).astype(np.float64)
        edge = LOG_SCALES[k] - 0.075
        np.testing.assert_allclose(probabilities(fell), ODD + (1 - 2 * ODD) * norm.sf(edge / SCATTERS), rtol=1e-9)


def test_the_posterior_is_that_of_direct_integration() -> None:
    ladder, outcomes = drawn(1)
    bank = bank_of(ladder, outcomes, LEVEL)
    shares = bank.shares(bank.log_likelihood(outcomes)).sum(axis=1)
    grid = np.linspace(*LEVEL.bounds, 801)
    chances = probabilities(ladder.fell([{"level": LEVEL.value(u)} for u in grid]))
    log = np.tensordot(np.log(chances), outcomes, (1, 0)) + np.tensordot(np.log1p(-chances), 1 - outcomes, (1, 0))
    exact = np.exp(log - log.max()).sum(axis=1)
    exact /= exact.sum()
    mean, sd = exact @ grid, np.sqrt(exact @ grid**2 - (exact @ grid) ** 2)
    assert shares @ bank.points[:, 0] == pytest.approx(mean, abs=0.3 * sd)
    assert np.sqrt(shares @ (bank.points[:, 0] - mean) ** 2) == pytest.approx(sd, rel=0.3)


def test_a_point_without_weight_may_be_the_best_and_moves_no_average() -> None:
    ladder, outcomes = drawn(1)
    bank = bank_of(ladder, outcomes, LEVEL)
    more = with_points(bank, ladder, np.array([[LEVEL.coordinate(0.1)], [LEVEL.coordinate(-1.0)]]))
    np.testing.assert_allclose(expected(more, outcomes), expected(bank, outcomes), rtol=1e-12)
    assert best(more, outcomes).log >= best(bank, outcomes).log
    assert more.log_posterior(outcomes).shape[0] == bank.points.shape[0] + 2


def test_leaving_runs_out_is_a_fit_without_them() -> None:
    ladder, outcomes = drawn(2)
    bank = bank_of(ladder, outcomes, LEVEL)
    kept = np.ones(RUNS)
    kept[:12] = 0.0
    found = left_out(bank, outcomes, kept)[:12]
    rest = Threshold(ladder.measure[12:])  # type: ignore[attr-defined]
    alone = bank_of(rest, outcomes[12:], LEVEL)
    shares = alone.shares(alone.log_likelihood(outcomes[12:]))
    own = Threshold(ladder.measure[:12])  # type: ignore[attr-defined]
    chances = probabilities(own.fell([alone.values(k) for k in range(alone.points.shape[0])]))
    np.testing.assert_allclose(found, np.einsum("ns,nrs->r", shares, chances), atol=0.05)


def test_several_sets_of_outcomes_give_the_likelihoods_of_each() -> None:
    ladder, outcomes = drawn(3)
    bank = bank_of(ladder, outcomes, LEVEL)
    both = np.stack([outcomes, 1.0 - outcomes], axis=1)
    together = bank.log_posterior(both)
    np.testing.assert_allclose(together[:, :, 0], bank.log_posterior(outcomes), rtol=1e-9)
    np.testing.assert_allclose(together[:, :, 1], bank.log_posterior(1.0 - outcomes), rtol=1e-9)


def test_the_scatter_from_run_to_run_is_found() -> None:
    found = []
    for seed in range(8):
        ladder, outcomes = drawn(seed + 10, scatter=0.3)
        bank = bank_of(ladder, outcomes, LEVEL)
        found.append(np.log(SCATTERS[best(bank, outcomes).scatter]))
    assert np.exp(np.mean(found)) == pytest.approx(0.3, rel=0.35)


def test_chance_of_a_gain_is_uniform_when_nothing_is_missing() -> None:
    """The level is known here and the extra is the effect: at its null, p under .1 in a tenth of the cases."""
    known = Unknown("level", "1", 0.05, 0.15, 0.1, 0.1, prior=(0.1, 0.02))
    values = []
    for seed in range(24):
        ladder, outcomes = drawn(seed + 100)
        base = bank_of(ladder, outcomes, known)
        other = bank_of(ladder, outcomes, known, EXTRA)
        null = null_gains([other], base, outcomes, np.random.default_rng(seed))
        values.append(chance_of(gain(other, base, outcomes), null))
    assert np.mean(np.array(values) < 0.1) <= 0.25
    assert np.mean(np.array(values) < 0.02) <= 0.1


def test_an_effect_that_is_there_is_seen() -> None:
    ladder, outcomes = drawn(5, level=0.7)
    known = Unknown("level", "1", 0.05, 0.15, 0.1, 0.1, prior=(0.1, 0.02))
    base, other = bank_of(ladder, outcomes, known), bank_of(ladder, outcomes, known, EXTRA)
    null = null_gains([other], base, outcomes, np.random.default_rng(0))
    assert chance_of(gain(other, base, outcomes), null) <= 0.002
    assert other.values(best(other, outcomes).point)["extra"] == pytest.approx(0.6, abs=0.2)
    fitted = expected(other, outcomes)
    assert np.mean((fitted > 0.5) == (outcomes > 0.5)) > 0.8
