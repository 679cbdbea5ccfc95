"""Points of rigid bodies: by hand, against the models' own observables, and as derivatives."""

from __future__ import annotations

import numpy as np
import pytest

import models
from models.kinematics import GRAVITY, Place
from models.shaking import Shaking

STILL = (np.zeros(1), np.zeros(1))
BLOCK = {"width": 0.25, "height": 1.8, "mass": 540.0}
STACK = {
    "wall_length": 0.6, "wall_height": 1.8, "wall_mass": 900.0, "top_mass": 700.0, "top_length": 0.5, "top_height": 0.4,
}  # fmt: skip


def poses(theta: float, x: float, z: float) -> dict[str, np.ndarray]:
    return {
        "rotation_1": np.array([theta]), "underside_1_x": np.array([x]), "underside_1_z": np.array([z]),
        "underside_1_height": np.zeros(1),
    }  # fmt: skip


def test_a_quarter_turn_about_the_right_corner_by_hand() -> None:
    # corners (-.5, 0) and (.5, 0), top at 2: turned clockwise about (.5, 0) they lie at (.5, 1), (.5, 0) and (2.5, .5)
    at = poses(np.pi / 2.0, 0.5, 0.5)
    seen = {
        (x, z, d): Place("displacement", 1, x, z, d).read(at, 0.1, STILL).item()
        for x, z in ((-0.5, 0.0), (0.5, 0.0), (0.0, 2.0))
        for d in ("x", "z")
    }
    assert seen[-0.5, 0.0, "x"] == pytest.approx(1.0)
    assert seen[-0.5, 0.0, "z"] == pytest.approx(1.0)
    assert seen[0.5, 0.0, "x"] == pytest.approx(0.0)
    assert seen[0.5, 0.0, "z"] == pytest.approx(0.0)
    assert seen[0.0, 2.0, "x"] == pytest.approx(2.5)
    assert seen[0.0, 2.0, "z"] == pytest.approx(-1.5)
    assert Place("uplift", 1, -0.5).read(at, 0.1, STILL).item() == pytest.approx(1.0)
    assert Place("compression", 1, -0.5).read(at, 0.1, STILL).item() == pytest.approx(-1.0)


def test_an_accelerometer_that_leans_feels_gravity() -> None:
    lean = {name: np.repeat(x, 3) for name, x in poses(0.1, 0.0, 0.0).items()}
    across = Place("acceleration", 1, 0.0, 1.0, "across", "absolute").read(lean, 0.01, STILL)
    along = Place("acceleration", 1, 0.0, 1.0, "along", "absolute").read(lean, 0.01, STILL)
    assert across == pytest.approx(-GRAVITY * np.sin(0.1))
    assert along == pytest.approx(GRAVITY * (np.cos(0.1) - 1.0))


@pytest.fixture(scope="module")
def rocked() -> models.base.History:
    start = {"rotation_1": 0.1}
    return models.get("housner").simulate(BLOCK, Shaking.silence(2.0, 0.005), initial=start, duration=2.0)


def test_two_gauges_under_the_corners_measure_the_rotation(rocked: models.base.History) -> None:
    left, right = (Place("uplift", 1, x).read(rocked.channels, 0.005, STILL) for x in (-0.125, 0.125))
    np.testing.assert_allclose(np.arcsin((left - right) / 0.25), rocked.channels["rotation_1"], atol=1e-12)
    assert np.min([left, right]) > -1e-12  # a rigid body does not sink into its base


@pytest.mark.parametrize("x", (0.0, 0.1))
def test_the_acceleration_of_a_point_adds_up_to_its_displacement(rocked: models.base.History, x: float) -> None:
    place = {q: Place(q, 1, x, 1.8, "x", "base") for q in ("displacement", "acceleration")}
    displacement, acceleration = (p.read(rocked.channels, 0.005, STILL) for p in place.values())
    speed = (displacement[1] - displacement[0]) / 0.005 + 0.005 * np.cumsum(acceleration[1:-1])
    again = displacement[1] + 0.005 * np.cumsum(speed)
    np.testing.assert_allclose(again, displacement[2:], atol=1e-9)


def test_differences_converge_to_the_derivatives_with_the_square_of_the_step() -> None:
    errors = []
    for step in (0.02, 0.01, 0.005):
        time = np.arange(0.0, 1.0, step)
        theta = 0.2 * np.sin(5.0 * time)
        at = {"rotation_1": theta, "underside_1_x": 0.0 * time, "underside_1_z": 0.0 * time}
        seen = Place("acceleration", 1, 0.0, 2.0, "x", "base").read(at, step, STILL)
        rate = np.cos(5.0 * time)
        exact = -10.0 * np.sin(5.0 * time) * np.cos(theta) - 2.0 * np.sin(theta) * rate**2
        errors.append(np.max(np.abs(seen - exact)[1:-1]))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.1)


def test_both_blocks_of_a_stack_are_where_their_mass_centres_say() -> None:
    start = {"rotation_1": 0.05, "rotation_2": -0.08}
    model = models.get("stacked")
    ran = model.simulate(STACK, Shaking.silence(0.6, 0.005), initial=start, duration=0.6).channels
    for body, height in ((1, 0.9), (2, 0.2)):
        seen = Place("displacement", body, 0.0, height).read(ran, 0.005, STILL)
        np.testing.assert_allclose(seen, ran[f"displacement_{body}_x"], atol=1e-12)
    left, right = (Place("uplift", 2, x).read(ran, 0.005, STILL) for x in (-0.25, 0.25))
    np.testing.assert_allclose(np.arcsin((left - right) / 0.5), ran["rotation_2"] - ran["rotation_1"], atol=1e-12)
    assert np.min(np.minimum(left, right)) > -1e-12
    np.testing.assert_allclose(np.minimum(left, right), 0.0, atol=1e-12)  # one corner always stands


