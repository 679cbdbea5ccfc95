"""What pins each mechanism of couples, geometry, base and impact down: energy, symmetry, equivalence."""

import numpy as np
import pytest

from models.shaking import Shaking
from tests.models.mechanisms.cases import (
    ALPHA,
    HOUSNER,
    WALL,
    P,
    Response,
    by_lanes,
    dotted,
    free,
    pulse,
    released,
)

G = 9.80665
START = {"rotation_1": 0.4 * ALPHA}


def first_impact(response: Response) -> float:
    return next(float(time) for time, kind in response.events if kind == "impact")


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("viscous_damping", {"rate": 0.8}),
        ("coulomb_damping", {"over_m_g_b": 0.08}),
        ("quadratic_damping", {"coefficient": 4.0}),
        ("rounded_corner", {"radius_over_half_width": 0.25}),
        ("velocity_restitution", {"beta": 0.4}),
        ("degradation", {"loss_of_restitution_per_impact": 0.02, "floor": 0.6}),
        ("sliding", {"friction": 0.13}),
        ("bounce", {"contact_restitution": 0.5}),
    ],
)
def test_all_energy_released_is_lost_when_the_block_is_at_rest(name: str, values: dict[str, float]) -> None:
    response = by_lanes({**WALL, **dotted(name, values)}, free(30.0), START)
    theta, rho = START["rotation_1"], values.get("radius_over_half_width", 0.0) * WALL["width"] / 2
    # a rolling corner carries the mass centre on a circle about the corner's own centre
    b, h = WALL["width"] / 2 - rho, WALL["height"] / 2 - rho
    energy = WALL["mass"] * G * (b * np.sin(theta) + h * np.cos(theta) - h)
    assert response.events[-1][1] == "rest" and response.rotation[-1] == 0.0
    assert response.outputs["dissipated_energy"] == pytest.approx(energy, rel=1e-8)


@pytest.mark.parametrize(("name", "values"), [("rounded_corner", {"radius_over_half_width": 0.3})])
def test_energy_is_conserved_between_impacts(name: str, values: dict[str, float]) -> None:
    response = by_lanes({**WALL, **dotted(name, values)}, free(3.0, 0.001), START)
    before = np.arange(response.rotation.size) * 0.001 < first_impact(response)
    theta, rate = response.rotation[before], response.rate[before]
    rho = values["radius_over_half_width"] * WALL["width"] / 2
    b, h, m = WALL["width"] / 2 - rho, WALL["height"] / 2 - rho, WALL["mass"]
    # the mass centre rolls: x = rho theta - b cos + h sin, z = rho + b sin + h cos
    across, up = rho + b * np.sin(theta) + h * np.cos(theta), b * np.cos(theta) - h * np.sin(theta)
    own = m * (WALL["width"] ** 2 + WALL["height"] ** 2) / 12
    energy = 0.5 * (own + m * (across**2 + up**2)) * rate**2 + m * G * (b * np.sin(theta) + h * np.cos(theta))
    assert np.max(np.abs(energy - energy[0])) < 1e-9 * released(START["rotation_1"])


def test_a_spring_keeps_energy_too() -> None:
    """Kinetic energy at the first impact = what weight and spring release, seen in what the impact takes."""
    k, gap, e = 0.3, 0.03, 0.8
    response = by_lanes(
        {**WALL, "restitution": e, "added_stiffness.over_m_g_R": k, "added_stiffness.gap": gap}, free(0.7, 0.001), START
    )
    radius = np.hypot(WALL["width"], WALL["height"]) / 2
    spring = 0.5 * k * WALL["mass"] * G * radius * (START["rotation_1"] - gap) ** 2
    assert response.outputs["impacts"] == 1
    lost = (1 - e**2) * (released(START["rotation_1"]) + spring)
    assert response.outputs["dissipated_energy"] == pytest.approx(lost, rel=1e-5)


