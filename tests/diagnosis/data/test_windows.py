"""Windows: disjoint, started at peaks above the noise, never in quiet stretches."""

from __future__ import annotations

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st

from diagnosis.data.noise import smooth
from diagnosis.data.windows import ABOVE_NOISE, LONGEST, SHORTEST, SMOOTHING, cut, rest_level

STEP = 0.005


@settings(max_examples=25, deadline=None)
@example(1.0, 0.01953125, 0)  # slow enough to look at rest at its peaks
@given(st.floats(0.6, 2.5), st.floats(0.001, 0.02), st.integers(0, 1000))
def test_windows_are_disjoint_and_start_high(frequency: float, sigma: float, seed: int) -> None:
    time = np.arange(3000) * STEP
    motion = np.sin(2 * np.pi * frequency * time) * np.exp(-time / 6.0)
    signal = motion + sigma * np.random.default_rng(seed).normal(size=time.size)
    found = cut(signal, sigma, STEP, 3)
    rest = rest_level(smooth(signal, STEP, SMOOTHING), sigma, STEP)
    assert found
    end = 0
    for window in found:
        assert window.recording == 3
        assert window.first >= end
        end = window.first + window.samples
        assert SHORTEST <= window.samples * STEP <= LONGEST + STEP
        assert abs(motion[window.first] - rest) > 0.6 * ABOVE_NOISE * sigma
    assert end <= signal.size


def test_nothing_starts_under_the_noise() -> None:
    signal = np.random.default_rng(0).normal(size=4000)
    assert cut(signal, 1.0, STEP, 0) == []


def test_a_window_ends_where_the_motion_ends() -> None:
    time = np.arange(2000) * STEP
    signal = np.where(time < 3.0, np.sin(2 * np.pi * 1.5 * time), 0.0)
    last = cut(signal, 0.005, STEP, 0)[-1]
    assert (last.first + last.samples) * STEP < 3.6
