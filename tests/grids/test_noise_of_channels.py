"""The noise of a channel: its level and whether it is white, whatever motion and hum lie under it."""

from __future__ import annotations

import numpy as np
import pytest

from grids.recordings import noise_of
from grids.recordings.base import Recording
from grids.recordings.lines import without_lines
from grids.recordings.noise import louder
from grids.recordings.suspicions import suspicions_of
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


STEP, COUNT = 0.005, 3000
TIME = STEP * np.arange(COUNT)
MOTION = 0.03 * np.sin(6.0 * TIME) * np.exp(-(((TIME - 7.0) / 3.0) ** 2))


def white(seed: int) -> np.ndarray:
    return 1e-4 * np.random.default_rng(seed).normal(size=COUNT)


@pytest.mark.parametrize("ratio", [3.0, 6.0, 0.3])
@pytest.mark.parametrize("at", [900, 2000])
def test_noise_that_becomes_another_is_found_where_it_does(ratio: float, at: int) -> None:
    found = louder(MOTION + white(1) * np.where(np.arange(COUNT) < at, 1.0, ratio))
    assert found is not None and abs(found.sample - at) < 30
    assert found.before == pytest.approx(1e-4, rel=0.1) and found.after == pytest.approx(ratio * 1e-4, rel=0.1)


def test_noise_of_one_level_stays_one_whatever_lies_under_it() -> None:
    """White, coloured, in proportion to the motion, with hum or with knocks; none at all; too short to tell."""
    for seed in range(20):
        noise = white(seed)
        assert louder(MOTION + noise) is None
        assert louder(MOTION + noise + 0.03 * np.abs(MOTION) * white(seed + 100) / 1e-4) is None
        assert louder(MOTION + np.convolve(noise, [0.25, 0.5, 0.25], "same")) is None
        assert louder(MOTION + noise + 3e-4 * np.sin(2 * np.pi * 50.0 * TIME)) is None
        knocks = np.zeros(COUNT)
        knocks[1700::97] = 5e-3
        assert louder(MOTION + noise + knocks) is None
        assert louder(noise[:200] * np.where(np.arange(200) < 100, 1.0, 5.0)) is None
    assert louder(MOTION) is None and louder(np.zeros(COUNT)) is None


def test_a_channel_that_becomes_louder_is_suspected() -> None:
    change = np.where(np.arange(COUNT) < 2000, 1.0, 4.0)
    channels = {"base_acceleration_x": 1e2 * MOTION, "rotation_1": MOTION + white(2)}
    assert not any("the noise" in one for one in suspicions_of(Recording("run", STEP, TIME, channels)))
    channels["rotation_1"] = MOTION + change * white(2)
    (said,) = (one for one in suspicions_of(Recording("run", STEP, TIME, channels)) if "the noise" in one)
    assert said.startswith("rotation_1 has 3.8 times the noise from 10.0 s on")
