"""Scaling, cutting, stretching, resampling: what each keeps."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grids.motions import Motion, read_motion
from grids.motions.intensity import intensity_measures
from grids.motions.resample import resample
from models.errors import InputError

factors = st.floats(0.01, 100.0)
samples = st.lists(st.integers(-9000, 9000).map(lambda i: i / 1000), min_size=2, max_size=40).filter(any)


@given(samples, factors)
def test_scaled_to_pga_reaches_it_and_keeps_the_ratio_of_the_components(values, pga):
    motion = Motion("m", 0.01, np.array(values), 0.5 * np.array(values)[::-1]).scaled_to_pga(pga)
    assert motion.pga == pytest.approx(pga, rel=1e-12)
    np.testing.assert_allclose(motion.vertical, 0.5 * motion.horizontal[::-1], rtol=1e-12)


@given(samples, factors, factors)
def test_scales_multiply(values, first, second):
    motion = Motion("m", 0.01, np.array(values))
    np.testing.assert_allclose(
        motion.scaled(first).scaled(second).horizontal, motion.scaled(first * second).horizontal, rtol=1e-12
    )


@given(samples, factors, factors)
def test_intensity_follows_the_dimensions_of_length_and_time(values, scale, stretch):
    motion = Motion("m", 0.01, np.array(values))
    one = intensity_measures(motion, high_pass=None)
    other = intensity_measures(motion.scaled(scale).time_scaled(stretch), high_pass=None)
    assert other.pga == pytest.approx(scale * one.pga)
    assert other.pgv == pytest.approx(scale * stretch * one.pgv)
    assert other.pgd == pytest.approx(scale * stretch**2 * one.pgd)
    assert other.arias == pytest.approx(scale**2 * stretch * one.arias)
    assert other.significant_duration == pytest.approx(stretch * one.significant_duration)


@given(samples, st.text(max_size=5))
def test_fingerprint_is_of_step_and_samples_alone(values, name):
    motion = Motion("m", 0.01, np.array(values))
    assert Motion(name, 0.01, np.array(values), notes=("x",)).fingerprint == motion.fingerprint
    changed = np.array(values)
    changed[0] += 1e-6
    others = [Motion("m", 0.01, changed), Motion("m", 0.02, np.array(values))]
    others.append(Motion("m", 0.01, np.array(values), np.array(values)))
    assert motion.fingerprint not in {other.fingerprint for other in others}


def test_samples_are_copied_and_cannot_be_changed():
    values = np.ones(20)
    motion = Motion("m", 0.01, values)
    values[:] = 7.0
    assert motion.pga == 1.0
    with pytest.raises(ValueError, match="read-only"):
        motion.horizontal[0] = 2.0


def test_cut_keeps_both_ends_and_says_so():
    motion = read_motion("ridgecrest_2019_clc", component="north")
    part = motion.cut(12.0, 20.0)
    assert part.duration == pytest.approx(8.0)
    np.testing.assert_array_equal(part.horizontal, motion.horizontal[1200:2001])
    np.testing.assert_array_equal(part.vertical, motion.vertical[1200:2001])
    assert part.notes[-1] == "cut to 12 .. 20 s"
    assert motion.cut().fingerprint == motion.fingerprint


def test_shaking_is_the_motion_as_it_stands():
    motion = read_motion("ridgecrest_2019_clc", component="north")
    shaking = motion.shaking()
    assert shaking.pga == motion.pga and shaking.duration == motion.duration
    assert motion.without_vertical().shaking().vertical is None


def wave_packet(times, highest):
    """Content up to ``highest`` Hz to about 1e-9, and nothing at the ends."""
    packet = np.zeros_like(times)
    for share, centre, phase in ((0.15, 9.0, 0.3), (0.5, 11.0, 1.1), (1.0, 10.0, 2.0)):
        frequency = share * (highest - 1.0)
        packet += np.sin(2 * np.pi * frequency * times + phase) * np.exp(-((times - centre) ** 2) / 2 / 1.1**2)
    return packet


@pytest.mark.parametrize("new_step", [0.005, 0.002, 0.01, 0.004, 0.0075, 0.015, 0.02, 0.03, 0.01 / 3])
def test_resampling_keeps_a_band_limited_signal(new_step):
    old_step, length = 0.01, 20.0
    highest = 0.9 * 0.5 / max(old_step, new_step)
    old = wave_packet(np.arange(0, length + 1e-9, old_step), highest)
    new = resample(old, old_step, new_step)
    exact = wave_packet(np.arange(new.size) * new_step, highest)
    assert new.size == int(length / new_step + 1e-6) + 1
    assert np.max(np.abs(new - exact)) < 1e-6 * np.max(np.abs(exact))


def test_whole_refinement_keeps_the_samples_of_a_real_record():
    motion = read_motion("ridgecrest_2019_tow2")
    fine = motion.resampled(0.002)
    np.testing.assert_allclose(fine.horizontal[::5], motion.horizontal, atol=1e-6 * motion.pga)
    assert fine.vertical.size == fine.horizontal.size and "resampled from 0.01 to 0.002 s" in fine.notes[-1]


def test_content_above_the_new_nyquist_frequency_is_removed():
    times = np.arange(0, 20, 0.01)
    beyond = np.sin(2 * np.pi * 30.0 * times) * np.exp(-((times - 10.0) ** 2) / 2)
    assert np.max(np.abs(resample(beyond, 0.01, 0.02))) < 1e-6


@pytest.mark.parametrize(
    ("act", "facts"),
    [
        (lambda m: m.cut(5.0, 3.0), ("5 .. 3 s", "within 0 ..")),
        (lambda m: m.cut(0.0, 99.0), ("99 s", "59.99 s")),
        (lambda m: m.cut(1.001, 1.002), ("sample(s)", "longer interval")),
        (lambda m: m.scaled(float("nan")), ("scale factor", "nan")),
        (lambda m: m.scaled_to_pga(-1.0), ("PGA is -1.0 m s-2", "positive")),
        (lambda m: m.scaled(0.0).scaled_to_pga(1.0), ("zero throughout",)),
        (lambda m: m.time_scaled(0.0), ("time_scale is 0.0", "positive")),
        (lambda m: m.resampled(-0.01), ("time_step is -0.01 s", "positive")),
        (lambda m: m.resampled(0.01 / np.pi), ("no fraction of whole numbers", "give for instance")),
        (lambda m: m.resampled(61.0), ("59.99 s", "smaller step")),
        (lambda m: Motion("x", 0.0, m.horizontal), ("time_step is 0.0", "positive", "in s")),
        (lambda m: Motion("x", 0.1, m.horizontal, m.horizontal[1:]), ("5999", "6000", "one length")),
        (lambda m: Motion("x", 0.1, np.array([1.0, np.inf])), ("not finite",)),
    ],
)
def test_what_cannot_be_done_is_one_sentence(act, facts):
    with pytest.raises(InputError) as caught:
        act(read_motion("ridgecrest_2019_clc"))
    assert all(fact in str(caught.value) for fact in facts), str(caught.value)
