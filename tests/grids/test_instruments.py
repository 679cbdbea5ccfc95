"""Sensors: nothing at their null, and what they say elsewhere."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, freqs, freqz, sosfilt

from grids.instruments import INSTRUMENTS, moved, recorded
from grids.instruments.base import Surroundings
from grids.instruments.filter import REACH, Kind, discrete
from grids.instruments.staged import recorded_in_stages
from grids.instruments.windowed import read_at, recorded_in_windows, same_base, samples_ahead
from models.shaking import Shaking

STEP = 0.002
TIME = np.arange(2001) * STEP
TRUE = {"rotation_1": 0.02 * np.sin(2 * np.pi * 1.3 * TIME), "rotation_rate_1": np.cos(2 * np.pi * 1.3 * TIME)}
BASE = np.cos(2 * np.pi * 2.1 * TIME)
AROUND = Surroundings(STEP, BASE)


@pytest.mark.parametrize("name", INSTRUMENTS)
def test_null_changes_nothing(name: str) -> None:
    switched = {name: INSTRUMENTS[name].nulls}
    found = recorded(TRUE, switched, AROUND)
    for channel, values in TRUE.items():
        np.testing.assert_allclose(found[channel], values, rtol=0, atol=1e-16)
    shaking = Shaking(STEP, BASE)
    np.testing.assert_array_equal(moved(shaking, switched).horizontal, BASE)


@pytest.mark.parametrize("name", INSTRUMENTS)
def test_declares_what_a_fit_needs(name: str) -> None:
    sensor = INSTRUMENTS[name]
    assert sensor.name == name
    known = {"base", "clock", "response", "lag", "ahead", "reach", "windowed", "whole"}
    assert sensor.acts and set(sensor.acts) <= known
    first = sensor.parameters[0]
    assert first.low < first.high and (np.isinf(first.null) or first.low <= first.null <= first.high)
    assert sensor.sentence.format_map(sensor.nulls)


def test_gain_leaves_rates_alone() -> None:
    found = recorded(TRUE, {"gain": {"gain": 0.1}}, AROUND)
    np.testing.assert_allclose(found["rotation_1"], 1.1 * TRUE["rotation_1"])
    np.testing.assert_array_equal(found["rotation_rate_1"], TRUE["rotation_rate_1"])


def test_levels_are_over_the_given_peak() -> None:
    found = recorded(TRUE, {"saturation": {"level_over_peak": 0.5}}, replace(AROUND, reference_peak=0.01))
    assert np.max(np.abs(found["rotation_1"])) == pytest.approx(0.005)
    found = recorded(TRUE, {"offset": {"offset_over_peak": 0.1}}, AROUND)
    shift = 0.1 * np.max(np.abs(TRUE["rotation_1"]))
    np.testing.assert_allclose(found["rotation_1"] - TRUE["rotation_1"], shift)


def test_cross_axis_adds_the_base() -> None:
    found = recorded(TRUE, {"cross_axis": {"rotation_per_acceleration": 0.004}}, AROUND)
    np.testing.assert_allclose(found["rotation_1"] - TRUE["rotation_1"], 0.004 * BASE, atol=1e-15)


def test_base_sensors_tell_what_the_base_did() -> None:
    shaking = Shaking(STEP, BASE)
    np.testing.assert_allclose(moved(shaking, {"base_gain": {"gain": 0.1}}).horizontal, 1.1 * BASE)
    np.testing.assert_allclose(moved(shaking, {"accelerometer_offset": {"offset": 0.2}}).horizontal, BASE - 0.2)


def filtered(signal: np.ndarray, step: float, order: int, corner_hz: float, kind: str) -> np.ndarray:
    return sosfilt(butter(order, corner_hz, kind, fs=1.0 / step, output="sos"), signal)


FINE = 16
"""Steps of the true motion in a step of the recording."""
FINE_TIME = np.arange(FINE * 4000 + 1) * STEP / FINE
TRUE_BASE = np.sin(2 * np.pi * 2.1 * FINE_TIME) * np.sin(np.pi * FINE_TIME / FINE_TIME[-1]) ** 2


def base_read(measured: np.ndarray, **values: float) -> np.ndarray:
    nulls = INSTRUMENTS["base_filter"].nulls
    return moved(Shaking(STEP, measured), {"base_filter": {**nulls, **values}}).horizontal


def test_an_ac_coupled_base_is_read_back_exactly() -> None:
    measured = filtered(TRUE_BASE, STEP / FINE, 1, 0.2, "highpass")[::FINE]
    assert np.max(np.abs(measured - TRUE_BASE[::FINE])) > 0.08
    np.testing.assert_allclose(base_read(measured, high_pass_hz=0.2), TRUE_BASE[::FINE], atol=2e-4)


def test_a_low_passed_base_is_read_back_and_its_noise_stays_bounded() -> None:
    measured = filtered(TRUE_BASE, STEP / FINE, 2, 8.0, "lowpass")[::FINE]
    assert np.max(np.abs(measured - TRUE_BASE[::FINE])) > 0.3
    np.testing.assert_allclose(base_read(measured, low_pass_hz=8.0), TRUE_BASE[::FINE], atol=3e-3)
    noise = np.random.default_rng(0).normal(size=8000)
    assert np.std(base_read(noise, low_pass_hz=5.0)) < 10.5


@pytest.mark.parametrize("values", [{"high_pass_hz": 1e-5}, {"low_pass_hz": 1e5}])
def test_a_filter_of_the_base_goes_to_nothing_smoothly(values: dict[str, float]) -> None:
    base = TRUE_BASE[::FINE]
    change, twice = (
        base_read(base, **{k: v * s if k == "high_pass_hz" else v / s for k, v in values.items()}) - base
        for s in (1.0, 2.0)
    )
    assert 0.0 < np.max(np.abs(change)) < 1e-3
    np.testing.assert_allclose(twice, 2.0 * change, atol=1e-3 * np.max(np.abs(change)))


def test_drift_counts_from_the_start_of_the_recording() -> None:
    drift = {"drift": {"rate": 1e-3}}
    found = recorded(TRUE, drift, AROUND)
    np.testing.assert_allclose(found["rotation_1"] - TRUE["rotation_1"], 1e-3 * TIME, atol=1e-15)
    np.testing.assert_array_equal(found["rotation_rate_1"], TRUE["rotation_rate_1"])
    first = np.array([[100], [700]])
    index = first + np.arange(50)
    windows = replace(AROUND, base_acceleration=BASE[index], start=first * STEP)
    seen = recorded_in_windows({"rotation_1": TRUE["rotation_1"][index]}, drift, windows)["rotation_1"]
    np.testing.assert_allclose(seen, found["rotation_1"][index], atol=1e-15)


def test_delay_and_clock_shift_time() -> None:
    found = recorded(TRUE, {"delay": {"delay": 0.01}, "clock": {"rate": 0.02}}, AROUND)
    inside = (1.02 * TIME - 0.01 > 0) & (TIME[-1] > 1.02 * TIME - 0.01)
    wanted = 0.02 * np.sin(2 * np.pi * 1.3 * (1.02 * TIME - 0.01))
    np.testing.assert_allclose(found["rotation_1"][inside], wanted[inside], atol=2e-6)


def test_what_a_sensor_reads_of_the_base_comes_as_late_as_the_rest() -> None:
    """The leak is the sensor's own, the delay and the clock are those of what writes its signal."""
    late = {"delay": {"delay": 0.012}, "clock": {"rate": 0.01}}
    leak = {"cross_axis": {"rotation_per_acceleration": 0.004}}
    found = recorded(TRUE, {**late, **leak}, AROUND)["rotation_1"] - recorded(TRUE, late, AROUND)["rotation_1"]
    at = 1.01 * TIME - 0.012
    inside = (at > 0) & (at < TIME[-1])
    np.testing.assert_allclose(found[inside], 0.004 * np.interp(at, TIME, BASE)[inside], atol=1e-12)


