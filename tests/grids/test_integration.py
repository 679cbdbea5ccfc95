"""Displacements integrated from accelerations: the filter, and recordings that show it by themselves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from grids.instruments import recorded
from grids.instruments.base import Surroundings
from grids.instruments.integrated_displacement import high_passed
from grids.recordings.base import Recording
from grids.recordings.integration import integrated
from grids.recordings.levels import level_by_level

STEP, COUNT = 0.01, 12_000
TIME = STEP * np.arange(COUNT)
PAIR = ("level_displacement_x", "level_acceleration_x")


def test_a_sine_passes_with_the_squared_gain_of_both_filters_and_without_a_lag() -> None:
    around = Surroundings(STEP, np.zeros(COUNT))
    for ratio in (1.0, 1.5, 4.0):
        corner = 0.2
        wave = np.sin(2.0 * np.pi * ratio * corner * TIME)
        switched = {"integrated_displacement": {"high_pass_hz": corner}}
        found = recorded({PAIR[0]: wave[None]}, switched, around)[PAIR[0]][0]
        middle = slice(COUNT // 3, 2 * COUNT // 3)
        gain = (ratio**8 / (1.0 + ratio**8)) ** 2
        np.testing.assert_allclose(found[middle], gain * wave[middle], atol=2e-3)


def moving(noise: float = 0.0) -> Recording:
    """Two levels that move with a few frequencies, relative to a base that moves too; accelerations by calculus."""
    rng = np.random.default_rng(3)
    base, x, acceleration = np.zeros(COUNT), np.zeros((2, COUNT)), np.zeros((2, COUNT))
    for frequency in (0.05, 0.08, 0.11, 0.15, 0.2, 0.3, 0.45, 1.7):
        omega, phase = 2.0 * np.pi * frequency, rng.uniform(0.0, 6.0, 3)
        envelope = np.sin(np.pi * TIME / TIME[-1]) ** 4
        waves = [0.02 * envelope * np.sin(omega * TIME + p) for p in phase]
        base += np.gradient(np.gradient(waves[0], STEP), STEP)
        for k in range(2):
            x[k] += waves[k + 1]
    acceleration += np.gradient(np.gradient(x, STEP, axis=1), STEP, axis=1) + base
    acceleration += noise * rng.normal(size=acceleration.shape)
    channels = {"base_acceleration_x": base, PAIR[0]: x, PAIR[1]: acceleration}
    return Recording("made", STEP, TIME, channels, ("0", "1"))


@pytest.mark.parametrize("corner", [0.08, 0.2])
def test_the_corner_is_found_when_nobody_mentions_it(corner: float) -> None:
    plain = moving(0.002)
    seen = high_passed(high_passed(plain.channels[PAIR[0]], corner, STEP), corner, STEP)
    found = integrated([replace(plain, channels={**plain.channels, PAIR[0]: seen})], *PAIR)
    assert found is not None
    assert found.corner_hz == pytest.approx(corner, rel=0.04)
    assert f"{found.corner_hz:.3g} Hz" in str(found)


def test_a_displacement_that_was_measured_is_not_called_integrated() -> None:
    assert integrated([moving(0.002)], *PAIR) is None
    other = moving()
    mixed = {**other.channels, PAIR[0]: other.channels[PAIR[0]] + 0.005 * np.sin(0.9 * TIME)}
    assert integrated([replace(other, channels=mixed)], *PAIR) is None
    alone = {name: x for name, x in other.channels.items() if name != PAIR[1]}
    assert integrated([replace(other, channels=alone)], *PAIR) is None


def test_level_by_level_every_row_is_a_channel() -> None:
    recording = moving()
    split = level_by_level(recording)
    assert set(split.channels) == {"base_acceleration_x", *(f"{name}_{k}" for name in PAIR for k in range(2))}
    np.testing.assert_array_equal(split.channels["level_displacement_x_1"], recording.channels[PAIR[0]][1])


def test_recordings_too_coarse_to_tell_a_corner_tell_none() -> None:
    assert integrated([replace(moving(), time_step=1.0)], *PAIR) is None
