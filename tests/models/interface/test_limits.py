"""Numbers of the layers' model, and its limits: no upper block, equal rotations, stiff layers, a rigid impact."""

import numpy as np
import pytest

from models.interface import modes
from models.interface.lanes import run as lanes
from models.interface.strip import stored, strip
from models.shaking import Shaking
from tests.models.interface.walls import SHORT, block_on_strip, wall
from tests.models.requests import asked
from tests.models.strategies import random_motion

SHAKING = random_motion(np.random.default_rng(2), duration=3.0)


def test_elastic_partial_contact() -> None:
    """l = b - z/|S|: N = k |S| l^2/2, M = sign(S) N (b - l/3)."""
    rng = np.random.default_rng(1)
    for _ in range(500):
        b, k, s = rng.uniform(0.1, 1.5), np.exp(rng.uniform(14, 20)), rng.choice([-1, 1]) * rng.uniform(1e-3, 0.1)
        z = rng.uniform(-1.0, 1.0) * b * abs(s)
        length = b - z / abs(s)
        force = k * abs(s) * length**2 / 2
        found = strip(b, k, 0.0, z, s)
        # right at the edge of contact the length is a difference of equals
        assert found.force == pytest.approx(force, rel=1e-12, abs=1e-14 * k * b * b)
        assert found.moment == pytest.approx(np.sign(s) * force * (b - length / 3), rel=1e-12, abs=1e-14 * k * b**3)
        assert found.share == pytest.approx(length / (2 * b), abs=1e-12)
        assert stored(b, k, z, s) == pytest.approx(k * s * s * length**3 / 6, rel=1e-9, abs=1e-14 * k * b**3)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_no_uplift_if_and_only_if_the_freer_end_is_compressed(side: float) -> None:
    b, k, lean = 0.36, 6.21e7, 0.004
    for z, full in ((-b * lean * 1.001, True), (-b * lean * 0.999, False), (-b * lean * 2.0, True)):
        assert (strip(b, k, 0.0, z, side * lean).share == 1.0) is full
    assert strip(b, k, 0.0, b * lean * 1.001, side * lean)[:3] == (0.0, 0.0, 0.0)


def test_frozen_half_contact_would_jump_where_the_exact_strip_does_not() -> None:
    """At uplift: force -25 %, moment +25 %, energy -12.5 % on half the base; the exact strip is continuous."""
    b, k, lean = 0.36, 6.21e7, 0.004
    z = -b * lean
    full = strip(b, k, 0.0, z, lean)
    force, moment = -k * (z * b - lean * b**2 / 2), -k * (z * b**2 / 2 - lean * b**3 / 3)
    energy = k / 2 * (z * z * b - z * lean * b**2 + lean**2 * b**3 / 3)
    assert force / full.force == pytest.approx(0.75, rel=1e-12)
    assert moment / full.moment == pytest.approx(1.25, rel=1e-12)
    assert energy / stored(b, k, z, lean) == pytest.approx(0.875, rel=1e-12)
    after = strip(b, k, 0.0, z * (1 - 1e-9), lean)
    assert after.force == pytest.approx(full.force, rel=1e-8) and after.moment == pytest.approx(full.moment, rel=1e-8)


@pytest.mark.parametrize(("modulus", "ratio", "milliseconds"), [(4.5e6, 0.0544, 0.39), (2e7, 0.10, 0.11)])
def test_an_explicit_step_would_be_bound_by_the_axial_mode(modulus, ratio, milliseconds) -> None:
    """2.8/rate with the rate of about 2 (c_b b1 + c_t bt)/m1, against that mode in the full matrices."""
    one = wall({**SHORT, "layer_modulus": modulus, "damping_ratio": ratio})
    rate = 2 * (one.base_damping * one.base_half_width + one.top_damping * one.top_half_width) / one.mass_1
    assert 2.8e3 / rate[0] == pytest.approx(milliseconds, abs=0.01)
    lever = one.height_1 + one.top_thickness_in_height + modes.static_state(one)[:, 3]
    mass = modes.mass_matrix(one, lever)[0]
    damping = modes.layer_matrix(one, one.base_damping, one.top_damping)[0]
    fastest = np.max(np.linalg.eigvals(np.linalg.solve(mass, damping)).real)
    assert fastest == pytest.approx(rate[0], rel=0.1)


