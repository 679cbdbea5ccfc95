"""Restricted likelihood: known variances come back, absent ones stay at zero, slopes are those of the likelihood."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.errors.components import Component, Diagonal, LowRank, Stationary
from diagnosis.errors.drifts import Knots
from diagnosis.errors.likelihood import Piece, Prior, by_piece, climbed, evaluate, maximise

N, PIECES = 80, 40
TIME = np.arange(N) * 0.01
LAG = np.abs(TIME[:, None] - TIME[None, :])
KERNELS = [Component("white", 0).kernel(LAG), Component("exponential", 0, 0.05).kernel(LAG)]
NO_PRIOR = Prior(np.zeros((1, 1)), np.zeros(1))
NAMES = ("white", "drift", "growing", "scatter")


def pieces(theta: list[float], seed: int) -> list[Piece]:
    """Synthetic windows: two states, one shared unknown, four variance components."""
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(PIECES):
        columns = np.stack([(at < TIME) * np.sin(9.0 * (TIME - at)) for at in rng.uniform(0.0, 0.6, 2)], axis=1)
        size = np.abs(np.sin(8.0 * TIME + rng.uniform(0.0, 6.0))) ** 2
        parts = (
            Stationary(slice(0, N), KERNELS[0]),
            Stationary(slice(0, N), KERNELS[1]),
            Diagonal(size),
            LowRank(columns),
        )
        states = np.stack([np.ones(N), TIME], axis=1)
        unknown = np.sin(5.0 * TIME)[:, None]
        piece = Piece(TIME, np.zeros(N, int), np.zeros(N), states, unknown, 1e-6 * np.eye(N), parts)
        root = np.linalg.cholesky(piece.covariance(np.array(theta)))
        residual = root @ rng.normal(size=N) + states @ rng.normal(size=2) + 0.7 * unknown[:, 0]
        found.append(Piece(TIME, piece.channel, residual, states, unknown, piece.known, parts))
    return found


def estimated(theta: list[float], seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Estimates and their standard deviations by the average information."""
    made = pieces(theta, seed)
    weights = np.ones(len(made))
    start, _ = climbed(made, NO_PRIOR, np.array([1.0, 0.1, 0.1, 0.1]), weights, 0, 10)
    found, state = maximise(made, NO_PRIOR, start, weights)
    return found, np.sqrt(2.0 * np.diagonal(np.linalg.inv(state.information)))


def test_known_variances_are_recovered() -> None:
    """Within three standard deviations each, and right on average over eight simulations."""
    truth = np.array([1.0, 0.5, 2.0, 3.0])
    found = [estimated(truth.tolist(), seed) for seed in range(8)]
    z = np.array([(values - truth) / sd for values, sd in found])
    assert np.all(np.abs(z) < 3.5)
    assert np.all(np.abs(z.mean(axis=0)) < 3.0 / np.sqrt(len(z)))
    assert 0.4 < np.mean(z**2) < 1.8


@pytest.mark.parametrize("absent", [1, 2, 3])
def test_what_is_absent_stays_at_its_bound(absent: int) -> None:
    """Half of the estimates are zero exactly, the others within chance."""
    truth = np.array([1.0, 0.5, 2.0, 3.0])
    truth[absent] = 0.0
    found = [estimated(truth.tolist(), seed) for seed in range(8)]
    values = np.array([values[absent] for values, _ in found])
    deviations = np.array([sd[absent] for _, sd in found])
    assert np.sum(values == 0.0) >= 1 and np.all(values < 3.0 * deviations)


def test_slope_and_weights_are_those_of_the_deviance() -> None:
    made = pieces([1.0, 0.5, 2.0, 3.0], 1)[:6]
    prior = Prior(np.array([[4.0]]), np.array([0.3]))
    weights = np.linspace(0.4, 1.0, 6)
    theta = np.array([0.8, 0.7, 1.5, 2.0])
    state = evaluate(made, prior, theta, np.ones(6))
    for k in range(4):
        step = np.zeros(4)
        step[k] = 1e-4
        ends = [evaluate(made, prior, theta + sign * step, np.ones(6)).deviance for sign in (1.0, -1.0)]
        assert state.slope[k] == pytest.approx((ends[0] - ends[1]) / 2e-4, rel=1e-4, abs=1e-4)
    lighter = evaluate(made, prior, theta, weights)
    assert lighter.deviance < state.deviance