@pytest.mark.parametrize(
    ("values", "ratios"),
    [
        ({"restitution.factor_on_housner": 0.8}, lambda e, speed: 0.8 * e),
        ({"velocity_restitution.beta": 0.4}, lambda e, speed: e * (1 - 0.4 * speed)),
        ({"degradation.loss_of_restitution_per_impact": 0.03}, lambda e, speed: e),
    ],
)
def test_the_first_impact_keeps_the_declared_share(values: dict[str, float], ratios: object) -> None:
    response = by_lanes({**WALL, **values}, free(0.7, 0.001), START)
    energy = released(START["rotation_1"])
    block = HOUSNER.build(WALL)
    speed = float(np.sqrt(2 * energy / block.pivot_inertia[0])) / (P * ALPHA)
    e = ratios(1 - 1.5 * np.sin(ALPHA) ** 2, speed)  # type: ignore[operator]
    assert response.outputs["impacts"] == 1
    assert response.outputs["dissipated_energy"] == pytest.approx((1 - e**2) * energy, rel=1e-9)


def test_restitution_falls_from_impact_to_impact_down_to_the_floor() -> None:
    loss, floor, e = 0.03, 0.92, 1 - 1.5 * np.sin(ALPHA) ** 2
    name = "degradation"
    values = dotted(name, {"loss_of_restitution_per_impact": loss, "floor": floor})
    response = by_lanes({**WALL, **values}, free(5.0, 0.0005), START)
    b, h = WALL["width"] / 2, WALL["height"] / 2
    size = np.abs(response.rotation)
    height = b * np.sin(size) + h * np.cos(size) - h
    peaks = np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])) + 1
    energy = np.concatenate([[height[0]], height[peaks]])[:6]
    kept = np.sqrt(energy[1:] / energy[:-1]) / e
    expected = np.maximum(floor, 1 - loss * np.arange(kept.size))
    np.testing.assert_allclose(kept, expected, rtol=2e-6)


def test_an_eccentric_block_is_the_mirror_image_of_the_other_one() -> None:
    shaking = pulse(4.0, 0.5)
    mirrored = Shaking(shaking.time_step, -shaking.horizontal)
    one = by_lanes({**WALL, "eccentricity.offset_over_half_width": 0.1}, shaking)
    other = by_lanes({**WALL, "eccentricity.offset_over_half_width": -0.1}, mirrored)
    np.testing.assert_array_equal(one.rotation, -other.rotation)
    assert one.outputs["peak_rotation"] != by_lanes(WALL, shaking).outputs["peak_rotation"]


def test_an_eccentric_block_starts_on_the_side_of_its_mass_centre() -> None:
    """Positive to +x: it takes less to tip it clockwise, that is with a negative acceleration."""
    block = HOUSNER.build({**WALL, "eccentricity.offset_over_half_width": 0.1})
    assert block.right[0] == pytest.approx(0.9 * 0.25) and block.left[0] == pytest.approx(1.1 * 0.25)
    assert HOUSNER.derive({**WALL, "eccentricity.offset_over_half_width": 0.1})["onset_acceleration"] == pytest.approx(
        0.9 * G * 0.25
    )


def test_tilt_equals_a_constant_acceleration_and_less_gravity() -> None:
    tilt, shaking = 0.02, pulse(3.5, 0.5)
    leaning = by_lanes({**WALL, "tilt.tilt": tilt}, shaking)
    moved = Shaking(shaking.time_step, shaking.horizontal - G * np.sin(tilt))
    pushed = by_lanes({**WALL, "gravity": G * np.cos(tilt)}, moved)
    np.testing.assert_allclose(leaning.rotation, pushed.rotation, rtol=0, atol=1e-13)
    # clockwise positive: a base that leans clockwise tips the block clockwise
    edge = {"rotation_1": 0.8 * ALPHA}
    assert by_lanes({**WALL, "tilt.tilt": 0.05}, free(6.0), edge).outputs["residual_rotation"] == np.pi / 2
    assert by_lanes({**WALL, "tilt.tilt": -0.05}, free(0.1), edge).rate[-1] < 0.0


