"""Which configuration starts from rest: published sequences, and one admissible candidate always."""

import numpy as np
import pytest

from models.stacked.configuration import CONFIGURATIONS
from models.stacked.equation import held
from models.stacked.model import MODEL
from models.stacked.reference.choice import SIDES, Corners, candidates, choose, margin
from tests.models.stacked.walls import A, B, G, at_rest, random_stacks

REST, UPPER, ONE_BODY, SAME_SIDE, OPPOSED = (0, 0), (0, 1), (1, 0), (1, 1), (1, -1)


@pytest.mark.parametrize(
    ("values", "sequence"),
    [
        (A, [(REST, 0.22727), (ONE_BODY, 3.0)]),
        (B, [(REST, 0.1875), (UPPER, 0.2073), (SAME_SIDE, 0.2237), (ONE_BODY, 1.3727), (OPPOSED, 3.0)]),
    ],
)
def test_published_sequences(values: dict[str, float], sequence: list[tuple[tuple[int, int], float]]) -> None:
    """Patterns with rising acceleration to the left (which tips to the right), up to 3 g.

    The limits were read off a scan: .2237 is the first level of a pattern that starts at .22357.
    """
    stack = MODEL.build(values).one()

    def pattern(level: float) -> tuple[int, int]:
        return choose(at_rest(stack, -level * G), 0, 0)

    low = 0.0
    for (expected, limit), after in zip(sequence, [*sequence[1:], None], strict=True):
        assert {pattern(level) for level in np.linspace(low + 1e-5, limit - 1.5e-4, 50)} == {expected}
        if after is not None:
            assert pattern(limit + 1e-5) == after[0]
        low = limit


def test_base_threshold_lies_inside_upper_block_alone() -> None:
    """B: as one body the wall would lift at .19737 g, but the upper block already rocks there."""
    stack = MODEL.build(B)
    assert (stack.half_width / stack.centre)[0] == pytest.approx(0.19737, abs=5e-6)
    assert choose(at_rest(stack.one(), -0.19737 * G), 0, 0) == UPPER


def all_margins(forces: Corners) -> np.ndarray:
    """Margins (n, 9) of all candidates with both joints closed, in the order of `candidates`."""
    return np.stack([margin(forces, 0, 0, *pair) for pair in candidates(0, 0)], axis=-1)


@pytest.mark.parametrize("seed", [0, 1])
def test_exactly_one_candidate_is_admissible(seed: int) -> None:
    """20 000 random geometries under random horizontal and vertical acceleration."""
    rng = np.random.default_rng(seed)
    stack = random_stacks(rng, 10_000)
    # near the geometry's own threshold the choice is hard; far above it the patterns differ
    level = np.minimum(stack.half_width / stack.centre, stack.half_width_2 / stack.centre_2)
    a = G * level * np.exp(rng.uniform(-0.5, 4.0, stack.size)) * rng.choice([-1.0, 1.0], stack.size)
    margins = all_margins(at_rest(stack, a, G * rng.uniform(0.5, 1.5, stack.size)))
    assert np.all((margins > 0.0).sum(axis=1) == 1)
    chosen = [candidates(0, 0)[k] for k in np.unique(np.argmax(margins, axis=1))]
    assert set(chosen) == set(CONFIGURATIONS)


def test_conditions_as_published() -> None:
    """The margins agree with the conditions in (theta_1'', theta_2''), written out pattern by pattern."""
    rng = np.random.default_rng(5)
    stack = random_stacks(rng, 300)
    a = G * np.exp(rng.uniform(-3.0, 1.0, stack.size)) * rng.choice([-1.0, 1.0], stack.size)
    forces = at_rest(stack, a)
    margins = dict(zip(candidates(0, 0), all_margins(forces).T, strict=True))
    m1, m2, h1, h2 = stack.mass_1, stack.mass_2, stack.centre_1, stack.centre_2
    b1, b2 = stack.base_pivot, stack.top_pivot

    def plain(s1: int, s2: int) -> tuple[np.ndarray, ...]:
        u = s1 * b1 - s2 * b2
        return (
            stack.inertia_1 + m1 * (h1**2 + b1**2) + m2 * (4 * h1**2 + u**2),
            m2 * (2 * h1 * h2 + u * s2 * b2),
            stack.inertia_2 + m2 * (h2**2 + b2**2),
            -a * (m1 * h1 + 2 * m2 * h1) - G * (m1 * s1 * b1 + m2 * u),
            -m2 * (a * h2 + G * s2 * b2),
        )

    for s1 in SIDES:
        for s2 in SIDES:
            m11, m12, m22, q1, q2 = plain(s1, s2)
            first, relative = held(forces(s1, s2), s1, s2)
            second = first + relative
            np.testing.assert_allclose(m11 * first + m12 * second, q1, rtol=1e-9, atol=1e-9 * np.abs(q1).max())
            np.testing.assert_allclose(m12 * first + m22 * second, q2, rtol=1e-9, atol=1e-9 * np.abs(q2).max())
            assert np.array_equal((s1 * first > 0) & (s2 * (second - first) > 0), margins[s1, s2] > 0)
        m11, m12, m22, q1, q2 = plain(s1, 1)
        tau = (q1 + q2) / (m11 + 2 * m12 + m22)
        holds = s1 * tau > 0
        for s2 in SIDES:
            _, m12, m22, _, q2 = plain(s1, s2)
            holds &= s2 * (q2 - (m12 + m22) * tau) <= 0
        assert np.array_equal(holds, margins[s1, 0] > 0)
    for s2 in SIDES:
        _, _, m22, _, q2 = plain(1, s2)
        tau = q2 / m22
        holds = s2 * tau > 0
        for s1 in SIDES:
            _, m12, m22, q1, q2 = plain(s1, s2)
            holds &= s1 * ((q1 - m12 * tau) + (q2 - m22 * tau)) <= 0
        assert np.array_equal(holds, margins[0, s2] > 0)
    rest = np.ones(stack.size, bool)
    for s in SIDES:
        _, _, _, q1, q2 = plain(s, s)
        rest &= (s * (q1 + q2) <= 0) & (s * q2 <= 0)
    assert np.array_equal(rest, margins[0, 0] > 0)
