"""Which of explanations that recordings cannot tell apart is named."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.search.found import GAP, rivals
from diagnosis.search.ties import settle_ties
from grids.instruments import INSTRUMENTS


@dataclass(frozen=True, eq=False)
class Candidate:
    """A mechanism with one parameter."""

    name: str
    parameter: str
    held: tuple[()] = ()
    price: float = 0.0

    @property
    def mechanism(self) -> Any:
        return INSTRUMENTS.get(self.name, SimpleNamespace(acts={}))

    @property
    def unknowns(self) -> tuple[Any, ...]:
        return (SimpleNamespace(name=f"{self.name}.{self.parameter}"),)


class Explained:
    """A fit of known loss to two windows, from 0 to 2 s and from 6 to 8 s; every parameter has the same ``value``."""

    def __init__(self, loss: float, *candidates: Candidate, value: float = 0.004) -> None:
        self.loss, self.candidates = loss, candidates
        self.fitted = SimpleNamespace(values={c.unknowns[0].name: value for c in candidates})
        self.measured = SimpleNamespace(
            windows=(0, 1), mask=np.ones((2, 1, 201), bool), times=lambda w: 6.0 * w + np.linspace(0.0, 2.0, 201)
        )

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(c.name for c in self.candidates)


GAIN, DELAY, CLOCK = Candidate("gain", "gain"), Candidate("delay", "delay"), Candidate("clock", "rate")
FILTER, HIGH = Candidate("filter", "corner_hz"), Candidate("filter", "high_pass_hz")


def named(best: Explained, *tried: Explained) -> tuple[tuple[str, ...], Any]:
    found: Any = SimpleNamespace(best=best, tried=list(tried), candidates=(GAIN, DELAY, CLOCK, FILTER, HIGH))
    settle_ties(found)
    return found.best.names, found


@pytest.mark.parametrize(
    ("loss", "expected"), [(100.2, ("filter",)), (108.0, ("filter",)), (112.0, ("delay",))], ids=str
)
def test_a_delay_that_a_low_pass_explains_as_well_is_a_low_pass(loss: float, expected: tuple[str, ...]) -> None:
    names, found = named(Explained(100.0, DELAY), Explained(loss, FILTER))
    assert names == expected
    assert "delay" in {name for e in found.tried for name in e.names} or expected == ("delay",)


def test_a_low_pass_is_never_taken_for_a_delay() -> None:
    assert named(Explained(100.0, FILTER), Explained(100.1, DELAY))[0] == ("filter",)
    assert named(Explained(100.0, FILTER), Explained(101.0, DELAY))[0] == ("filter",)


@pytest.mark.parametrize("lag", (-0.004, 0.012))
def test_a_lag_that_no_logger_s_filter_has_is_a_delay(lag: float) -> None:
    assert named(Explained(100.0, DELAY, value=lag), Explained(101.0, FILTER))[0] == ("delay",)


@pytest.mark.parametrize(
    ("rate", "expected"),
    [(-0.001, "filter"), (-0.0022, "filter"), (-0.0024, "clock"), (-0.008, "clock"), (0.001, "clock")],
)
def test_a_clock_that_lags_no_more_than_a_logger_s_filter_is_a_low_pass(rate: float, expected: str) -> None:
    """Recorded times run 4 s ahead on the mean of what is compared: by -4 times the rate the responses are late."""
    assert named(Explained(100.0, CLOCK, value=rate), Explained(104.0, FILTER))[0] == (expected,)
    assert named(Explained(100.0, CLOCK, value=rate), Explained(100.0 + 1.2 * GAP, FILTER))[0] == ("clock",)


def test_a_clock_and_a_delay_are_no_low_pass() -> None:
    both = Explained(100.0, CLOCK, DELAY, value=-0.001)
    assert set(named(both, Explained(101.0, FILTER, DELAY))[0]) == {"clock", "delay"}


def test_a_high_pass_does_not_stand_in_for_a_delay() -> None:
    assert named(Explained(100.0, DELAY), Explained(101.0, HIGH))[0] == ("delay",)


def test_what_stands_beside_the_delay_has_to_stay() -> None:
    pair = Explained(100.0, DELAY, GAIN)
    assert named(pair, Explained(103.0, FILTER, DELAY), Explained(104.0, FILTER))[0] == ("delay", "gain")
    assert set(named(pair, Explained(103.0, GAIN, FILTER))[0]) == {"filter", "gain"}


def test_equal_explanations_are_named_in_the_catalogue_s_order() -> None:
    assert named(Explained(100.0, FILTER), Explained(100.3, GAIN))[0] == ("gain",)


TILT, MASS = Candidate("tilt", "tilt"), Candidate("eccentricity", "offset")


@pytest.mark.parametrize(
    ("tried", "expected"),
    [
        ((Explained(101.0, TILT, DELAY), Explained(103.0, MASS, DELAY)), {"delay": 1.0, "eccentricity": 3.0}),
        ((Explained(103.0, MASS, DELAY),), {}),
        ((Explained(101.0, TILT, DELAY), Explained(100.0 + 2.0 * GAP, MASS, DELAY)), {"delay": 1.0}),
        ((Explained(105.0, MASS, FILTER), Explained(101.0, MASS)), {"eccentricity": 5.0}),
    ],
    ids=["beside a rival", "two new names", "too far off", "fewer effects"],
)
def test_beside_a_rival_what_stands_in_the_place_of_the_other_effect_is_one(
    tried: tuple[Explained, ...], expected: dict[str, float]
) -> None:
    found: Any = SimpleNamespace(best=Explained(100.0, TILT, FILTER), tried=list(tried))
    assert {near.candidate.name: near.gap for near in rivals(found)} == expected
    places = {"delay": ("filter",), "eccentricity": ("tilt",)}
    assert all(near.replaced == places[near.candidate.name] for near in rivals(found))
