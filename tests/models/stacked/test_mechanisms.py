"""Mechanisms on two stacked blocks: nulls, and what each does by a closed form."""

import numpy as np
import pytest

import models
from models.runs import Request
from models.shaking import Shaking
from models.stacked.model import MODEL
from tests.models.stacked.walls import LANES, A, B, G, random_wall
from tests.models.strategies import random_motion

ACTING = {
    "pivot_inset", "tilt", "eccentricity", "restitution", "viscous_damping", "vertical_acceleration", "table_pitch",
    "coulomb_damping",
}  # fmt: skip


def test_the_mechanisms_that_act() -> None:
    assert set(MODEL.mechanisms) >= ACTING


@pytest.mark.parametrize("name", sorted(ACTING))
def test_at_its_null_a_mechanism_is_not_there(name: str) -> None:
    shaking = random_motion(np.random.default_rng(1), duration=5.0)
    nulls = {f"{name}.{p.name}": p.null for p in MODEL.mechanisms[name].parameters}
    plain, switched = (MODEL.simulate(values, shaking, scale=2.5, tail=1.0) for values in (B, {**B, **nulls}))
    assert plain.outputs["impacts_top"] > 2
    np.testing.assert_array_equal(plain.channels["rotation_2"], switched.channels["rotation_2"])
    assert plain.events == switched.events


def test_inset_moves_the_onset_of_its_joint() -> None:
    """Thresholds fall in proportion to 1 - inset: at both joints, or at the one that is named."""
    plain = MODEL.derive(B)
    both = MODEL.derive({**B, "pivot_inset.inset_over_half_width": 0.2})
    top = MODEL.derive({**B, "pivot_inset.inset_over_half_width_top": 0.1})
    mixed = MODEL.derive({**B, "pivot_inset.inset_over_half_width": 0.2, "pivot_inset.inset_over_half_width_top": 0.1})
    for name, factors in (("onset_acceleration_base", (0.8, 1.0, 0.8)), ("onset_acceleration_top", (0.8, 0.9, 0.9))):
        for found, factor in zip((both, top, mixed), factors, strict=True):
            np.testing.assert_allclose(found[name], factor * plain[name], rtol=1e-14)


def test_all_of_the_vertical_motion_as_a_mechanism_is_the_vertical_motion() -> None:
    motion = random_motion(np.random.default_rng(3), duration=4.0)
    fed, left_out = (Shaking(motion.time_step, motion.horizontal, motion.vertical, acts) for acts in (True, False))
    acting = MODEL.simulate(B, fed, scale=2.5).channels["rotation_2"]
    mechanism = MODEL.simulate({**B, "vertical_acceleration.kappa": 1.0}, left_out, scale=2.5).channels["rotation_2"]
    np.testing.assert_array_equal(mechanism, acting)
    assert np.max(np.abs(MODEL.simulate(B, left_out, scale=2.5).channels["rotation_2"] - acting)) > 1e-4


@pytest.mark.parametrize("integrator", LANES)
def test_onset_of_a_leaning_eccentric_stack(integrator: str) -> None:
    """A slow ramp lifts the stack at tan(alpha -+ lean) of the side it tips to."""
    values = {**A, "tilt.tilt": 0.02, "eccentricity.offset_over_half_width": 0.1}
    ramp = Shaking(0.01, np.linspace(0.0, 0.4 * G, 4001))
    centre = (1000 * 1.5 + 500 * 3.6) / 1500
    shift = (1000 * 0.05 + 500 * 0.03) / 1500
    for sign in (1.0, -1.0):
        run = MODEL.simulate(values, Shaking(0.01, sign * ramp.horizontal), integrator=integrator)
        # a to the right tips to the left, away from the lean
        reach = np.arctan((0.5 + sign * shift) / centre)
        expected = G * (np.cos(0.02) * np.tan(reach) + sign * np.sin(0.02))
        assert run.outputs["onset_time"] * 0.01 * G == pytest.approx(expected, rel=1e-9)
        assert run.outputs["onset_time_base"] == run.outputs["onset_time"]
        assert np.sign(run.channels["rotation_1"][-1]) == -sign


@pytest.mark.parametrize("integrator", LANES)
def test_a_given_ratio_is_the_ratio_of_the_relative_rates(integrator: str) -> None:
    """Upper block alone on a wall that cannot lift: peaks of free rocking fall with e^2 of the energy."""
    values = {**B, "wall_mass": 1e7, "wall_length": 20.0, "top_restitution": 0.8}
    initial = {"rotation_1": 0.0, "rotation_2": 0.1}
    run = MODEL.simulate(values, Shaking.silence(6.0, 0.002), initial=initial, integrator=integrator)
    size = np.abs(run.channels["rotation_2"])
    peaks = [0.1, *size[1:-1][(size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])][:3]]
    alpha = np.arctan(0.3 / 1.6)
    height = np.cos(alpha - np.array(peaks)) - np.cos(alpha)
    np.testing.assert_allclose(height[1:] / height[:-1], 0.64, rtol=2e-5)


