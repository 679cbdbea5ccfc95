"""Drifts take up little: where they lie far from what the errors say of them they hold what a model lacks."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.search.found import ADEQUATE, adequate, misfit_per_sample, strained
from diagnosis.search.refit import Explanation
from tests.diagnosis.made import SPECIMEN, scattered

NOISE = 0.01


def drifting(rng: np.random.Generator, samples: int) -> np.ndarray:
    """White noise and a walk that ends about one noise level away."""
    walk = np.cumsum(rng.normal(size=samples)) / np.sqrt(samples)
    return np.asarray(rng.normal(size=samples) + walk)


def knocked(rng: np.random.Generator, samples: int) -> np.ndarray:
    """White noise, and a zero that jumps by twelve noise levels when the motion begins."""
    return np.asarray(rng.normal(size=samples) + 12.0 * (np.arange(samples) > 0.2 * samples))


@pytest.mark.parametrize(("errors", "beyond"), [(drifting, False), (knocked, True)])
def test_a_zero_that_jumps_is_no_drift(errors: Callable[[np.random.Generator, int], np.ndarray], beyond: bool) -> None:
    runs = [scattered(f"run_{seed}", seed, noise=NOISE, errors=errors) for seed in (1, 4)]
    fitted, _ = calibrated(SPECIMEN, measure(SPECIMEN, runs))
    base = Explanation((), fitted)
    assert misfit_per_sample(base) < ADEQUATE  # so it shows in the drifts alone
    assert strained(base) == beyond
    assert adequate(base) != beyond
