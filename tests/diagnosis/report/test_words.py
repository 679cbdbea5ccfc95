"""Numbers as engineers read them."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from diagnosis.fit.intervals import Estimate
from diagnosis.report import words


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"), (1480.0, "1 480"), (0.0123456, "0.0123"), (-3.21987, "−3.22"), (4.5e7, "4.50 × 10⁷"),
        (2.5e-6, "2.50 × 10⁻⁶"), (math.inf, "∞"),
    ],
)  # fmt: skip
def test_numbers(value: float, text: str) -> None:
    assert words.number(value) == text


@given(st.floats(1e-12, 1e12))
def test_numbers_keep_three_digits(value: float) -> None:
    mantissa, times, exponent = words.number(value).partition(" × 10")
    back = exponent.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
    assert float(mantissa.replace(" ", "")) * 10.0 ** int(back or 0) == pytest.approx(value, rel=6e-3)
    assert bool(times) == bool(exponent)


def test_estimates_end_where_their_interval_does() -> None:
    assert words.estimate_texts(Estimate(0.12034, 0.11612, 0.12471, "1")) == ("0.1203", "0.1161 to 0.1247", "")
    assert words.estimate_texts(Estimate(0.0183, 0.0179, 0.0187, "s")) == ("18.30", "17.90 to 18.70", "ms")
    assert words.estimate_texts(Estimate(9.0, 5.0, math.inf, "Hz")) == ("9.00", "5.00 to ∞", "Hz")


def test_units_and_chances() -> None:
    assert words.unit_text("N m-2") == "N m⁻²" and words.unit_text("1") == ""
    assert words.quantity(2.941995, "m s-2") == "0.300 g" and words.quantity(0.0042, "rad") == "4.20 mrad"
    assert words.chance(5e-4) == "1 in 2 000" and words.chance(0.41) == "41 %"
    assert words.chance(None) == "not tested" and words.chance(1e-6) == "under one in a million"
    assert words.chance(0.0) == "under one in a million" and words.chance(1.0) == "certain"


def test_lists() -> None:
    assert [words.listed(x) for x in ([], ["a"], ["a", "b"], ["a", "b", "c"])] == ["", "a", "a and b", "a, b and c"]
