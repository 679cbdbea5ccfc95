"""Sliding, bouncing and bending blocks against closed forms, limits and balances."""

from itertools import pairwise

import numpy as np
import pytest

from models.base import STATUS, FloatArray
from models.housner.cantilever import BETA, SIGMA, STRUCTURAL_DAMPING, modal_integrals
from models.housner.lanes import run as lanes
from models.runs import Request
from models.shaking import Shaking
from tests.models.mechanisms.cases import ALPHA, HOUSNER, WALL, by_lanes, by_reference, free, pulse, released

G = 9.80665
STOCKY = {"width": 1.6, "height": 2.0, "mass": 900.0}
START = {"rotation_1": 0.45 * ALPHA}


def test_a_stocky_block_slides_as_a_particle_does() -> None:
    """Constant acceleration a for T, then none: slip a' T^2/2 + (a' T)^2/(2 mu g), a' = a - mu g."""
    mu, a, duration = 0.2, 5.0, 0.4
    shaking = Shaking(0.01, np.full(41, a))
    response = HOUSNER.simulate({**STOCKY, "sliding.friction": mu}, shaking, duration=2.0)
    surplus = a - mu * G
    slip = surplus * duration**2 / 2 + (surplus * duration) ** 2 / (2 * mu * G)
    assert response.channels["displacement_1_x"][-1] == pytest.approx(-slip, rel=1e-12)
    np.testing.assert_array_equal(response.channels["rotation_1"], 0.0)
    np.testing.assert_array_equal(response.channels["contact_1"], 1.0)
    assert response.outputs["dissipated_energy"] == pytest.approx(mu * STOCKY["mass"] * G * slip, rel=1e-12)
    assert response.outputs["uplift_duration"] == 0.0 and response.outputs["status"] == 1.0


def test_a_block_slides_before_it_rocks_if_friction_is_under_its_slope() -> None:
    """Rocking from rest takes mu > b/h."""
    slope = WALL["width"] / WALL["height"]
    for factor, rocks in ((0.99, False), (1.01, True)):
        response = by_lanes({**WALL, "sliding.friction": factor * slope}, pulse(6.0, 0.3))
        assert (response.outputs["uplift_duration"] > 0.0) == rocks
        assert np.max(np.abs(response.shift)) > 1e-3
        assert response.outputs["friction_demand"] <= factor * slope * (1 + 1e-12)


@pytest.mark.parametrize("factor", [1.1, 3.0])
def test_friction_over_the_demand_changes_nothing(factor: float) -> None:
    shaking = pulse(3.9, 0.5)
    sticks = by_lanes(WALL, shaking)
    response = by_lanes({**WALL, "sliding.friction": factor * sticks.outputs["friction_demand"]}, shaking)
    np.testing.assert_allclose(response.rotation, sticks.rotation, rtol=0, atol=1e-12)
    np.testing.assert_array_equal(response.shift, 0.0)


def test_a_nearly_smooth_base_leaves_the_mass_centre_where_it_is() -> None:
    """Only friction moves it: |x''| <= mu N, and N stays under M g while the block falls back."""
    mu, step = 0.03, 0.002
    response = HOUSNER.simulate({**WALL, "sliding.friction": mu}, free(0.2, step), initial=START)
    moved = response.channels["displacement_1_x"] - response.channels["displacement_1_x"][0]
    assert not response.events
    assert np.max(np.abs(moved) - 0.5 * mu * G * response.time**2) < 1e-9
    # the corner slips by far more than that
    slip = moved - 1.0 * (np.sin(response.channels["rotation_1"]) - np.sin(START["rotation_1"]))
    assert np.max(np.abs(slip)) > 5 * np.max(np.abs(moved))


@pytest.mark.parametrize(
    "loses",
    [
        {"restitution.factor_on_housner": np.linspace(0.6, 0.98, 60)},
        {"velocity_restitution.beta": 0.1},
        {"degradation.loss_of_restitution_per_impact": 0.02},
    ],
    ids=lambda loses: next(iter(loses)),
)
def test_a_block_that_slides_and_loses_at_impacts_comes_to_an_end(loses: dict[str, float | FloatArray]) -> None:
    """Impacts that follow each other ever faster end where the block, and the slip it is left with, are slow."""
    time = 0.01 * np.arange(180)
    shaking = Shaking(0.01, 4.2 * np.sin(2 * np.pi * 2.3 * time) * (time < 1.0))
    rng = np.random.default_rng(0)
    values = {
        "width": rng.uniform(0.3, 0.7, 60), "height": 2.0, "mass": 1000.0,
        "sliding.friction": rng.uniform(0.15, 0.6, 60), **loses,
    }  # fmt: skip
    found = HOUSNER.evaluate(values, shaking, np.ones(60), outputs=["status", "impacts"], tail=8.0)
    assert np.count_nonzero(found["impacts"] > 0) > 20
    np.testing.assert_array_equal(found["status"] == STATUS.index("not_converged"), False)


