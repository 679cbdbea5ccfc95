"""The noise that residuals are weighed with: white, coloured by an instrument's filter, or none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.signal import butter, lfilter, sosfiltfilt

from diagnosis import diagnose
from diagnosis.data.noise import BANDS, density_level, response_levels, response_noise, still
from diagnosis.fit.setup import measure
from grids.recordings import noise_of
from grids.recordings.base import Recording
from grids.specimen import with_mechanism
from tests.diagnosis.made import SPECIMEN, TIME_STEP, recording

SIGMA = 6e-4


def with_noise(seed: int, corner: float | None) -> tuple[Recording, float]:
    """A rocking block's rotation, still at both ends, and the density its noise has where effects lie."""
    clean = recording("clean", seed, noise=0.0)
    rotation = clean.channels["rotation_1"]
    rest = np.zeros(round(2.0 / TIME_STEP))
    rotation = np.concatenate([rest, rotation * np.linspace(1.0, 0.0, rotation.size), rest])
    noise = SIGMA * np.random.default_rng(seed).normal(size=rotation.size)
    if corner is not None:
        noise = lfilter(*butter(2, corner, fs=1.0 / TIME_STEP), noise)
    base = np.zeros(rotation.size)
    channels = {"base_acceleration_x": base, "rotation_1": rotation + noise}
    return Recording("made", TIME_STEP, np.arange(rotation.size, dtype=np.float64) * TIME_STEP, channels), SIGMA


def after_rest(name: str, seed: int) -> Recording:
    """A recording of a block as the model has it, .4 % noise through a 20 Hz filter, a second of rest before it."""
    clean, rest = recording(name, seed, noise=0.0), round(1.0 / TIME_STEP)
    rng = np.random.default_rng(seed)
    rotation = np.concatenate([np.zeros(rest), clean.channels["rotation_1"]])
    noise = lfilter(*butter(2, 20.0, fs=1.0 / TIME_STEP), rng.normal(size=rotation.size + rest))[rest:]
    base = np.concatenate([np.zeros(rest), clean.channels["base_acceleration_x"]])
    channels = {
        "base_acceleration_x": base + 0.003 * np.max(np.abs(base)) * rng.normal(size=base.size),
        "rotation_1": rotation + 0.004 * np.max(np.abs(rotation)) * noise / np.std(noise),
    }
    return Recording(name, TIME_STEP, np.arange(rotation.size, dtype=np.float64) * TIME_STEP, channels)


def test_coloured_noise_is_no_effect() -> None:
    found = diagnose(SPECIMEN, [after_rest("train_1", 2), after_rest("train_2", 4)])
    assert found.verdict == "nothing_missing", found.statement


@pytest.mark.parametrize(("order", "corner", "off"), [(4, 15.0, 0.25), (4, 25.0, 0.25), (2, 8.0, 0.4), (2, 5.0, 0.4)])
def test_the_density_is_that_below_a_filter_without_phase(order: int, corner: float, off: float) -> None:
    """Next to nothing is left of the noise at the highest frequencies, which says nothing of where effects lie."""
    plain, density = with_noise(3, None)
    sections = butter(order, corner, fs=1.0 / TIME_STEP, output="sos")
    rotation = sosfiltfilt(sections, plain.channels["rotation_1"])
    made = replace(plain, channels={**plain.channels, "rotation_1": rotation})
    assert noise_of(rotation).sigma < 0.02 * density
    assert response_noise(made, "rotation_1") == pytest.approx(density, rel=off)


def test_noise_is_what_moves_on_a_base_at_rest() -> None:
    """At 1000 samples a second 10 Hz forwards and backwards leave nothing of it where a motion has nothing either."""
    plain, density = with_noise(3, None)
    step, sections = 0.001, butter(4, 10.0, fs=1000.0, output="sos")
    time = np.arange(0.0, plain.time[-1], step)
    noise = density * np.random.default_rng(5).normal(size=time.size)
    clean = np.where((time < 2.0) | (time > time[-1] - 2.0), 0.0, 0.03 * np.sin(2.0 * np.pi * 1.3 * (time - 2.0)))
    rotation = sosfiltfilt(sections, clean + noise)
    base = 2.0 * np.sin(2.0 * np.pi * 2.0 * time) * (clean != 0.0)
    base = sosfiltfilt(sections, base + 0.004 * np.random.default_rng(6).normal(size=time.size))
    made = Recording("made", step, time, {"base_acceleration_x": base, "rotation_1": rotation})
    assert noise_of(rotation).sigma < 1e-4 * density
    assert response_noise(made, "rotation_1") == pytest.approx(density, rel=0.3)
    moved = replace(made, channels={**made.channels, "base_acceleration_x": 2.0 * np.sin(2.0 * np.pi * 2.0 * time)})
    assert response_noise(moved, "rotation_1") <= 1.01e-4 * np.max(np.abs(rotation))


