"""Linear bearings: closed forms of one body and of uniform chains, and limits between models."""

import numpy as np
import pytest

from models.isolated.lanes import run as lanes
from models.isolated.observe import observe
from models.isolated.reference import run as reference
from models.shaking import Shaking
from tests.models.isolated.buildings import BODY, HOUSE, MODEL, chain, two_tones
from tests.models.requests import asked
from tests.models.strategies import random_motion


def damped_oscillator(omega: float, ratio: float, shaking: Shaking) -> np.ndarray:
    """x, x' (n, 2) of x'' + 2 xi omega x' + omega^2 x = -a by the closed form on every straight piece of a."""
    h, a = shaking.time_step, shaking.horizontal
    fast = omega * np.sqrt(1 - ratio**2)
    decay, cosine, sine = np.exp(-ratio * omega * h), np.cos(fast * h), np.sin(fast * h)
    found = np.zeros((a.size, 2))
    for k in range(a.size - 1):
        slope = (a[k + 1] - a[k]) / h
        start, drift = -a[k] / omega**2 + 2 * ratio * slope / omega**3, -slope / omega**2
        x, v = found[k] - (start, drift)
        other = (v + ratio * omega * x) / fast
        free = decay * (x * cosine + other * sine)
        rate = decay * ((other * fast - ratio * omega * x) * cosine - (x * fast + ratio * omega * other) * sine)
        found[k + 1] = start + drift * h + free, drift + rate
    return found


@pytest.mark.parametrize("ratio", [0.0, 0.05, 0.6])
def test_one_level_is_the_damped_oscillator(ratio: float) -> None:
    shaking = random_motion(np.random.default_rng(3), duration=8.0, vertical=False)
    omega = np.sqrt(BODY["bearing_stiffness"] / BODY["total_mass"])
    damping = 2 * ratio * omega * BODY["total_mass"]
    expected = damped_oscillator(float(omega), ratio, shaking)
    outcome = MODEL.simulate({**BODY, "bearing_damping": damping}, shaking)
    for name, column in (("bearing_displacement", 0), ("bearing_velocity", 1)):
        size = np.max(np.abs(expected[:, column]))
        np.testing.assert_allclose(outcome.channels[name], expected[:, column], rtol=0, atol=1e-12 * size)
    force = BODY["bearing_stiffness"] * expected[:, 0] + damping * expected[:, 1]
    np.testing.assert_allclose(
        outcome.channels["level_acceleration_x"][0], -force / BODY["total_mass"], rtol=0, atol=1e-11 * omega**2
    )


def test_frequencies_of_a_uniform_chain() -> None:
    # bearings as stiff as a storey: omega_k = 2 sqrt(k/m) sin((2k-1) pi/(2(2n+1))); c/k alike: xi_k = (c/k) omega_k/2
    for n in (1, 2, 6, 12):
        values = {"levels": n, "total_mass": 2.0 * n, "bearing_stiffness": 50.0, "storey_stiffness": 50.0}
        found = MODEL.derive({**values, "bearing_damping": 1.5, "storey_damping": 1.5})
        for k in range(1, 5):
            omega = 2 * np.sqrt(25.0) * np.sin((2 * k - 1) * np.pi / (2 * (2 * n + 1))) if k <= n else np.nan
            assert found[f"frequency_{k}"][0] == pytest.approx(omega / (2 * np.pi), rel=1e-12, nan_ok=True)
            assert found[f"modal_damping_{k}"][0] == pytest.approx(0.03 * omega / 2, rel=1e-12, nan_ok=True)


@pytest.mark.parametrize("levels", [2, 6])
def test_a_mode_swings_at_its_frequency(levels: int) -> None:
    values = {**HOUSE, "levels": float(levels), "bearing_damping": 0.0, "storey_damping": 0.0, "storey_stiffness": 3e9}
    period = 1.0 / float(MODEL.derive(values)["frequency_1"][0])
    # all levels start alike, which is nearly the first mode
    outcome = MODEL.simulate(
        values, Shaking.silence(10 * period, period / 400), initial={"bearing_displacement": 0.1}
    ).channels["bearing_displacement"]
    np.testing.assert_allclose(outcome[::400], 0.1, rtol=0, atol=2e-3)
    np.testing.assert_allclose(outcome[200::400], -0.1, rtol=0, atol=2e-3)


def test_stiff_storeys_make_a_rigid_body_and_set_no_bound_on_the_step() -> None:
    shaking = two_tones()
    body = MODEL.simulate(BODY, shaking).channels["bearing_displacement"]
    stiff = chain({**HOUSE, "storey_stiffness": 3e12, "storey_damping": 0.0})
    ran = lanes.run(stiff, asked(shaking, samples=301))
    assert ran.steps <= 8 * 301
    np.testing.assert_allclose(ran.samples[0, :, 0], body, rtol=0, atol=1e-5 * np.max(np.abs(body)))
    assert ran.outputs["peak_drift"][0] < 1e-6


def test_unequal_masses() -> None:
    alike = {f"level_mass_{j}": 5e4 for j in range(1, 7)}
    given = {k: v for k, v in HOUSE.items() if k != "total_mass"}
    shaking = two_tones()
    expected = MODEL.simulate(HOUSE, shaking).channels["level_displacement_x"]
    np.testing.assert_array_equal(
        MODEL.simulate({**given, **alike}, shaking).channels["level_displacement_x"], expected
    )
    heavy = {**given, **alike, "level_mass_6": 1e5}
    found = MODEL.simulate(heavy, shaking)
    slow = reference.run(chain(heavy), asked(shaking, duration=3.0))
    channels = {k: v[0] for k, v in observe(chain(heavy), slow.samples).items()}
    for name in ("level_displacement_x", "level_acceleration_x"):
        size = np.max(np.abs(channels[name]))
        np.testing.assert_allclose(found.channels[name], channels[name], rtol=0, atol=1e-9 * size)
    assert found.outputs["dissipated_energy"] == pytest.approx(slow.outputs["dissipated_energy"], rel=1e-6)


def test_without_dashpots_no_energy_is_lost() -> None:
    values = {**HOUSE, "bearing_damping": 0.0, "storey_damping": 0.0}
    outcome = MODEL.simulate(values, two_tones(), tail=2.0)
    free = MODEL.simulate(values, Shaking.silence(20.0, 0.01), initial={"bearing_displacement": 0.1})
    released = 0.5 * HOUSE["bearing_stiffness"] * 0.1**2
    assert abs(free.outputs["dissipated_energy"]) < 1e-10 * released
    # the work of the shaking is read from the ends of the steps, to their fourth order
    assert abs(outcome.outputs["dissipated_energy"]) < 1e-5 * released