@pytest.mark.parametrize(("friction", "factor"), [(0.4, 0.9), (0.32, 0.85), (0.27, 0.95)])
def test_what_slides_and_rocks_freely_loses_what_it_was_given(friction: float, factor: float) -> None:
    values = {**WALL, "sliding.friction": friction, "restitution.factor_on_housner": factor}
    fast, slow = by_lanes(values, free(6.0), START), by_reference(values, free(6.0), START)
    for response in (fast, slow):
        assert response.outputs["status"] == STATUS.index("rocking")
        assert response.rotation[-1] == response.rate[-1] == 0.0
        given = released(START["rotation_1"])
        assert response.outputs["dissipated_energy"] == pytest.approx(given, rel=1e-6)
    assert fast.outputs["impacts"] == slow.outputs["impacts"]
    assert fast.shift[-1] == pytest.approx(slow.shift[-1], rel=1e-5, abs=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_no_regime_adds_energy(seed: int) -> None:
    """What is lost grows with every event and never exceeds what was released."""
    rng = np.random.default_rng(seed)
    b = float(rng.uniform(0.15, 0.6))
    wall = {"width": 2 * b, "height": 2.0, "mass": 900.0}
    alpha = float(np.arctan(b))
    start = {"rotation_1": float(rng.uniform(0.3, 0.8)) * alpha}
    top = wall["mass"] * G * (b * np.sin(start["rotation_1"]) + np.cos(start["rotation_1"]) - 1.0)
    for values in (
        {"sliding.friction": float(rng.uniform(0.05, 0.3))},
        {"bounce.contact_restitution": float(rng.uniform(0.1, 0.6)), "restitution.factor_on_housner": 0.9},
        {"wall_flexibility.first_frequency": float(rng.uniform(8.0, 30.0))},
    ):
        lost = [
            by_lanes({**wall, **values}, free(duration), start).outputs["dissipated_energy"]
            for duration in np.arange(0.2, 2.6, 0.2)
        ]
        bound = top * (1.02 if "wall_flexibility.first_frequency" in values else 1.0)
        assert lost[0] >= 0.0 and np.all(np.diff(lost) >= -1e-9 * top) and lost[-1] <= bound


def test_the_block_turns_steadily_in_the_air() -> None:
    """After an impact theta' is constant, and e - c (1 - e) times what it was, until a corner lands."""
    c, step = 0.6, 0.0005
    response = by_lanes({**WALL, "bounce.contact_restitution": c}, free(1.0, step), START)
    time = next(t for t, kind in response.events if kind == "impact")
    k = int(time / step)
    flight = response.rate[k + 1 : k + 6]
    e = 1 - 1.5 * np.sin(ALPHA) ** 2
    block = HOUSNER.build(WALL)
    before = -np.sqrt(2 * released(START["rotation_1"]) / block.pivot_inertia[0])
    assert flight[0] == pytest.approx((e - c * (1 - e)) * before, rel=1e-9)
    np.testing.assert_array_equal(flight, flight[0])
    hop = np.flatnonzero(response.rate[k + 1 :] != flight[0])[0] * step
    rebound = c * WALL["width"] * abs(before)
    # the corner falls back with g less the centripetal part
    assert hop == pytest.approx(2 * rebound / (G - flight[0] ** 2), rel=0.02)


def test_the_mode_is_that_of_a_uniform_cantilever() -> None:
    x = np.linspace(0.0, 1.0, 20_001)
    shape = 0.5 * (np.cosh(BETA * x) - np.cos(BETA * x) - SIGMA * (np.sinh(BETA * x) - np.sin(BETA * x)))
    assert np.cos(BETA) * np.cosh(BETA) == pytest.approx(-1.0, abs=1e-12)
    ones, none = np.ones(1), np.zeros(1)
    integrals = modal_integrals(ones, 2.0 * ones, none, none, none)
    for name, integrand in (
        ("modal_mass", shape**2),
        ("modal_force", shape),
        ("modal_moment", 2.0 * x * shape),
    ):
        assert integrals[name][0] == pytest.approx(np.trapezoid(integrand, x), rel=1e-7)
    top = modal_integrals(none, 2.0 * ones, ones, none, none)
    assert (top["modal_mass"][0], top["modal_force"][0], top["modal_moment"][0]) == (1.0, 1.0, 2.0)


def test_a_clamped_wall_rings_at_its_declared_frequency() -> None:
    frequency, step = 9.0, 0.001
    time = np.arange(2001) * step
    kick = np.where(time < 0.05, 0.3 * np.sin(2 * np.pi * time / 0.05), 0.0)
    response = by_lanes({**WALL, "wall_flexibility.first_frequency": frequency}, Shaking(step, kick))
    assert response.outputs["uplift_duration"] == 0.0
    ring = response.shift[100:]
    up = np.flatnonzero((ring[:-1] < 0.0) & (ring[1:] >= 0.0))
    crossings = (up - ring[up] / (ring[up + 1] - ring[up])) * step
    damped = frequency * np.sqrt(1 - STRUCTURAL_DAMPING**2)
    np.testing.assert_allclose(1 / np.diff(crossings), damped, rtol=1e-4)
    tops = np.array([np.max(ring[i:j]) for i, j in pairwise(up)])
    decay = np.log(tops[:-1] / tops[1:])
    np.testing.assert_allclose(decay, 2 * np.pi * STRUCTURAL_DAMPING, rtol=2e-2)


def test_bending_hastens_the_first_uplift() -> None:
    """Under a slow rise the moment grows by the mode's statics only; under a sudden one it overshoots."""
    time = np.arange(401) * 0.005
    slow = Shaking(0.005, 3.0 * np.minimum(1.0, time / 1.5))
    sudden = Shaking(0.005, np.full(401, 0.8 * G * 0.25))
    rigid = by_lanes(WALL, slow).outputs["onset_time"]
    soft = {**WALL, "wall_flexibility.first_frequency": 10.0}
    assert by_lanes(soft, slow).outputs["onset_time"] == pytest.approx(rigid, rel=2e-2)
    assert by_lanes(WALL, sudden).outputs["uplift_duration"] == 0.0
    assert by_lanes(soft, sudden).outputs["uplift_duration"] > 0.0


def test_a_stiff_wall_follows_the_rigid_block() -> None:
    """The difference falls at least with the frequency."""
    shaking = free(2.0)
    rigid = by_lanes(WALL, shaking, START).rotation
    apart = []
    for frequency in (25.0, 50.0, 100.0):
        response = by_lanes({**WALL, "wall_flexibility.first_frequency": frequency}, shaking, START)
        apart.append(np.max(np.abs(response.rotation - rigid)) / START["rotation_1"])
    assert apart[1] < 0.6 * apart[0] and apart[2] < 0.6 * apart[1] < 0.02


def test_a_bending_wall_loses_what_it_released() -> None:
    """Weight and spring of the start, all lost when the wall has come to rest."""
    frequency = 15.0
    values = {**WALL, "wall_flexibility.first_frequency": frequency}
    response = by_lanes(values, free(16.0), START)
    block = HOUSNER.build(values)
    m, f = float(block.modal_mass[0]), float(block.modal_force[0])
    eta = response.shift[0] / (f / WALL["mass"] * np.cos(START["rotation_1"]))
    bent = 0.5 * m * (2 * np.pi * frequency * eta) ** 2 - G * f * eta * np.sin(START["rotation_1"])
    assert response.rotation[-1] == 0.0 and abs(response.shift[-1]) < 1e-9
    assert response.outputs["dissipated_energy"] == pytest.approx(released(START["rotation_1"]) + bent, rel=1e-5)


def test_a_lane_without_regimes_pays_nothing() -> None:
    """Lanes side by side: each as if it ran alone."""
    shaking = pulse(3.9, 0.5)
    values = {
        **WALL,
        "sliding.friction": np.array([np.inf, 0.27, np.inf, np.inf]),
        "bounce.contact_restitution": np.array([0.0, 0.0, 0.4, 0.0]),
        "wall_flexibility.first_frequency": np.array([np.inf, np.inf, np.inf, 20.0]),
    }
    block = HOUSNER.build(values)
    request = Request(shaking, np.ones(4), samples=shaking.horizontal.size)
    together = lanes.run(block, request).samples[..., 0]
    for k in range(4):
        alone = lanes.run(block.take([k]), request.take([k])).samples[..., 0]
        np.testing.assert_allclose(together[k], alone[0], rtol=0, atol=1e-12)
    pair = lanes.run(block.take([0, 1]), request.take([0, 1])).samples[..., 0]
    np.testing.assert_array_equal(together[0], pair[0])