def test_models_are_compared_without_how_much_the_recordings_show_of_their_states() -> None:
    """States in other units, or half hidden behind a sensor: the restricted likelihood changes, what compares does not.

    It is -2 log of the likelihood that the states make largest, by hand.
    """
    made, theta, weights = pieces([1.0, 0.5, 2.0, 3.0], 4)[:6], np.array([0.8, 0.7, 1.5, 2.0]), np.ones(6)
    hidden = [replace(p, by_state=p.by_state * 0.5) for p in made]
    full, less = (evaluate(p, NO_PRIOR, theta, weights) for p in (made, hidden))
    assert full.deviance - less.deviance == pytest.approx(sum(2.0 * p.by_state.shape[1] for p in made) * np.log(2.0))
    assert by_piece(full, made, 0) == pytest.approx(by_piece(less, hidden, 0), rel=1e-9)
    for piece, value in zip(made, by_piece(full, made, 0), strict=True):
        covariance = piece.covariance(theta)
        shift = full.estimate @ piece.by_unknown.T
        whiten = np.linalg.inv(np.linalg.cholesky(covariance))
        left = whiten @ (piece.residual - shift)
        left = left - whiten @ piece.by_state @ np.linalg.lstsq(whiten @ piece.by_state, left, rcond=None)[0]
        assert value == pytest.approx(np.linalg.slogdet(covariance)[1] + left @ left, rel=1e-6)


def test_an_unknown_that_changes_nothing_is_no_obstacle() -> None:
    made = [replace(p, by_unknown=np.column_stack([p.by_unknown, 0.0 * p.by_unknown])) for p in pieces([1, 1, 1, 1], 2)]
    prior = Prior(np.zeros((2, 2)), np.zeros(2))
    theta = np.ones(4)
    idle = evaluate(made, prior, theta, np.ones(PIECES))
    plain = evaluate(pieces([1, 1, 1, 1], 2), NO_PRIOR, theta, np.ones(PIECES))
    np.testing.assert_allclose(idle.slope, plain.slope, rtol=1e-6)


def shared_drift(seed: int) -> tuple[list[Piece], Prior]:
    """The windows of one recording of 30 s with a random walk of variance .3 after 10 s, white noise beside."""
    knots = Knots(np.arange(31.0), np.zeros(31, int), np.zeros(31, int), np.ones(31))
    components = (Component("white", 0), Component("slow_drift", 0, np.inf))
    prior = Prior(np.zeros((1, 1)), np.zeros(1), tuple(knots.covariance(c) for c in components))
    rng = np.random.default_rng(seed + 500)
    walk = prior.root(np.array([0.0, 0.3])) @ rng.normal(size=31)
    found = []
    for k, piece in enumerate(pieces([1.0, 0.0, 0.0, 0.0], seed)):
        near, weights = knots.near(0, piece.channel, 0.7 * k + TIME)
        residual = rng.normal(size=N) + 2.0 * TIME * rng.normal() + weights @ walk[near]
        alone = replace(piece, residual=residual, by_state=TIME[:, None], parts=(piece.parts[0], None))
        found.append(replace(alone, knots=near, at_knots=weights))
    return found, prior


def test_a_drift_over_the_recording_is_estimated() -> None:
    found = []
    for seed in range(10):
        made, prior = shared_drift(seed)
        weights = np.ones(len(made))
        start, _ = climbed(made, prior, np.array([1.0, 0.1]), weights, 0, 8)
        found.append(maximise(made, prior, start, weights)[0])
    assert np.mean(found, axis=0) == pytest.approx([1.0, 0.3], rel=0.35)


def test_slope_information_and_likelihood_of_a_drift_are_those_of_the_whole_covariance() -> None:
    """Against one dense matrix of all pieces, as if nobody knew that they are pieces."""
    made, prior = shared_drift(3)
    made = made[:8]
    theta, weights = np.array([0.8, 0.4]), np.ones(8)
    state = evaluate(made, prior, theta, weights)
    size = N * len(made)
    covariance, knots = np.zeros((size, size)), np.zeros((size, 31))
    states, unknown = np.zeros((size, len(made))), np.zeros((size, 1))
    residual = np.concatenate([p.residual for p in made])
    for k, piece in enumerate(made):
        own = slice(N * k, N * (k + 1))
        covariance[own, own] = piece.covariance(theta)
        knots[own, piece.knots] = piece.at_knots
        states[own, k : k + 1], unknown[own] = piece.by_state, piece.by_unknown
    walk = knots @ prior.drifts[1] @ knots.T
    inverse = np.linalg.inv(covariance + theta[1] * walk)
    fixed = np.concatenate([states, unknown], axis=1)
    gram = fixed.T @ inverse @ fixed
    projector = inverse - inverse @ fixed @ np.linalg.solve(gram, fixed.T @ inverse)
    a = projector @ residual
    deviance = np.linalg.slogdet(covariance + theta[1] * walk)[1] + np.linalg.slogdet(gram)[1] + residual @ a
    assert state.deviance == pytest.approx(deviance, abs=1e-5 * abs(deviance))
    assert state.slope[1] == pytest.approx(np.sum(projector * walk) - a @ walk @ a, rel=1e-5)
    assert state.information[1, 1] == pytest.approx(a @ walk @ projector @ walk @ a, rel=1e-5)