def test_without_an_upper_block_the_wall_is_one_block_on_a_strip() -> None:
    """m2 -> 0 on a stiff, light top joint: the wall rocks as the block alone."""
    block = {
        "wall_length": 0.5, "wall_height": 2.0, "wall_mass": 1000.0, "top_length": 0.5, "top_height": 0.02,
        "top_mass": 1e-4, "base_layer_thickness": 0.01, "base_stiffness": 1e7, "base_damping": 1e5, "gravity": 9.81,
    }  # fmt: skip
    light = {**block, "top_layer_thickness": 0.01, "top_stiffness": 1e4, "top_damping": 10.0}
    alone, with_top = wall(block, joints="base"), wall(light)
    scale, n = np.array([2.0]), 301
    expected, found = (lanes.run(one, asked(SHAKING, scale, samples=n), 4).samples[0] for one in (alone, with_top))
    assert np.max(np.abs(expected[:, 0])) > 0.01
    np.testing.assert_allclose(found[:, 0], expected[:, 0], atol=2e-3 * np.max(np.abs(expected[:, 0])))


def test_equal_rotations_do_not_know_where_the_body_is_cut() -> None:
    """One body, its slice bonded on top thick or thin: theta2 = theta1, and one motion."""

    def cut(low: float) -> dict[str, float]:
        high = 2.0 - low
        return {
            "wall_length": 0.5, "wall_height": low, "wall_mass": 500.0 * low, "top_mass": 500.0 * high,
            "top_length": 0.5, "top_height": high, "base_layer_thickness": 0.01, "base_stiffness": 1e7,
            "base_damping": 1e5, "gravity": 9.81,
        }  # fmt: skip

    low, high = wall(cut(1.9), joints="base"), wall(cut(0.7), joints="base")
    np.testing.assert_allclose(modes.at_rest(low).squares, modes.at_rest(high).squares, rtol=1e-11)
    one, other = (lanes.run(w, asked(SHAKING, 2.0, samples=301)).samples[0] for w in (low, high))
    np.testing.assert_allclose(one[:, 0], one[:, 1], rtol=1e-13, atol=1e-16)
    np.testing.assert_allclose(other[:, [0, 2]], one[:, [0, 2]], atol=1e-6 * np.max(np.abs(one[:, 0])))


KEPT = [("vertical", 0.10, 0.98, 0.99), ("vertical", 1.0, 0.94, 0.965), ("turning", 0.10, 0.95, 0.965)]
KEPT += [("turning", 1.0, 0.885, 0.96)]


@pytest.mark.parametrize(("mode", "ratio", "least", "most"), KEPT)
def test_a_kelvin_voigt_strip_is_no_impact_law(mode: str, ratio: float, least: float, most: float) -> None:
    """First-cycle e from the peaks, cos(alpha - theta_2) - cos(alpha) = e^2 (...): over Housner's .912, or near it.

    c = 2 xi k/omega with omega of the block's vertical mode in full contact (then xi is that mode's own ratio), or
    of the turning one, as the model converts a damping ratio.
    """
    alpha = np.arctan(0.25)
    swing = np.array([0.3, 0.6, 0.9]) * alpha
    for stiffness in (1e8, 1e9):
        turning, vertical = np.sqrt(modes.at_rest(wall(block_on_strip(stiffness), joints="base")).squares[0])
        damping = 2 * ratio * stiffness / (vertical if mode == "vertical" else turning)
        one = wall(block_on_strip(stiffness, damping), joints="base").take(np.zeros(3, int))
        balance = np.sin(swing) * (0.25 - np.sqrt(2 * 1000 * 9.81 / (stiffness * np.sin(swing))))
        start = {"rotation_1": swing, "rotation_2": swing, "displacement_z_1": balance}
        request = asked(Shaking.silence(4.0, 0.0025), np.ones(3), initial=start, samples=1600)
        turned = lanes.run(one, request, 4).samples[:, :, 0]
        for begun, theta in zip(swing, turned, strict=True):
            first, second = np.flatnonzero(theta[:-1] * theta[1:] < 0.0)[:2]
            reached = np.max(np.abs(theta[first:second]))
            kept = np.sqrt((np.cos(alpha - reached) - np.cos(alpha)) / (np.cos(alpha - begun) - np.cos(alpha)))
            assert least < kept < most, (stiffness, begun)
