"""Local cubics against scipy's, ends included, and on what they must leave as it is."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import savgol_filter

from diagnosis.data.smoothing import smooth

STEP = 0.004


@pytest.mark.parametrize("slope", [False, True])
@pytest.mark.parametrize(("samples", "width", "count"), [(200, 0.05, 13), (200, 0.0, 7), (8, 0.05, 7), (5, 1.0, 5)])
def test_they_are_those_of_savitzky_and_golay(samples: int, width: float, count: int, slope: bool) -> None:
    values = np.random.default_rng(samples).normal(size=samples)
    told = savgol_filter(values, count, 3, deriv=int(slope), delta=STEP)
    np.testing.assert_allclose(smooth(values, STEP, width, slope), told, rtol=1e-9, atol=1e-9 * np.abs(told).max())


@given(st.tuples(*[st.floats(-3.0, 3.0)] * 4), st.integers(9, 60))
def test_a_cubic_stays_and_has_its_slope(polynomial: tuple[float, ...], samples: int) -> None:
    time = STEP * np.arange(samples)
    values = np.polyval(polynomial, time)
    np.testing.assert_allclose(smooth(values, STEP, 0.03), values, atol=1e-9)
    slope = np.polyval(np.polyder(polynomial), time)
    np.testing.assert_allclose(smooth(values, STEP, 0.03, slope=True), slope, atol=1e-7)
