"""Recordings that were processed before they are diagnosed: each process does what it says, and no more."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from benchmarks.diagnosis.imperfections import draw
from benchmarks.diagnosis.laboratory import EACH_PROCESSED, processed
from benchmarks.diagnosis.processing import PROCESSED

HZ = 200.0
TIME = np.arange(4000) / HZ
RNG = np.random.default_rng(3)
NOISE = 1e-4
ROTATION = 0.02 * np.sin(2 * np.pi * 0.9 * TIME) * np.sin(np.pi * TIME / TIME[-1]) ** 2
CHANNELS = {
    "rotation_1": ROTATION + NOISE * RNG.normal(size=TIME.size),
    "base_acceleration_x": 2.0 * np.sin(2 * np.pi * 1.7 * TIME) * np.sin(np.pi * TIME / TIME[-1]) ** 2 + 0.01,
}
OF_BASE = ("zero_phase_all", "mean_removed", "base_corrected", "table_resonance")
OF_ROTATION = tuple(name for name in PROCESSED if name not in OF_BASE or name == "zero_phase_all")


def made(name: str, seed: int = 1) -> dict[str, np.ndarray]:
    return PROCESSED[name](CHANNELS, HZ, np.random.default_rng(seed))


@pytest.mark.parametrize("name", PROCESSED)
def test_a_process_changes_what_it_says_by_little_and_the_same_by_seed(name: str) -> None:
    found = made(name)
    changed = {channel for channel in CHANNELS if not np.array_equal(found[channel], CHANNELS[channel])}
    expected = {"rotation_1"} if name in OF_ROTATION else set()
    assert changed == expected | ({"base_acceleration_x"} if name in OF_BASE else set())
    for channel, plain in CHANNELS.items():
        assert found[channel].shape == plain.shape
        assert np.std(found[channel] - plain) < 0.15 * np.std(plain)
        np.testing.assert_array_equal(found[channel], made(name)[channel])


def test_filters_and_means_shift_no_phase() -> None:
    for name in ("zero_phase", "zero_phase_all", "moving_mean"):
        seen, inner = made(name)["rotation_1"], slice(400, 3600)
        late = np.gradient(ROTATION, 1.0 / HZ)[inner]
        lag = -np.sum((seen - ROTATION)[inner] * late) / np.sum(late**2)
        assert abs(lag) < 2e-4, name


def test_corrections_leave_no_mean_and_no_line() -> None:
    assert abs(made("mean_removed")["base_acceleration_x"].mean()) < 1e-12
    assert abs(np.polyfit(TIME, made("line_removed")["rotation_1"], 1)).max() < 1e-12
    assert abs(made("base_corrected")["base_acceleration_x"].mean()) < 1e-3


def test_a_coarse_logger_has_few_values_and_a_loud_one_more_noise() -> None:
    coarse = made("resolution")["rotation_1"]
    assert np.unique(coarse).size < 1200
    step = np.min(np.diff(np.unique(coarse)))
    np.testing.assert_allclose(coarse / step, np.round(coarse / step), atol=1e-6)
    loud = made("louder")["rotation_1"] - ROTATION
    half = loud.size // 2
    assert np.std(loud[:half]) == pytest.approx(NOISE, rel=0.1)
    assert 2.5 * NOISE < np.std(loud[half:]) < 7.0 * NOISE


def test_a_rotation_from_a_rate_drifts() -> None:
    off = np.array([made("gyroscope", seed)["rotation_1"] - CHANNELS["rotation_1"] for seed in range(30)])
    assert np.all(off[:, 0] == 0.0)
    early, late = (float(np.sqrt(np.mean(off[:, k] ** 2))) for k in (500, -1))
    assert late > 2.0 * early > 2.0 * NOISE


def test_every_process_is_asked_for_alike() -> None:
    designs = processed(5)
    counts = Counter((design.kind, design.imperfection) for design in designs)
    assert counts == {(kind, name): each for kind, each in EACH_PROCESSED.items() for name in PROCESSED}
    for design in designs:
        errors = draw(design.imperfection, design.names, HZ, np.random.default_rng(1))
        assert errors.described()["processing"] == design.imperfection
        assert not set(design.names) & set(errors.named_rightly)