def test_all_of_the_vertical_motion_equals_feeding_it() -> None:
    left_out = pulse(3.9, 0.5)
    fed = Shaking(left_out.time_step, left_out.horizontal, left_out.vertical)
    response = by_lanes({**WALL, "vertical_acceleration.kappa": 1.0}, left_out)
    np.testing.assert_array_equal(response.rotation, by_lanes(WALL, fed).rotation)
    assert np.any(response.rotation != by_lanes(WALL, left_out).rotation)


def test_the_vertical_motion_cannot_act_twice() -> None:
    motion = pulse(3.9, 0.5)
    values = {**WALL, "vertical_acceleration.kappa": 0.5}
    fed = Shaking(motion.time_step, motion.horizontal, motion.vertical)
    without = Shaking(motion.time_step, motion.horizontal)
    for shaking, words in ((fed, "acts already"), (without, "needs the vertical motion")):
        with pytest.raises(ValueError, match=words):
            HOUSNER.evaluate(values, shaking, np.ones(1), outputs=["peak_rotation"], tail=1.0)
    found = HOUSNER.evaluate(values, motion, np.ones(1), outputs=["peak_rotation"], tail=1.0)
    assert found["peak_rotation"][0] > 0.0


def test_crushed_corners_stay_where_the_largest_rotation_left_them() -> None:
    """From a standing start at the largest rotation they are insets of that size, whatever follows."""
    rate = 1.2
    crushed = by_lanes({**WALL, "crushing.inset_per_rotation": rate}, free(4.0), START)
    inset = by_lanes({**WALL, "pivot_inset.inset_over_half_width": rate * START["rotation_1"]}, free(4.0), START)
    np.testing.assert_allclose(crushed.rotation, inset.rotation, rtol=0, atol=1e-11)


def test_a_flexible_joint_has_no_threshold_and_stiffens_to_the_rigid_one() -> None:
    shaking = pulse(0.5, 0.5)
    assert by_lanes(WALL, shaking).outputs["peak_rotation"] == 0.0
    assert by_lanes({**WALL, "flexible_joint.angle": 0.01}, shaking).outputs["peak_rotation"] > 1e-3
    rigid = by_lanes(WALL, free(1.5), START).rotation
    apart = [
        np.max(np.abs(by_lanes({**WALL, "flexible_joint.angle": angle}, free(1.5), START).rotation - rigid))
        for angle in (4e-3, 1e-3, 2.5e-4)
    ]
    assert apart[1] < 0.5 * apart[0] and apart[2] < 0.5 * apart[1] < 0.01 * ALPHA


def test_pitch_changes_the_onset_as_gravity_and_the_turning_of_the_table_say() -> None:
    """a h (1 - c g) + (I/M + h^2) c a'' = g b, for a motion far below the corner of the low-pass."""
    c, step, width = 0.002, 0.01, 2.0
    time = np.arange(1201) * step
    fine = np.linspace(4.0, 6.0, 400_001)

    def motion(t: np.ndarray) -> np.ndarray:
        return 2.7 * np.exp(-(((t - 6.0) / width) ** 2))

    curvature = motion(fine) * (4 * (fine - 6.0) ** 2 / width**4 - 2 / width**2)
    b, h = WALL["width"] / 2, WALL["height"] / 2
    arm = (b**2 + h**2) / 3 + h**2
    expected = fine[np.argmax(motion(fine) * h * (1 - c * G) + arm * c * curvature > G * b)]
    values = {**WALL, "table_pitch.pitch_per_acceleration": c, "table_pitch.low_pass_hz": 30.0}
    onset = by_lanes(values, Shaking(step, motion(time))).outputs["onset_time"]
    assert onset == pytest.approx(expected, abs=1e-4)
    assert abs(onset - by_lanes(WALL, Shaking(step, motion(time))).outputs["onset_time"]) > 0.03
