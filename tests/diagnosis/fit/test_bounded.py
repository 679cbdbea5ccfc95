"""The step of a fit within its bounds: oracle, limits, and that it gains where anything does."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize

from diagnosis.errors.model import calibrated
from diagnosis.fit.bounded import bounded_step
from diagnosis.fit.setup import measure
from diagnosis.fit.unknowns import clip, of_parameter
from diagnosis.search.candidates import candidates
from diagnosis.search.refit import Explanation, extend
from models import get
from tests.diagnosis.walls import WALL, recorded

FREE = np.full(2, np.inf)
VALLEY = np.array([[1.0, -0.99], [-0.99, 1.0]])
"""Narrow, along the diagonal."""


def value(hessian: np.ndarray, gradient: np.ndarray, step: np.ndarray) -> float:
    return float(gradient @ step + 0.5 * step @ hessian @ step)


def test_without_bounds_in_the_way_it_is_that_of_newton() -> None:
    gradient = np.array([-1.0, -1.0])
    np.testing.assert_allclose(bounded_step(VALLEY, gradient, -FREE, FREE), np.linalg.solve(VALLEY, -gradient))
    damped = VALLEY + 3.0 * np.diag(np.diag(VALLEY))
    np.testing.assert_allclose(bounded_step(VALLEY, gradient, -FREE, FREE, 3.0), np.linalg.solve(damped, -gradient))


def test_at_a_bound_the_others_step_as_suits_that() -> None:
    """Cut at the bound, Newton's step (100, 100) would be (1, 100): uphill by 4800."""
    gradient = np.array([-1.0, -1.0])
    step = bounded_step(VALLEY, gradient, -FREE, np.array([1.0, np.inf]))
    np.testing.assert_allclose(step, [1.0, 1.99], rtol=1e-6)
    assert value(VALLEY, gradient, step) < 0.0 < value(VALLEY, gradient, np.array([1.0, 100.0]))


def test_what_pushes_against_a_bound_stays_and_what_leaves_it_goes() -> None:
    low = np.array([0.0, -np.inf])
    np.testing.assert_allclose(bounded_step(np.eye(2), np.array([1.0, 1.0]), low, FREE), [0.0, -1.0])
    np.testing.assert_allclose(bounded_step(np.eye(2), np.array([-1.0, 1.0]), low, FREE), [1.0, -1.0])
    np.testing.assert_array_equal(bounded_step(np.eye(2), np.ones(2), np.zeros(2), FREE), np.zeros(2))


@given(seed=st.integers(0, 10_000), count=st.integers(1, 8), damping=st.sampled_from([0.0, 0.1, 30.0]))
def test_it_stays_inside_and_gains_where_anything_does(seed: int, count: int, damping: float) -> None:
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(count + 2, count)) * np.exp(rng.normal(0.0, 2.0, count))
    hessian, gradient = root.T @ root, rng.normal(size=count) * np.exp(rng.normal(0.0, 2.0, count))
    low, high = -rng.exponential(1.0, count), rng.exponential(1.0, count)
    low[rng.random(count) < 0.2] = 0.0
    high[rng.random(count) < 0.3] = np.inf
    step = bounded_step(hessian, gradient, low, high, damping)
    assert np.all((low <= step) & (step <= high))
    damped = hessian + damping * np.diag(np.diag(hessian))
    pushed = ((low >= 0.0) & (gradient > 0.0)) | ((high <= 0.0) & (gradient < 0.0))
    gains = value(damped, gradient, step)
    assert gains < 0.0 or (pushed.all() and not step.any())
    newton = np.zeros(count)
    newton[~pushed] = np.linalg.solve(damped[np.ix_(~pushed, ~pushed)], -gradient[~pushed])
    if value(damped, gradient, np.clip(newton, low, high)) > 1e-6:  # else it is Newton's step, cut
        size = np.sqrt(np.diag(damped))
        scaled, slope = damped / np.outer(size, size), gradient / size
        oracle = minimize(
            lambda s: value(scaled, slope, s), np.zeros(count), jac=lambda s: slope + scaled @ s, method="L-BFGS-B",
            bounds=list(zip(low * size, high * size, strict=True)), options={"maxiter": 5000, "ftol": 1e-15},
        )  # fmt: skip
        assert gains == pytest.approx(oracle.fun, rel=1e-2)


def test_a_bound_that_is_no_range_holds_its_coordinate() -> None:
    step = bounded_step(VALLEY, np.array([-1.0, -1.0]), np.array([0.0, -1.0]), np.array([0.0, 0.5]))
    np.testing.assert_allclose(step, [0.0, 0.5])


def test_a_fit_goes_on_where_its_step_leaves_a_range() -> None:
    """Layers that shear and harden, begun at half of the hardening: the step of the stiffness leaves its range."""
    law = (("interface_shear.shear_over_normal", 0.05), ("hardening.beta2", 60.0))
    measured = measure(WALL, [recorded(1, law)])
    known = {c.unknowns[0].name: c for c in candidates(measured, WALL) if len(c.unknowns) == 1}
    shear, hardening = (known[name] for name, _ in law)
    base = Explanation((), calibrated(WALL, measured)[0])
    one = extend(base, shear, np.array([shear.unknowns[0].coordinate(0.05)]))
    start = np.array([hardening.unknowns[0].coordinate(30.0)])
    assert extend(one, hardening, start).loss < 0.7 * extend(one, hardening, start, 0).loss


def test_what_rounding_leaves_of_an_effect_at_its_bound_is_its_null() -> None:
    """A joint that gives way over 1e-19 rad would take 1e8 steps, which the model refuses: the answer was lost."""
    joint = get("housner").mechanisms["flexible_joint"]
    one = of_parameter(joint, joint.parameter("angle"))
    low, high = one.bounds
    near = np.array([[low + 1e-17], [high - 1e-12], [low + 1e-5]])
    assert [float(clip([one], u)[0]) for u in near] == [low, high, low + 1e-5]
    start = np.array([low + 0.3])
    step = bounded_step(np.eye(1), np.array([1.0]), low - start, high - start)
    assert one.value(float(clip([one], start + step * (1.0 - 1e-16))[0])) == 0.0