@pytest.mark.parametrize(("name", "size"), (("interface", 0.1), ("interface_linear", 1e-4)))
def test_a_wall_on_layers_is_where_its_mass_centres_and_its_compression_say(name: str, size: float) -> None:
    model = models.get(name)
    layers = {"wall_thickness": 0.4, "layer_thickness": 0.01, "layer_modulus": 3e6, "damping_ratio": 0.05}
    wall = model.build({**STACK, **layers})
    state = size * np.random.default_rng(1).normal(size=(1, 6, 8))
    state[:, :, 2:4] -= 2e-4
    seen = {**model.observe(wall, state), **model.poses(wall, state)}
    for body, height in ((1, 0.9), (2, 0.2)):
        moved = Place("displacement", body, 0.0, height).read(seen, 0.005, STILL)
        np.testing.assert_allclose(moved, seen[f"displacement_{body}_x"], atol=1e-11)
    rest = model.derive({**STACK, **layers})["static_compression_base"]
    closed = Place("compression", 1).read(seen, 0.005, STILL)
    np.testing.assert_allclose(closed, seen["compression_base"] - rest, atol=1e-12)


def load(history: models.base.History, step: float, body: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Forces of the joint under a body, right and up, less those at rest; nothing moves the base."""
    across, up = (Place("force", body, direction=d).read(history.channels, step, STILL) for d in ("x", "z"))
    return across, up


def test_the_largest_share_of_friction_by_load_cells_is_that_of_the_kernel() -> None:
    step = 2e-4
    ran = models.get("housner").simulate(
        BLOCK, Shaking.silence(0.4, step), initial={"rotation_1": 0.1, "rotation_rate_1": -0.3}, duration=0.4
    )
    across, up = load(ran, step)
    weight = BLOCK["mass"] * GRAVITY
    landed = np.flatnonzero(np.diff(np.sign(ran.channels["rotation_1"])))
    clear = np.ones(across.size, bool)
    clear[[*landed, *(landed + 1), *(landed + 2), 0, -1]] = False  # an impact is an impulse
    demand = np.max((np.abs(across) / (up + weight))[clear])
    assert demand == pytest.approx(ran.outputs["friction_demand"], rel=2e-3)


def test_load_cells_keep_momentum_through_impacts(rocked: models.base.History) -> None:
    across, _ = load(rocked, 0.005)
    x = Place("displacement", 1, 0.0, 0.9).read(rocked.channels, 0.005, STILL)
    gained = BLOCK["mass"] * ((x[-1] - x[-2]) - (x[1] - x[0])) / 0.005
    assert 0.005 * np.sum(across[1:-1]) == pytest.approx(gained, rel=1e-9)
    assert sum(event.kind == "impact" for event in rocked.events) == 2


def test_a_joint_carries_what_stands_on_it() -> None:
    start = {"rotation_1": 0.05, "rotation_2": -0.08}
    ran = models.get("stacked").simulate(STACK, Shaking.silence(0.6, 0.005), initial=start, duration=0.6)
    lower, upper = load(ran, 0.005), load(ran, 0.005, 2)
    for of_lower, of_upper, direction in zip(lower, upper, "xz", strict=True):
        wall = Place("acceleration", 1, 0.0, 0.9, direction, "base").read(ran.channels, 0.005, STILL)
        np.testing.assert_allclose(of_lower - of_upper, STACK["wall_mass"] * wall, atol=1e-6 * np.max(np.abs(of_lower)))


def test_a_layer_s_law_gives_the_force_that_load_cells_read() -> None:
    model, step = models.get("interface"), 2e-4
    wall = {
        **STACK, "wall_thickness": 0.4, "layer_thickness": 0.01, "layer_modulus": 3e6, "damping_ratio": 0.0,
    }  # fmt: skip
    rest = model.derive(wall)
    deep, top = (float(rest[f"static_compression_{joint}"].item()) for joint in ("base", "top"))
    start = {"displacement_z_1": -1.2 * deep, "displacement_z_2": -top}  # it bounces and stays in full contact
    ran = model.simulate(wall, Shaking.silence(0.2, step), initial=start, duration=0.2)
    across, up = load(ran, step)
    weight = (STACK["wall_mass"] + STACK["top_mass"]) * GRAVITY
    law = weight * (ran.channels["compression_base"] / deep - 1.0)
    np.testing.assert_allclose(up[1:-1], law[1:-1], atol=2e-3 * np.max(np.abs(law)))
    assert np.max(np.abs(across)) < 1e-9 * weight


def test_load_cells_feel_the_base(rocked: models.base.History) -> None:
    ground = np.full(rocked.time.size, 2.0), np.full(rocked.time.size, 0.5)
    for k, direction in enumerate("xz"):
        place = Place("force", 1, direction=direction)
        still, shaken = (place.read(rocked.channels, 0.005, base) for base in (STILL, ground))
        np.testing.assert_allclose(shaken - still, BLOCK["mass"] * (2.0, 0.5)[k], rtol=1e-9)
