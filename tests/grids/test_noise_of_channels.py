"""The noise of a channel: its level and whether it is white, whatever motion and hum lie under it."""

from __future__ import annotations

import numpy as np
import pytest

from grids.recordings import noise_of
from grids.recordings.lines import without_lines
from models.errors import InputError


@pytest.mark.parametrize("sigma", [1e-4, 1e-2])
def test_noise_of_white_noise_on_a_smooth_signal(sigma: float) -> None:
    rng = np.random.default_rng(3)
    time = np.arange(20_000) * 0.002
    smooth = np.sin(2 * np.pi * 1.5 * time) + 0.3 * np.abs(np.sin(2 * np.pi * 0.7 * time))
    found = noise_of(smooth + rng.normal(0, sigma, time.size))
    assert found.sigma == pytest.approx(sigma, rel=0.03)
    assert found.white
    filtered = np.convolve(rng.normal(0, sigma, time.size), [0.25, 0.5, 0.25], mode="same")
    assert not noise_of(smooth + filtered).white


def test_noise_scales_with_the_channel_and_vanishes_without_noise() -> None:
    rng = np.random.default_rng(4)
    values = np.cumsum(rng.normal(0, 1e-4, 2000)) + rng.normal(0, 0.1, 2000)
    assert noise_of(1e3 * values).sigma == pytest.approx(1e3 * noise_of(values).sigma, rel=1e-12)
    assert noise_of(np.zeros(100)).sigma == 0.0
    shaken = np.concatenate([np.zeros(24), np.random.default_rng(0).normal(size=16)])
    assert noise_of(shaken).sigma == 0.0  # a computed channel that begins at rest
    with pytest.raises(InputError, match="10 samples is too short"):
        noise_of(np.zeros(10))


@pytest.mark.parametrize("frequency", [30.0, 50.0, 60.0, 70.0, 88.3])
def test_hum_is_no_noise(frequency: float) -> None:
    """A steady line three times the noise, wherever the local polynomial leaves it."""
    rng, time = np.random.default_rng(6), np.arange(1600) * 0.005
    values = 0.05 * np.sin(7.0 * time) + rng.normal(0, 1e-4, time.size)
    found = noise_of(values + 3e-4 * np.sin(2 * np.pi * frequency * time + 0.3))
    assert found.white and found.sigma == pytest.approx(noise_of(values).sigma, rel=0.05)


@pytest.mark.parametrize("samples", [300, 5000])
def test_noise_has_no_lines(samples: int) -> None:
    for seed in range(20):
        values = np.random.default_rng(seed).normal(size=samples)
        assert without_lines(values) is values
