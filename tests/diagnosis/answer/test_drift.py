"""A property over a sequence of tests: constant where it is, with what it changes where the tests can tell."""

from __future__ import annotations

import numpy as np
import pytest

from diagnosis.answer.drift import Drift, drift_of, value_at
from diagnosis.fit.intervals import QUANTILE, Estimate
from models.errors import InputError
from models.identification import Exposure

STRAIN = Exposure("strain", "largest strain so far", "peak_strain", ("k",))
CLOSINGS = Exposure("closings", "closings so far", "closings", ("k",), summed=True)
ERROR = 0.02


def sequence(
    true: np.ndarray, rng: np.random.Generator | None, exposed: dict[Exposure, list[float]] | None = None
) -> Drift:
    """Estimates of a property with errors of 2 %, or without errors."""
    seen = true if rng is None else true * np.exp(ERROR * rng.normal(size=true.size))
    half = np.exp(QUANTILE * ERROR)
    estimates = {f"test_{i}": Estimate(x, x / half, x * half, "N m-2") for i, x in enumerate(seen.tolist())}
    found = drift_of("k", estimates, [(e, np.array(x, float)) for e, x in (exposed or {}).items()])
    assert found is not None
    return found


def test_constancy_is_rejected_by_chance_as_often_as_it_should() -> None:
    rng = np.random.default_rng(1)
    p_values = np.array([sequence(np.full(5, 3e7), rng).p_constant for _ in range(2000)])
    for level in (0.05, 0.2, 0.5):
        assert np.mean(p_values < level) == pytest.approx(level, abs=4.0 * np.sqrt(level * (1.0 - level) / 2000))


@pytest.mark.parametrize("driver", [STRAIN, CLOSINGS])
def test_a_change_is_told_where_weaker_tests_follow_stronger_ones(driver: Exposure) -> None:
    """Between equal largest strains only closings go on: five tests of 3 % to 40 % change tell which of them it is."""
    exposed: dict[Exposure, list[float]] = {STRAIN: [0.1, 0.4, 0.4, 0.4, 0.7], CLOSINGS: [2.0, 12.0, 30.0, 52.0, 70.0]}
    x = np.array(exposed[driver])
    rng = np.random.default_rng(2)
    found = [sequence(1.0 - 0.5 * -np.expm1(-x / (0.6 * x.max())), rng, exposed) for _ in range(60)]
    named = [[c.exposure for c in one.with_what] for one in found]
    assert np.mean([names == [driver] for names in named]) > 0.9
    assert not any(names == [other] for names in named for other in exposed if other is not driver)


def test_tests_that_only_grow_cannot_tell_strain_from_closings() -> None:
    exposed: dict[Exposure, list[float]] = {STRAIN: [0.1, 0.2, 0.3, 0.4], CLOSINGS: [10.0, 20.0, 30.0, 40.0]}
    found = sequence(np.exp([-0.1, -0.2, -0.3, -0.4]), None, exposed)
    assert {c.exposure for c in found.with_what} == {STRAIN, CLOSINGS}
    assert "these tests cannot tell" in repr(found)


def test_the_value_at_a_strain_is_that_of_the_law_and_none_is_given_beyond_the_tests() -> None:
    strain = np.array([0.1, 0.3, 0.3, 0.6, 0.6])
    law = 4e7 * np.exp(-0.5 * -np.expm1(-strain / 0.3))
    found = sequence(law, np.random.default_rng(4), {STRAIN: strain.tolist(), CLOSINGS: [0.0, 9.0, 13.0, 31.0, 60.0]})
    assert value_at(found, "strain", 0.3) == pytest.approx(4e7 * np.exp(-0.5 * (1.0 - np.exp(-1.0))), rel=3 * ERROR)
    with pytest.raises(InputError, match=r"beyond the tests, 0\.1 to 0\.6"):
        value_at(found, "strain", 0.9)


def test_a_constant_property_has_its_mean_at_every_strain_that_was_tested() -> None:
    found = sequence(np.full(4, 5.0), np.random.default_rng(5), {STRAIN: [0.1, 0.2, 0.3, 0.4]})
    assert not found.drifts and value_at(found, "strain", 0.35) == found.mean == pytest.approx(5.0, rel=3 * ERROR)
    with pytest.raises(InputError, match="beyond the tests"):
        value_at(found, "strain", 9.0)
    assert "stays the same" in repr(found)


def test_a_property_that_follows_neither_is_said_and_not_interpolated() -> None:
    found = sequence(
        np.array([1.0, 0.6, 1.0, 0.6, 1.0]), np.random.default_rng(6), {STRAIN: [0.1, 0.2, 0.3, 0.4, 0.5]}
    )  # fmt: skip
    assert found.drifts and "neither" in repr(found)
    with pytest.raises(InputError, match="take the value of one test"):
        value_at(found, "strain", 0.3)
