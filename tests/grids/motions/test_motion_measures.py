"""Spectra, intensity and pulses against closed forms."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from grids.motions import make_pulse, read_motion
from grids.motions.intensity import intensity_measures, velocity_and_displacement
from grids.motions.pulses import SHAPES
from grids.motions.spectrum import default_periods, response_spectrum
from models.errors import InputError

G = 9.80665


def pulse(shape, **more):
    return make_pulse({"shape": shape, "amplitude": 2.0, **more})


@pytest.mark.parametrize("damping", [0.02, 0.05, 0.2])
def test_spectrum_at_resonance_is_the_steady_state(damping):
    motion = pulse("sine", frequency=2.0, cycles=150.0)
    spectrum = response_spectrum(motion.horizontal, motion.time_step, [0.5], damping)
    assert spectrum.pseudo_acceleration[0] == pytest.approx(2.0 / (2 * damping), rel=1e-4)


@pytest.mark.parametrize("ratio", [0.05, 0.2, 0.4, 0.5, 1.0, 3.0])
def test_spectrum_of_a_rectangular_pulse(ratio):
    """2 sin(pi t1/T) of the static response for t1 < T/2, 2 beyond: the peak may come after the pulse."""
    motion = pulse("rectangular", duration=ratio)
    exact = 2 * np.sin(np.pi * ratio) if ratio < 0.5 else 2.0
    spectrum = response_spectrum(motion.horizontal, motion.time_step, [1.0], 0.0)
    assert spectrum.pseudo_acceleration[0] == pytest.approx(2.0 * exact, rel=1e-3)


@pytest.mark.parametrize("ratio", [0.05, 0.2, 0.4])
def test_spectrum_of_a_short_half_sine_is_its_residual_response(ratio):
    motion = pulse("half_sine", duration=ratio)
    r = 1 / (2 * ratio)
    exact = 2 * r / (r**2 - 1) * np.cos(np.pi / (2 * r))
    spectrum = response_spectrum(motion.horizontal, motion.time_step, [1.0], 0.0)
    assert spectrum.pseudo_acceleration[0] == pytest.approx(2.0 * exact, rel=1e-4)


def test_spectrum_of_a_record_against_the_equation_of_motion():
    motion = read_motion("ridgecrest_2019_clc", component="north").cut(10.0, 20.0)
    for period, damping in ((0.31, 0.05), (1.7, 0.1)):
        omega = 2 * np.pi / period
        solution = solve_ivp(
            lambda t, x, w=omega, z=damping: (
                x[1],
                -np.interp(t, motion.time, motion.horizontal) - 2 * z * w * x[1] - w * w * x[0],
            ),
            (0.0, motion.duration),
            (0.0, 0.0),
            t_eval=np.linspace(0.0, motion.duration, 20001),
            max_step=0.005,
            rtol=1e-8,
            atol=1e-12,
        )
        spectrum = response_spectrum(motion.horizontal, motion.time_step, [period], damping)
        assert spectrum.displacement[0] == pytest.approx(np.max(np.abs(solution.y[0])), rel=1.5e-3)


def test_limits_of_the_spectrum():
    motion = read_motion("ridgecrest_2019_clc", component="north")
    ends = response_spectrum(motion.horizontal, motion.time_step, [1e-3, 3000.0])
    assert ends.pseudo_acceleration[0] == pytest.approx(motion.pga, rel=0.02)
    _, displacement = velocity_and_displacement(motion.horizontal, motion.time_step, None)
    assert ends.displacement[1] == pytest.approx(np.max(np.abs(displacement)), rel=0.1)
    assert np.all(np.diff(default_periods()) > 0)


@pytest.mark.parametrize(
    ("periods", "damping"), [([0.0], 0.05), ([], 0.05), ([np.nan], 0.05), ([1.0], 1.0), ([1.0], -0.1)]
)
def test_spectrum_refuses_what_has_no_meaning(periods, damping):
    with pytest.raises(InputError, match="response spectrum"):
        response_spectrum(np.ones(20), 0.01, periods, damping)


def test_measures_of_a_rectangular_pulse_are_exact():
    measures = intensity_measures(pulse("rectangular", duration=0.8))
    assert measures.pgv == pytest.approx(2.0 * 0.8, rel=1e-12)
    assert measures.pgd == pytest.approx(0.5 * 2.0 * 0.8**2, rel=1e-12)
    assert measures.arias == pytest.approx(np.pi / (2 * G) * 2.0**2 * 0.8, rel=1e-12)
    assert measures.significant_duration == pytest.approx(0.9 * 0.8, rel=1e-9)
    assert "no filter" in measures.rule


def test_measures_of_a_sine_pulse():
    measures = intensity_measures(pulse("sine", frequency="2 Hz", cycles=3))
    omega = 4 * np.pi
    assert measures.arias == pytest.approx(np.pi / (2 * G) * 2.0**2 * 1.5 / 2, rel=1e-4)
    assert measures.pgv == pytest.approx(2 * 2.0 / omega, rel=1e-4)
    assert measures.pgd == pytest.approx(2.0 / omega * 1.5, rel=1e-4)


def test_high_pass_takes_the_drift_and_keeps_what_lies_above_it():
    time = np.arange(0, 40, 0.01)
    clean = np.sin(2 * np.pi * time) * np.exp(-((time - 20.0) ** 2) / 2 / 4.0**2)
    wanted, _ = velocity_and_displacement(clean, 0.01, None)
    velocity, displacement = velocity_and_displacement(clean + 0.02, 0.01)
    np.testing.assert_allclose(velocity, wanted, atol=0.01 * np.max(np.abs(wanted)))
    assert abs(displacement[-1]) < 0.02 * np.max(np.abs(displacement))
    rule = intensity_measures(read_motion("ridgecrest_2019_clc")).rule
    assert all(word in rule for word in ("0.1 Hz", "order 4", "mean removed", "60 s"))


@pytest.mark.parametrize("corner", [0.0, -1.0, 50.0])
def test_high_pass_outside_the_band_is_refused(corner):
    with pytest.raises(InputError, match="high_pass"):
        velocity_and_displacement(np.ones(1000), 0.01, corner)


def test_silence_has_no_duration():
    with pytest.raises(InputError, match="zero throughout"):
        intensity_measures(read_motion("ridgecrest_2019_clc").scaled(0.0))


@pytest.mark.parametrize(
    ("shape", "impulse", "peak"),
    [
        ("rectangular", 2.0 * 0.25, 2.0),
        ("half_sine", 2.0 / (2 * np.pi), 2.0),
        ("sine", 0.0, 2.0),
        ("cosine", 0.0, 2.0),
        ("ricker", 0.0, 2.0),
    ],
)
@pytest.mark.parametrize("silence", [{}, {"lead": "0.3 s", "rest": "1 s"}])
def test_pulses_keep_impulse_and_peak(shape, impulse, peak, silence):
    motion = pulse(shape, frequency="2 Hz", **silence)
    velocity, _ = velocity_and_displacement(motion.horizontal, motion.time_step, None)
    assert velocity[-1] == pytest.approx(impulse, abs=2e-5)
    assert motion.pga == pytest.approx(peak, rel=1e-4)
    lead = 0.3 if silence else 0.0
    length = {"rectangular": 0.25, "half_sine": 0.25, "sine": 0.5, "cosine": 0.5, "ricker": 1.5}[shape]
    assert motion.duration == pytest.approx(lead + length + (1.0 if silence else 0.0), abs=2 * motion.time_step)


def test_every_shape_is_tested_above():
    assert set(SHAPES) == {"rectangular", "half_sine", "sine", "cosine", "ricker"}


def test_frequency_and_duration_are_two_words_for_one_pulse():
    for shape, duration in (("rectangular", 0.25), ("half_sine", 0.25), ("sine", 0.5), ("ricker", 1.5)):
        assert pulse(shape, frequency=2.0).fingerprint == pulse(shape, duration=duration).fingerprint


def test_pulse_in_units_and_with_its_own_step():
    motion = read_motion(
        {
            "pulse": {
                "shape": "sine",
                "amplitude": "0.3 g",
                "frequency": "2 Hz",
                "time_step": "5 ms",
                "name": "s",
            }
        }
    )
    assert motion.name == "s" and motion.time_step == pytest.approx(0.005) and motion.horizontal.size == 101
    assert motion.pga == pytest.approx(0.3 * G)
    np.testing.assert_allclose(motion.horizontal, 0.3 * G * np.sin(4 * np.pi * motion.time), atol=1e-12)


@pytest.mark.parametrize(
    ("table", "facts"),
    [
        ({"shape": "sin", "amplitude": 1.0, "frequency": 1.0}, ("'sin'", "did you mean 'sine'?")),
        ({"shape": "sine", "amplitude": 1.0, "frequency": 1.0, "cycels": 2.0}, ("cycels", "cycles")),
        ({"shape": "sine", "frequency": 1.0}, ("amplitude", "missing")),
        ({"shape": "sine", "amplitude": 0.0, "frequency": 1.0}, ("amplitude", "zero")),
        ({"shape": "sine", "amplitude": "0.3 kg", "frequency": 1.0}, ("amplitude", "kg", "'g'")),
        ({"shape": "sine", "amplitude": 1.0}, ("exactly one", "frequency", "duration", "neither")),
        ({"shape": "sine", "amplitude": 1.0, "frequency": 1.0, "duration": 1.0}, ("exactly one", "both")),
        ({"shape": "sine", "amplitude": 1.0, "frequency": "-2 Hz"}, ("frequency", "-2 Hz", "positive")),
        (
            {"shape": "ricker", "amplitude": 1.0, "frequency": 1.0, "cycles": 2.0},
            ("cycles = 2", "ricker", "leave"),
        ),
        (
            {"shape": "sine", "amplitude": 1.0, "duration": 1.0, "time_step": 0.3},
            ("0.3 s", "divide", "0.25 s"),
        ),
        ({"shape": "sine", "amplitude": 1.0, "duration": 1.0, "lead": -1.0}, ("lead is -1 s", "positive")),
        *(
            ({"shape": "sine", "amplitude": 1.0, "frequency": 1.0, **long}, ("steps", "more than 2e+07", "shorten"))
            for long in (
                {"rest": "1e12 s"},
                {"lead": "1e9 s"},
                {"cycles": 1e12},
                {"cycles": 1e6, "time_step": "1 ms"},
            )
        ),
    ],
)
def test_bad_pulses_are_one_sentence(table, facts):
    with pytest.raises(InputError) as caught:
        read_motion({"pulse": table})
    assert all(fact in str(caught.value) for fact in facts), str(caught.value)