def test_a_late_response_is_an_early_base() -> None:
    read = read_at(Shaking(STEP, np.sin(2 * np.pi * 1.7 * TIME)), 0.02, 0.0137)
    at = 1.02 * TIME - 0.0137
    inside = (at >= 0) & (at <= TIME[-1])
    np.testing.assert_allclose(read.horizontal[inside], np.sin(2 * np.pi * 1.7 * at)[inside], atol=1e-6)
    assert not read.horizontal[~inside].any()
    assert read.time_step == pytest.approx(1.02 * STEP)


@pytest.mark.parametrize("order", [1, 2, 3, 4])
@pytest.mark.parametrize("corner", [3.0, 12.0])
def test_filter_is_butterworth(order: int, corner: float) -> None:
    switched = {"filter": {"corner_hz": corner, "order": float(order)}}
    constant = recorded({"rotation_1": np.full(500, 0.3)}, switched, replace(AROUND, base_acceleration=BASE[:500]))[
        "rotation_1"
    ]
    np.testing.assert_allclose(constant, 0.3, rtol=1e-9)
    wave = np.sin(2 * np.pi * corner * np.arange(6000) * STEP)
    out = recorded({"rotation_1": wave}, switched, Surroundings(STEP, np.zeros(6000)))["rotation_1"][3000:]
    assert np.sqrt(2 * np.mean(out**2)) == pytest.approx(np.sqrt(0.5), rel=5e-3)