@pytest.mark.parametrize("corner", [8.0, 12.0])
def test_nothing_is_missing_behind_a_slow_filter_that_is_declared(corner: float) -> None:
    """Two seconds of rest, 1 % noise, forwards and backwards through a low-pass of the second order."""

    def made(name: str, seed: int) -> Recording:
        clean, rng = recording(name, seed, noise=0.0), np.random.default_rng(seed)
        rest = np.zeros(round(2.0 / TIME_STEP))
        rotation, base = (np.concatenate([rest, clean.channels[c]]) for c in ("rotation_1", "base_acceleration_x"))
        noisy = rotation + 0.01 * np.max(np.abs(rotation)) * rng.normal(size=rotation.size)
        channels = {
            "base_acceleration_x": base + 0.003 * np.max(np.abs(base)) * rng.normal(size=base.size),
            "rotation_1": sosfiltfilt(butter(2, corner, fs=1.0 / TIME_STEP, output="sos"), noisy),
        }
        return Recording(name, TIME_STEP, np.arange(rotation.size, dtype=np.float64) * TIME_STEP, channels)

    declared = with_mechanism(SPECIMEN, "filter", {"corner_hz": corner, "order": 2.0, "zero_phase": 1.0})
    found = diagnose(declared, [made("train_1", 2), made("train_2", 4)])
    assert found.verdict == "nothing_missing", found.statement


def test_noise_that_becomes_louder_is_no_effect() -> None:
    """Four times from the middle of each recording on: what is compared is weighed by the level of its time."""

    def made(name: str, seed: int) -> Recording:
        one = recording(name, seed)
        rotation = one.channels["rotation_1"]
        late = np.arange(rotation.size) >= rotation.size // 2
        noise = np.sqrt(15.0) * 0.01 * np.max(np.abs(rotation)) * np.random.default_rng(seed).normal(size=rotation.size)
        return replace(one, channels={**one.channels, "rotation_1": rotation + late * noise})

    recordings = [made("train_1", 2), made("train_2", 4)]
    for one in recordings:
        levels = response_levels(one, "rotation_1")
        assert levels[-1] == pytest.approx(4.0 * levels[0], rel=0.15)
    measured = measure(SPECIMEN, recordings)
    ratio = measured.units[-1, 0] / measured.units[0, 0]
    assert measured.recording_of[-1] == 1 and ratio == pytest.approx(4.0 * _peak(recordings), rel=0.15)
    found = diagnose(SPECIMEN, recordings)
    assert found.verdict == "nothing_missing", found.statement


def _peak(recordings: list[Recording]) -> float:
    """Of the levels before, of the second recording over the first."""
    first, second = (response_levels(one, "rotation_1")[0] for one in recordings)
    return float(second / first)


@pytest.mark.parametrize("corner", [None, 20.0, 30.0, 45.0])
def test_the_density_is_that_below_the_filter(corner: float | None) -> None:
    made, density = with_noise(3, corner)
    assert response_noise(made, "rotation_1") == pytest.approx(density, rel=0.2)
    if corner == 30.0:
        assert noise_of(made.channels["rotation_1"]).sigma < 0.3 * density  # what the local polynomial sees


def test_white_noise_keeps_the_level_of_the_local_polynomial() -> None:
    made, _ = with_noise(4, None)
    assert response_noise(made, "rotation_1") == noise_of(made.channels["rotation_1"]).sigma


@settings(max_examples=12, deadline=None)
@given(st.integers(1, 10_000))
@example(783)
def test_motion_without_noise_is_not_noise(seed: int) -> None:
    """At most of a twentieth of the 1 % of the peak that recordings have."""
    made = recording("clean", seed, noise=0.0)
    peak = float(np.max(np.abs(made.channels["rotation_1"])))
    assert response_noise(made, "rotation_1") <= 5e-4 * peak


@pytest.mark.parametrize("seed", [30, 38, 44, 174])
def test_free_rocking_on_a_base_at_rest_is_not_noise(seed: int) -> None:
    """Parabolic arcs that shrink by 2 % each, so slowly that they are as still as anything in the recording."""
    clean = recording("clean", seed, noise=0.0)
    rotation, base = clean.channels["rotation_1"], clean.channels["base_acceleration_x"]
    arcs, height = [], 0.02
    while sum(arc.size for arc in arcs) * TIME_STEP < 6.0:
        share = np.arange(0.0, 1.0, TIME_STEP / (0.8 * np.sqrt(height / 0.02)))
        arcs.append((-1.0) ** len(arcs) * height * 4.0 * share * (1.0 - share))
        height *= 0.98
    rotation = np.concatenate([rotation, *arcs])
    base = np.concatenate([base, np.zeros(rotation.size - base.size)])
    base = base + 0.003 * np.max(np.abs(base)) * np.random.default_rng(seed).normal(size=base.size)
    channels = {"base_acceleration_x": base, "rotation_1": rotation}
    made = Recording("made", TIME_STEP, np.arange(rotation.size, dtype=np.float64) * TIME_STEP, channels)
    assert response_noise(made, "rotation_1") <= 1.01e-4 * np.max(np.abs(rotation))


def test_nothing_still_no_level() -> None:
    time = np.arange(2000) * TIME_STEP
    for values in (np.sin(2.0 * np.pi * 1.3 * time), np.zeros(2000)):
        assert density_level(values, TIME_STEP, still(values, TIME_STEP)) == 0.0
    assert still(np.ones(10), TIME_STEP) == []


def test_few_lines_tell_of_no_spectrum() -> None:
    arc = np.linspace(-1.0, 1.0, round(0.75 / TIME_STEP)) ** 2
    assert density_level(arc, TIME_STEP, [slice(0, arc.size)], BANDS) == 0.0
