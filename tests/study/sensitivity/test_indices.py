"""Indices against functions whose indices are known: Ishigami's, and Sobol's g."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.stats import binomtest

from grids.axes import Design, morris, saltelli
from models.base import FloatArray
from study.sensitivity.indices import at_the_ends, indices

A, B = 7.0, 0.1
WEIGHTS = np.array([0.0, 1.0, 4.5, 9.0, 99.0])


def designed(kind: Any, choices: tuple[int, ...], count: int, seed: int) -> Design:
    return Design(kind.KIND.key, kind.draw(choices, count, seed), choices)


def ishigami(u: FloatArray) -> FloatArray:
    """sin x1 + a sin^2 x2 + b x3^4 sin x1, x uniform in -pi .. pi (Ishigami and Homma 1990)."""
    x1, x2, x3 = (np.pi * (2 * u - 1)).T
    return np.asarray(np.sin(x1) + A * np.sin(x2) ** 2 + B * x3**4 * np.sin(x1))


def ishigami_indices() -> tuple[FloatArray, FloatArray]:
    v1, v2, v13 = 0.5 * (1 + B * np.pi**4 / 5) ** 2, A**2 / 8, B**2 * np.pi**8 * 8 / 225
    return np.array([v1, v2, 0.0]) / (v1 + v2 + v13), np.array([v1 + v13, v2, v13]) / (v1 + v2 + v13)


def sobol_g(u: FloatArray) -> FloatArray:
    """prod (|4 u - 2| + a)/(1 + a) (Sobol 1993)."""
    return np.asarray(np.prod((np.abs(4 * u - 2) + WEIGHTS) / (1 + WEIGHTS), axis=1))


def sobol_g_indices() -> tuple[FloatArray, FloatArray]:
    parts = 1 / (3 * (1 + WEIGHTS) ** 2)
    whole = np.prod(1 + parts) - 1
    return parts / whole, parts * np.prod(1 + parts) / (1 + parts) / whole


@pytest.mark.parametrize(
    ("function", "exact"), [(ishigami, ishigami_indices()), (sobol_g, sobol_g_indices())], ids=["Ishigami", "Sobol g"]
)
def test_known_indices_lie_within_their_intervals(
    function: Callable[[FloatArray], FloatArray], exact: tuple[FloatArray, FloatArray]
) -> None:
    """Over 30 seeds, the indices above 1 %: the 99.9 % binomial interval of the coverage reaches .95 from below or
    holds it (the base points are a Sobol sequence, more even than the bootstrap takes them for); the mean of the
    seeds is the truth within four standard errors."""
    dimensions, held, tried = exact[0].size, 0, 0
    means = []
    for seed in range(30):
        design = designed(saltelli, (0,) * dimensions, 128, seed)
        found = indices(design, function(design.shares), seed=seed + 1)
        for name, truth in zip(("first", "total"), exact, strict=True):
            large = truth > 0.01
            inside = (found[f"{name}_low"] <= truth) & (truth <= found[f"{name}_high"])
            held, tried = held + int(inside[large].sum()), tried + int(large.sum())
        means.append([found["first"], found["total"]])
    assert binomtest(held, tried).proportion_ci(0.999).high >= 0.95, (held, tried)
    error = np.std(means, axis=0, ddof=1) / len(means) ** 0.5
    assert np.all(np.abs(np.mean(means, axis=0) - exact) < 4 * error)


def test_interactions_of_ishigami() -> None:
    """Parameters 1 and 3 interact, no other pair does beyond chance."""
    design = designed(saltelli, (0,) * 3, 1024, 1)
    found = indices(design, ishigami(design.shares))
    second, low = found["second"], found["second_low"]
    assert low[0, 2] == low[2, 0] > 0.0
    assert low[0, 1] < 0.0 and low[1, 2] < 0.0
    _, total = ishigami_indices()
    assert second[0, 2] == second[2, 0] == pytest.approx(total[2], abs=0.05)
    assert abs(second[0, 1]) < 0.05 and abs(second[1, 2]) < 0.05
    assert np.isnan(np.diag(second)).all()


def test_screening_ranks_as_the_total_indices() -> None:
    """mu* of Sobol's g falls with the weights; a parameter that does nothing has none."""
    design = designed(morris, (0,) * 5, 64, 3)
    found = indices(design, sobol_g(design.shares))
    assert np.all(np.diff(found["mu_star"][:4]) < 0.0)
    assert found["mu_star"][4] < 0.02 * found["mu_star"][0]
    assert np.all(found["mu_star_low"] <= found["mu_star"]) and np.all(found["mu_star"] <= found["mu_star_high"])


def test_screening_of_a_line_is_exact() -> None:
    """Of 3 u1 - u2 every elementary effect is the slope over the range between the outer levels."""
    design = designed(morris, (0,) * 2, 8, 1)
    found = indices(design, 3 * design.shares[:, 0] - design.shares[:, 1])
    np.testing.assert_allclose(found["mu"], np.array([3.0, -1.0]) * 0.75)
    np.testing.assert_allclose(found["sigma"], 0.0, atol=1e-12)


@pytest.mark.parametrize("counts", [(0, 5), (3, 2), (4, 0), (5, 3)])
def test_screening_draws_every_word_as_often(counts: tuple[int, int]) -> None:
    """On four levels the third of five words was never drawn, and what matters under it alone mattered nothing."""
    design = designed(morris, counts, 400, 2)
    for column, count in enumerate(counts):
        if count:
            drawn = np.bincount((design.shares[:, column] * count).astype(int), minlength=count)
            assert np.all(np.abs(drawn / drawn.sum() - 1.0 / count) < 0.06), drawn
    design = designed(morris, (0, 5), 64, 2)
    third = (design.shares[:, 1] * 5).astype(int) == 2
    assert indices(design, np.where(third, design.shares[:, 0], 0.0))["mu_star_low"][0] > 0.05


def test_unknown_points_cost_their_group_and_no_more() -> None:
    design = designed(saltelli, (0,) * 3, 256, 5)
    values = ishigami(design.shares)
    whole = indices(design, values)
    values[[8, 100, 101]] = np.nan
    rest = indices(design, values)
    np.testing.assert_allclose(rest["total"], whole["total"], atol=0.05)
    assert np.isnan(indices(design, np.full(values.size, np.nan))["total"]).all()
    assert np.isnan(indices(design, np.ones(values.size))["first"]).all(), "what does not vary has no indices"


def test_means_at_the_ends() -> None:
    """Of 10 u the mean over the lowest fifth is 1, over the highest 9."""
    design = designed(saltelli, (0,) * 2, 512, 7)
    low, high = at_the_ends(design, 10 * design.shares[:, 0])
    assert (low[0], high[0]) == pytest.approx((1.0, 9.0), abs=0.05)
    assert (low[1], high[1]) == pytest.approx((5.0, 5.0), abs=0.3)