@pytest.mark.parametrize("order", [1, 2, 4])
@pytest.mark.parametrize("frequency", [0.7, 5.0, 9.0])
def test_a_filter_of_zero_phase_has_the_squared_gain_and_no_lag(order: int, frequency: float) -> None:
    corner, time = 8.0, STEP * np.arange(4000)
    switched = {"filter": {"corner_hz": corner, "order": float(order), "zero_phase": 1.0}}
    wave = np.sin(2 * np.pi * frequency * time)
    out = recorded({"rotation_1": wave}, switched, Surroundings(STEP, np.zeros(time.size)))["rotation_1"]
    inner = slice(1000, 3000)
    np.testing.assert_allclose(out[inner], wave[inner] / (1.0 + (frequency / corner) ** (2 * order)), atol=1e-4)


@pytest.mark.parametrize("order", [1, 2, 4])
@pytest.mark.parametrize("corner", [8.0, 25.0])
def test_a_filter_of_zero_phase_in_windows_is_that_of_the_record(order: int, corner: float) -> None:
    """From a peak on; a window runs on for what the filter needs of later samples, a knock after its end among them."""
    values = {**INSTRUMENTS["filter"].nulls, "corner_hz": corner, "order": float(order), "zero_phase": 1.0}
    motion = 0.1 * np.cos(2 * np.pi * 0.9 * STEP * (np.arange(4000) - 1000))
    motion[1300:] += 0.2 * STEP * np.arange(2700)  # its rate jumps, as at an impact
    record = recorded({"rotation_1": motion}, {"filter": values}, Surroundings(STEP, np.zeros(4000)))["rotation_1"]
    samples = 295 + samples_ahead({"filter": values}, STEP)
    window = {"rotation_1": motion[1000 : 1000 + samples]}
    seen = recorded_in_windows(window, {"filter": values}, Surroundings(STEP, np.zeros(samples)))["rotation_1"]
    np.testing.assert_allclose(seen[:295], record[1000:1295], atol=2e-4)
    assert same_base({"filter": values}) == same_base({"filter": {**values, "corner_hz": 30.0}})


@pytest.mark.parametrize("order", [1, 2, 3, 4])
@pytest.mark.parametrize("kind", ["lowpass", "highpass"])
@pytest.mark.parametrize("share", [0.0, 0.25, 0.75])
def test_a_filter_is_that_of_the_signal_between_the_samples(order: int, kind: Kind, share: float) -> None:
    """At every frequency that a recording shows well, as the analogue filter has it; lines between samples take 7 %."""
    step = 0.01
    system = discrete(0.35 / step, order, kind, step, share)
    poles = butter(order, 2.0 * np.pi * 0.35 / step, btype=kind, analog=True)
    for of_rate, most in ((0.01, 1e-7), (0.05, 1e-5), (0.1, 3e-4), (0.15, 3e-3)):
        frequency = of_rate / step
        late = np.exp(2j * np.pi * of_rate * (REACH - share))
        found = freqz(system.numerator, system.denominator, [2.0 * np.pi * of_rate])[1][0] * late
        wanted = freqs(*poles, [2.0 * np.pi * frequency])[1][0]
        assert abs(found - wanted) < most


def test_a_filter_takes_the_motion_on_beyond_the_ends_of_a_window() -> None:
    """A parabola passes whole: later by the filter's delay of slow signals, read earlier by as much."""
    sensor, samples = INSTRUMENTS["filter"], 60
    values = {**sensor.nulls, "corner_hz": 30.0, "order": 2.0}
    time = 0.01 * np.arange(samples)
    motion = 0.3 + 0.2 * time - 0.7 * time**2
    seen = sensor.acts["windowed"]({"rotation_1": motion}, values, Surroundings(0.01, np.zeros(samples)))["rotation_1"]
    bend = seen - motion  # of a parabola a low-pass leaves all but a constant
    np.testing.assert_allclose(bend, bend[0], atol=1e-9)


