"""Windows: disjoint, started at peaks above the noise, never in quiet stretches."""

from __future__ import annotations

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st

from diagnosis.data.smoothing import smooth
from diagnosis.data.windows import ABOVE_NOISE, Window, cut, over_noise, rest_level
from models.identification import WindowLengths

STEP = 0.005
LENGTHS = WindowLengths(shortest=0.3, aim=0.6, longest=0.85, quiet=0.35, smoothing=0.05)


def windows(signal: np.ndarray, sigma: float, recording: int = 0) -> list[Window]:
    return cut(over_noise(signal, sigma, STEP, LENGTHS), STEP, recording, LENGTHS)


@settings(max_examples=25, deadline=None)
@example(1.0, 0.01953125, 0)  # slow enough to look at rest at its peaks
@given(st.floats(0.6, 2.5), st.floats(0.001, 0.02), st.integers(0, 1000))
def test_windows_are_disjoint_and_start_high(frequency: float, sigma: float, seed: int) -> None:
    time = np.arange(3000) * STEP
    motion = np.sin(2 * np.pi * frequency * time) * np.exp(-time / 6.0)
    signal = motion + sigma * np.random.default_rng(seed).normal(size=time.size)
    found = windows(signal, sigma, 3)
    rest = rest_level(smooth(signal, STEP, LENGTHS.smoothing), sigma, STEP, LENGTHS.quiet)
    assert found
    end = 0
    for window in found:
        assert window.recording == 3
        assert window.first >= end
        end = window.first + window.samples
        assert LENGTHS.shortest <= window.samples * STEP <= LENGTHS.longest + STEP
        assert abs(motion[window.first] - rest) > 0.6 * ABOVE_NOISE * sigma
    assert end <= signal.size


def test_nothing_starts_under_the_noise() -> None:
    signal = np.random.default_rng(0).normal(size=4000)
    assert windows(signal, 1.0) == []


def test_a_window_ends_where_the_motion_ends() -> None:
    time = np.arange(2000) * STEP
    signal = np.where(time < 3.0, np.sin(2 * np.pi * 1.5 * time), 0.0)
    last = windows(signal, 0.005)[-1]
    assert (last.first + last.samples) * STEP < 3.6