@pytest.mark.parametrize("integrator", LANES)
def test_restitution_factor_at_the_base(integrator: str) -> None:
    """As one body every impact keeps f e of the angular velocity: the first takes (1 - f^2 e^2) of the energy."""
    values = {**A, "wall_length": 0.6, "top_height": 0.2, "restitution.factor_on_housner_base": 0.9}
    stack = MODEL.build(values)
    e = 0.9 * float(stack.momentum_restitution[0])
    radius, alpha = float(np.hypot(0.3, stack.centre[0])), float(stack.slenderness[0])
    released = 1500 * G * radius * (np.cos(alpha - 0.05) - np.cos(alpha))
    silence = Shaking.silence(1.0, 0.005)
    run = MODEL.simulate(values, silence, initial={"rotation_1": 0.05}, integrator=integrator)
    assert run.outputs["impacts_base"] == 1
    assert run.outputs["dissipated_energy"] == pytest.approx((1 - e**2) * released, rel=1e-9)


@pytest.mark.parametrize("integrator", LANES)
def test_viscous_couple_takes_the_energy_it_should(integrator: str) -> None:
    """As one body: the loss before the first impact is the integral of d I_O theta'^2."""
    values = {**A, "wall_length": 0.6, "top_height": 0.2, "viscous_damping.rate": 0.3}
    corner = float(MODEL.build(values).corner_inertia(1.0)[0])
    run = MODEL.simulate(values, Shaking.silence(0.4, 0.001), initial={"rotation_1": 0.05}, integrator=integrator)
    rate = run.channels["rotation_rate_1"]
    assert run.outputs["impacts_base"] == 0
    lost = 0.3 * corner * np.trapezoid(rate**2, run.time)
    assert run.outputs["dissipated_energy"] == pytest.approx(lost, rel=1e-5)


PITCHED = {"table_pitch.pitch_per_acceleration": 0.002, "table_pitch.low_pass_hz": 8.0}


@pytest.mark.parametrize("integrator", LANES)
def test_a_light_block_on_a_pitching_table_leaves_the_wall_as_one_block(integrator: str) -> None:
    """With next to nothing on top the wall is Housner's block on the same table."""
    shaking = random_motion(np.random.default_rng(4), duration=4.0)
    wall = {**A, "wall_length": 0.6, "top_mass": 1e-6, "top_length": 0.5, "top_height": 0.2, **PITCHED}
    stack = MODEL.simulate(wall, shaking, scale=3.0, integrator=integrator)
    block = {"height": 3.0, "width": 0.6, "mass": 1000.0, "gravity": G, **PITCHED}
    one = models.get("housner").simulate(block, shaking, scale=3.0, integrator=integrator)
    assert one.outputs["impacts"] > 2 and stack.outputs["onset_time_base"] == pytest.approx(one.outputs["onset_time"])
    np.testing.assert_allclose(stack.channels["rotation_1"], one.channels["rotation_1"], atol=2e-7)
    plain = MODEL.simulate({k: v for k, v in wall.items() if "." not in k}, shaking, scale=3.0)
    assert np.max(np.abs(plain.channels["rotation_1"] - stack.channels["rotation_1"])) > 1e-3


def test_the_frame_of_a_pitching_table_turns_both_bodies_about_the_middle_of_the_base() -> None:
    """The couples over -psi'' are the kinetic products of the joints' motions with the turning of the whole frame."""
    stack = MODEL.build(B).one()
    whole, upper = stack.frame_inertia
    z1, z2, h2 = stack.centre_1, stack.height_1 + stack.centre_2, stack.centre_2
    assert whole == pytest.approx(stack.inertia_1 + stack.mass_1 * z1**2 + stack.inertia_2 + stack.mass_2 * z2**2)
    assert upper == pytest.approx(stack.inertia_2 + stack.mass_2 * z2 * h2)


@pytest.mark.parametrize("vertical", [False, True])
def test_lanes_agree_with_the_reference_on_a_pitching_table(vertical: bool) -> None:
    motion = random_motion(np.random.default_rng(6), duration=3.0)
    shaking = Shaking(motion.time_step, motion.horizontal, motion.vertical if vertical else None)
    lanes, reference = (MODEL.simulate({**B, **PITCHED}, shaking, scale=1.8, tail=1.0, integrator=how) for how in LANES)
    assert lanes.outputs["impacts_top"] > 2 and lanes.outputs["impacts_base"] == reference.outputs["impacts_base"]
    assert lanes.outputs["onset_time"] == pytest.approx(reference.outputs["onset_time"], abs=1e-7)
    for name in ("rotation_1", "rotation_2"):
        np.testing.assert_allclose(lanes.channels[name], reference.channels[name], atol=3e-6)
    for joint in ("base", "top"):
        demand = f"friction_demand_{joint}"
        assert lanes.outputs[demand] == pytest.approx(reference.outputs[demand], rel=0.02)


def test_a_joint_that_opens_on_a_pitching_table_stays_open() -> None:
    """Residuals about both corners tell the same: no stack of many opens and closes again without end."""
    rng = np.random.default_rng(3)
    walls = [random_wall(rng) for _ in range(100)]
    values = {name: np.array([wall[name] for wall in walls]) for name in walls[0]}
    scale = 3.0 * MODEL.derive(values)["onset_acceleration"]
    shaking = random_motion(np.random.default_rng(103), duration=6.0, vertical=True)
    found = MODEL.run("lanes", MODEL.build({**values, **PITCHED}, vertical=True), Request(shaking, scale)).outputs
    assert np.sum(found["status"] == 2) > 10 and not np.any(found["status"] == 5)