@pytest.mark.parametrize("order", [1, 2, 4])
def test_a_filter_in_windows_is_the_filter_of_the_record(order: int) -> None:
    """A smooth motion seen through a filter from a window's peak on, base and response clock apart."""
    sensor = INSTRUMENTS["filter"]
    values = {**sensor.nulls, "corner_hz": 8.0, "order": float(order)}
    lag = sensor.acts["lag"](values)
    frequency = 1.1
    peak = 0.25 / frequency + 5.0 / frequency
    wave = lambda t: np.sin(2 * np.pi * frequency * t)  # noqa: E731
    long = Surroundings(STEP, np.zeros(8000))
    whole = sensor.acts["response"]({"rotation_1": wave(np.arange(8000) * STEP)}, values, long)["rotation_1"]
    recorded_peak = round((peak + lag) / STEP)
    since = np.arange(400) * STEP
    window = {"rotation_1": wave(recorded_peak * STEP - lag + since)}
    around = Surroundings(STEP, np.zeros(400))
    seen = sensor.acts["windowed"](window, values, around)["rotation_1"]
    np.testing.assert_allclose(seen[:300], whole[recorded_peak : recorded_peak + 300], atol=0.01)


@pytest.mark.parametrize("corner", [20.0, 32.0, 50.0])
def test_a_filter_in_windows_of_few_samples_a_cycle_is_the_filter_of_the_record(corner: float) -> None:
    """What came before a window is told by its first samples: by too many of them not at all."""
    sensor, step, frequency = INSTRUMENTS["filter"], 0.01, 8.0
    values = {**sensor.nulls, "corner_hz": corner, "order": 2.0}
    lag = sensor.acts["lag"](values)
    poles = butter(2, 2.0 * np.pi * corner, analog=True)
    response = freqs(*poles, [2.0 * np.pi * frequency])[1][0]
    time = step * np.arange(50)
    for phase in np.linspace(0.0, 2.0 * np.pi, 7):
        window = {"rotation_1": np.sin(2.0 * np.pi * frequency * (time - lag) + phase)}  # as the clock of a fit has it
        seen = sensor.acts["windowed"](window, values, Surroundings(step, np.zeros(50)))["rotation_1"]
        wanted = np.imag(response * np.exp(1j * (2.0 * np.pi * frequency * time + phase)))
        np.testing.assert_allclose(seen[:47], wanted[:47], atol=0.06)
        np.testing.assert_allclose(seen[4:47], wanted[4:47], atol=0.01)


@pytest.mark.parametrize("zero_phase", [0.0, 1.0])
def test_a_filter_in_windows_passes_on_what_is_not_finite(zero_phase: float) -> None:
    """The motion of a wall that falls, or cannot stand, is nan; its window is told as such and others are filtered."""
    sensor, around = INSTRUMENTS["filter"], Surroundings(STEP, np.zeros((2, 400)))
    values = {**sensor.nulls, "corner_hz": 8.0, "order": 2.0, "zero_phase": zero_phase}
    both = np.tile(np.sin(7.0 * STEP * np.arange(400)), (2, 1))
    whole = sensor.acts["windowed"]({"rotation_1": both}, values, around)["rotation_1"]
    both[0, 250:] = np.nan
    seen = sensor.acts["windowed"]({"rotation_1": both}, values, around)["rotation_1"]
    np.testing.assert_array_equal(seen[1], whole[1])
    assert np.isnan(seen[0, 250:]).all() and np.isfinite(seen[0, :200]).all()


def test_a_drift_that_begins_within_a_recording_grows_from_there() -> None:
    """Not by a jump to what it would have come to since the start: that is a sensor that is knocked."""
    plain, drifting = {"offset": {"offset_over_peak": 0.1}}, {"drift": {"rate": 0.01}}
    around = replace(AROUND, reference_peak=0.1)
    sets = [(0, plain), (40, {**plain, **drifting}), (70, drifting)]
    found = recorded_in_stages({"rotation_1": np.zeros(TIME.size)}, sets, around)["rotation_1"]
    np.testing.assert_allclose(found[:40], 0.01)
    np.testing.assert_allclose(found[40:70], 0.01 + 0.01 * STEP * np.arange(30), rtol=1e-12)
    np.testing.assert_allclose(found[70:], 0.01 * STEP * np.arange(30, TIME.size - 40), rtol=1e-12)  # it goes on
    always = recorded_in_stages({"rotation_1": np.zeros(TIME.size)}, [(0, drifting)], around)["rotation_1"]
    np.testing.assert_allclose(always, 0.01 * around.time, rtol=1e-12)
