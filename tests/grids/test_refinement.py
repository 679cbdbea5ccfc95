"""Refinement of borders on made-up maps: islands, thin bands, cost, and the stated share of wrong cells."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import binomtest

from grids.plan import parse_plan
from grids.refinement import CLOSED, NOT_COMPUTED, Labels, Refinement
from models.errors import InputError
from tests.study.plans import plan_text


def mesh(shape: tuple[int, ...]) -> list[np.ndarray]:
    return np.meshgrid(*[np.linspace(0.0, 1.0, n) for n in shape], indexing="ij")


def rough_map(size: int, seed: int) -> Labels:
    """Rest, rocking, and overturning beyond a wavy border, with an island before it and a thin safe band behind it."""
    random = np.random.default_rng(seed)
    x, y = mesh((size, size))
    place, phase = random.uniform(0.2, 0.4, 2), random.uniform(0, 6)
    labels = np.where(x < 0.08, 0, 1)
    border = 0.6 + 0.1 * np.sin(7 * y + phase) + 0.02 * np.sin(40 * y)
    labels[x > border] = 2
    labels[(x - place[0]) ** 2 + (y - place[1]) ** 2 < 0.05**2] = 2
    labels[np.abs(x - border - 0.15) < 0.02] = 1
    return labels.astype(np.int8).ravel()


def refined(truth: Labels, shape: tuple[int, ...], **options: float) -> Refinement:
    policy = Refinement(shape, **options)  # type: ignore[arg-type]
    asked = np.empty(0, dtype=np.int64)
    while (cells := policy.ask()).size:
        assert np.all(np.diff(cells) > 0) and not np.isin(cells, asked).any(), "each cell once"
        asked = np.concatenate([asked, cells])
        policy.tell(cells, truth[cells])
    np.testing.assert_array_equal(policy.labels()[asked], truth[asked])
    assert policy.estimate.computed_share == asked.size / truth.size
    return policy


def test_the_stated_share_of_wrong_cells_holds() -> None:
    """Over 25 maps of 64 x 64: the binomial interval of the coverage reaches .95; .5 % are wrong at most."""
    held, wrong = 0, []
    for seed in range(25):
        truth = rough_map(64, seed)
        policy = refined(truth, (64, 64), budget=0.45, guard=120, seed=seed)
        share = float(np.mean(policy.labels() != truth))
        held += policy.estimate.low <= share <= policy.estimate.high
        wrong.append(share)
    assert binomtest(held, 25).proportion_ci(0.99).high >= 0.95, held
    assert np.mean(wrong) < 0.005


def test_no_closed_box_holds_a_computed_cell_of_another_outcome() -> None:
    """Whichever came first, on a map of specks: a box may close about a cell that was computed long before."""
    random = np.random.default_rng(2)
    truth = np.where(random.random(96 * 96) < 0.02, 1, 0).astype(np.int8) + rough_map(96, 1)
    policy, closed = Refinement((96, 96), budget=0.6, guard=150), 0
    while (cells := policy.ask()).size:
        policy.tell(cells, truth[cells])
        last = cells
    policy.values[last] = NOT_COMPUTED  # the audit opens nothing
    values = policy.values.reshape(96, 96)
    for stride, state, label in zip(policy._strides, policy._state, policy._label, strict=True):
        for i, j in np.argwhere(state == CLOSED):
            box = values[i * stride : (i + 1) * stride + 1, j * stride : (j + 1) * stride + 1]
            assert np.all((box == NOT_COMPUTED) | (box == label[i, j]))
            closed += 1
    assert closed > 100


def test_islands_and_thin_bands_of_a_large_map() -> None:
    """512 x 512: at most a tenth computed, at most one cell in a thousand wrong; the island and the band are there."""
    truth = rough_map(512, 3)
    policy = refined(truth, (512, 512), budget=0.1, guard=1000)
    labels = policy.labels()
    assert policy.estimate.complete and policy.estimate.computed_share < 0.1
    assert np.mean(labels != truth) < 0.001
    assert policy.estimate.low <= np.mean(labels != truth) <= policy.estimate.high


def test_four_axes() -> None:
    """A smooth border in four dimensions needs most of a tenth; what is left open is said."""
    shape = (16, 16, 16, 16)
    x, y, z, w = mesh(shape)
    truth = (x + 0.3 * y > 0.6 + 0.2 * z * w).astype(np.int8).ravel()
    wide, narrow = refined(truth, shape, budget=0.6), refined(truth, shape, budget=0.1)
    assert np.mean(wide.labels() != truth) < 0.001 and wide.estimate.complete
    share = float(np.mean(narrow.labels() != truth))
    assert not narrow.estimate.complete and narrow.estimate.computed_share <= 0.1
    assert narrow.estimate.low <= share <= narrow.estimate.high and share < 0.1


@settings(max_examples=15, deadline=None)
@given(
    shape=st.lists(st.integers(1, 9), min_size=1, max_size=4).map(tuple),
    seed=st.integers(0, 1000),
    budget=st.floats(0.01, 1.0),
)
def test_any_map_of_any_shape_ends(shape: tuple[int, ...], seed: int, budget: float) -> None:
    """Within the budget (of at least a box and a cell), without asking twice."""
    truth = np.random.default_rng(seed).integers(0, 3, int(np.prod(shape))).astype(np.int8)
    policy = refined(truth, shape, budget=budget, guard=5, seed=seed)
    assert policy.computed <= max(int(budget * truth.size), 2 ** len(shape) + 1)
    assert set(np.unique(policy.labels())) <= set(np.unique(truth))


def test_one_outcome_everywhere_costs_little() -> None:
    truth = np.ones(256 * 256, dtype=np.int8)
    policy = refined(truth, (256, 256), guard=200)
    assert policy.estimate.computed_share < 0.02 and np.all(policy.labels() == 1)
    assert policy.estimate.wrong == 0 and policy.estimate.high < 0.02


@pytest.mark.parametrize(
    ("changes", "refine", "words"),
    [
        ({"motion": 'files = ["ridgecrest_2019_c*"]'}, "", "no border runs between its values"),
        ({"aspect": "values = [0.4, 0.2]"}, "", "ascending"),
        ({}, "budget = 2.0", "budget"),
        ({}, "colour = 1", "colour"),
    ],
)
def test_plans_that_cannot_be_refined(changes: dict[str, str], refine: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        parse_plan(f"{plan_text(**changes)}\n[refine]\n{refine}", Path.cwd())  # type: ignore[arg-type]
