"""Samples that stand alone are marked as lost; motion, impacts and noise are not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import models
from diagnosis.data.stretches import as_means
from diagnosis.fit.setup import measure
from grids.recordings import read_recording
from grids.recordings.lost import with_lost_samples
from grids.recordings.spikes import spikes
from grids.recordings.stuck import stuck
from models.shaking import Shaking
from tests.diagnosis.buildings import SPECIMEN as BUILDING
from tests.diagnosis.buildings import made as building
from tests.diagnosis.made import SPECIMEN, recording

RUN = recording("run", 1)
ROTATION = RUN.channels["rotation_1"]
PEAK = float(np.max(np.abs(ROTATION)))
AT = (300, 707, 708, 1100)


def spiked(rotation: np.ndarray) -> np.ndarray:
    found = rotation.copy()
    found[[300, 1100]] += 0.3 * PEAK * np.array([1.0, -1.0])
    found[[707, 708]] = -0.8 * PEAK
    return found


def test_spikes_are_told_from_motion() -> None:
    assert spikes(spiked(ROTATION)).tolist() == list(AT)
    assert spikes(7.0 * spiked(ROTATION)).tolist() == spikes(-spiked(ROTATION)).tolist() == list(AT)


@pytest.mark.parametrize("noise", ["none", "white", "growing", "digits"])
def test_motion_and_noise_hold_no_spike(noise: str) -> None:
    """Nor the bends of a rotation without noise at its impacts, or where the noise grows with it."""
    for seed in range(1, 6):
        plain = recording("run", seed, noise=0.0).channels["rotation_1"]
        rng = np.random.default_rng(seed)
        added = {"white": 0.02 * PEAK, "growing": 0.03 * np.abs(plain)}.get(noise, 0.0)
        values = plain + added * rng.normal(size=plain.size)
        if noise == "digits":
            values = np.round(values / (0.02 * PEAK)) * 0.02 * PEAK
        assert not spikes(values).size


def test_a_channel_full_of_spikes_is_like_that() -> None:
    values = ROTATION.copy()
    values[::40] += 0.3 * PEAK
    assert not spikes(values).size


def test_what_stands_alone_is_not_compared(tmp_path: Path) -> None:
    channels = {
        "base_acceleration_x": ("time", RUN.channels["base_acceleration_x"], {"units": "m s-2"}),
        "rotation_1": ("time", spiked(ROTATION), {"units": "rad"}),
    }
    path = tmp_path / "run.nc"
    xr.Dataset(channels, coords={"time": ("time", RUN.time, {"units": "s"})}).to_netcdf(path)
    found = read_recording(path)
    assert found.lost["rotation_1"].tolist() == list(AT)
    assert any(
        "4 sample(s) of rotation_1 stand alone (1.5 s, 3.535 s, 3.54 s ...): they are lost" in note
        for note in found.notes
    )
    bridged = found.channels["rotation_1"][list(AT)]
    np.testing.assert_allclose(bridged, ROTATION[list(AT)], atol=6.0 * 0.01 * PEAK)
    measured = measure(SPECIMEN, [found])
    inside = {
        k for k in AT for w, mask in zip(measured.windows, measured.mask, strict=True)
        if 0 <= k - w.first < w.samples and not mask[0, k - w.first]
    }  # fmt: skip
    held = {k for k in AT for w in measured.windows if 0 <= k - w.first < w.samples}
    assert inside == held and held


def test_swings_of_few_samples_hold_no_spike() -> None:
    """A small block on a base of 2 to 8 Hz: the largest sample of a swing stands between two small ones."""
    rng, time = np.random.default_rng(3), np.arange(2000) * 0.005
    for height in (0.12, 0.2, 0.6):
        values = {"width": 0.25 * height, "height": height, "mass": 1.0}
        waves = [np.sin(2.0 * np.pi * f * time + p) for f, p in rng.uniform((2.0, 0.0), (8.0, 6.3), (12, 2))]
        base = np.sum(waves, axis=0) * np.minimum(time / 2.0, 1.0)
        shaking = Shaking(0.005, 1.5 * 9.81 * 0.25 * base / np.max(np.abs(base)))
        rotation = models.get("housner").simulate(values, shaking, duration=9.9).channels["rotation_1"]
        for every in (1, 2, 4):
            some = np.asarray(rotation)[::every]
            for share in (0.0, 0.002, 0.01):
                assert not spikes(some + share * np.max(np.abs(some)) * rng.normal(size=some.size)).size


@pytest.mark.parametrize("lost", [(300, 301, 302), (300, 301, 302, 303), (300, 302)])
def test_wider_gaps_are_left_as_they_are(lost: tuple[int, ...]) -> None:
    """Their sound neighbours would be taken for spikes."""
    values = 0.02 * np.sin(3.0 * RUN.time) + 2e-5 * np.random.default_rng(0).normal(size=RUN.time.size)
    values[list(lost)] += 0.02
    assert not spikes(values).size


def test_a_mean_over_a_lost_sample_is_lost() -> None:
    found = as_means(replace(RUN, lost={"rotation_1": np.array([300, 301, RUN.time.size - 1])}), 4)
    assert found.lost["rotation_1"].tolist() == [75]


def test_each_level_of_a_building_loses_samples_of_its_own() -> None:
    whole = building("small", 1.0, 1)
    sound = whole.channels["level_displacement_x"][0]
    rows = np.stack([sound, sound])
    rows[1, 1000] += 0.5 * np.max(np.abs(sound))
    found = with_lost_samples(
        replace(whole, channels={**whole.channels, "level_displacement_x": rows}, levels=("0", "3"))
    )
    assert {name: at.tolist() for name, at in found.lost.items()} == {"level_displacement_x_3": [1000]}
    assert "1 sample(s) of level_displacement_x_3 stand alone (20 s): they are lost" in found.notes[-1]
    np.testing.assert_array_equal(found.channels["level_displacement_x"][0], sound)
    np.testing.assert_allclose(found.channels["level_displacement_x"][1, 1000], sound[1000], atol=0.1 * np.std(sound))


def test_a_spike_of_a_level_is_not_compared() -> None:
    whole = building("small", 1.0, 1)
    rows = whole.channels["level_displacement_x"].copy()
    rows[0, 1000] += 0.5 * np.max(np.abs(rows))
    spiked_run = replace(whole, channels={**whole.channels, "level_displacement_x": rows})
    masks = [measure(BUILDING, [with_lost_samples(one)]).mask for one in (whole, spiked_run)]
    assert masks[0].sum() - masks[1].sum() == 1


def test_samples_that_a_logger_held_are_lost_and_those_at_the_end_of_a_range_are_not() -> None:
    values = ROTATION.copy()
    values[500:520] = values[500]
    assert stuck(values).tolist() == list(range(501, 520))
    assert not stuck(ROTATION).size and not stuck(np.clip(ROTATION, -0.5 * PEAK, 0.5 * PEAK)).size
    assert not stuck(np.round(ROTATION / (0.02 * PEAK)) * 0.02 * PEAK).size  # digits as coarse as the noise
    still = recording("run", 1, noise=0.0).channels["rotation_1"]
    assert not stuck(np.concatenate([np.zeros(200), still])).size  # a computed channel that begins at rest
    found = with_lost_samples(replace(RUN, channels={**RUN.channels, "rotation_1": values}))
    assert found.lost["rotation_1"].tolist() == list(range(501, 520))
    assert "19 sample(s) of rotation_1 repeat the one before" in found.notes[-1]
    line = np.linspace(values[500], values[520], 21)
    np.testing.assert_allclose(found.channels["rotation_1"][500:521], line, atol=1e-12)
