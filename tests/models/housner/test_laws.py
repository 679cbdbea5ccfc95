"""The laws beyond the plain block: closed forms of the reference, and the lanes held against it."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import quad

from models.housner.block import Block, assemble
from models.housner.lanes import run as lanes
from models.housner.reference.impact import momentum_restitution, restitution
from models.runs import Request
from models.shaking import Shaking
from tests.models.housner.adapter import Response, by_reference, rectangle
from tests.models.strategies import random_motion

ALPHA = 0.25
PLAIN = assemble(rectangle(ALPHA), True)
M, H, B = float(PLAIN.mass[0]), float(PLAIN.height[0]), float(PLAIN.right[0])
WEIGHT = M * 9.80665
Lift = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]]
LAWS: dict[str, dict[str, float]] = {
    "rounded": {"corner_radius": 0.2 * B},
    "crushing": {"crushing_rate": 2.0},
    "joint": {"joint_angle": 0.01},
    "stiffness": {"stiffness": 0.3 * WEIGHT * H},
    "gap": {"stiffness": 0.5 * WEIGHT * H, "gap": 0.02},
    "viscous": {"viscous": 0.4},
    "quadratic": {"quadratic": 2.0},
    "coulomb": {"coulomb": 0.05 * WEIGHT * B},
    "pitch": {"pitch_per_acceleration": 0.002, "pitch_low_pass": 8.0},
    "eccentric": {"right": 1.1 * B, "left": 0.9 * B},
    "tilted": {"offset": 0.3},
    "velocity": {"velocity_slope": 0.3},
    "amplitude": {"amplitude_exponent": 0.2, "aspect_coefficient": 0.5},
    "wear": {"loss_per_impact": 0.02, "restitution_floor": 0.7},
    "many": {
        "corner_radius": 0.1 * B, "crushing_rate": 1.0, "viscous": 0.2, "quadratic": 0.5, "right": 1.05 * B,
        "stiffness": -0.1 * WEIGHT * H, "loss_per_impact": 0.01,
    },
}  # fmt: skip


def energy(block: Block, run: Response, lift: Lift) -> np.ndarray:
    """J theta'^2/2 + M g (Z - Z_0) at the samples, with ``lift(theta)`` = (X_t, Z_t, potential arm)."""
    sway, rise, potential = lift(run.rotation)
    turning = float(block.inertia[0]) + M * (sway**2 + rise**2)
    return 0.5 * turning * run.rate**2 + WEIGHT * potential


def free(block: Block, theta: float, duration: float) -> Response:
    return by_reference(block, Shaking.silence(duration, 0.005), initial={"rotation_1": theta}, rtol=1e-12)


def test_a_rolling_corner_keeps_its_energy() -> None:
    """Z = rho + s b' sin + h' cos is the height of the centre; its derivative is the equation's arm."""
    rho = 0.3 * B
    block = PLAIN.replace(corner_radius=rho)
    b, h = B - rho, H - rho

    def lift(theta: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        s = np.sign(theta)
        sway = rho + s * b * np.sin(theta) + h * np.cos(theta)
        rise = s * b * np.cos(theta) - h * np.sin(theta)
        return sway, rise, rho + s * b * np.sin(theta) + h * np.cos(theta) - H

    run = free(block, 0.1, 0.9)
    total = energy(block, run, lift)
    before = run.time < run.events[0].time
    assert run.outputs["impacts"] == 1
    np.testing.assert_allclose(total[before], total[0], rtol=1e-9)
    after = total[~before]
    np.testing.assert_allclose(after, after[0], rtol=1e-9)
    e = float(momentum_restitution(block, np.array([b]), np.array([b]))[0])
    assert after[0] / total[0] == pytest.approx(e**2, rel=1e-9)
    assert e == pytest.approx(1 - 2 * M * b**2 / (float(block.inertia[0]) + M * (H**2 + b**2)), rel=1e-13)


@pytest.mark.parametrize("law", ["joint", "gap"])
def test_conservative_laws_keep_their_energy(law: str) -> None:
    """What a potential of the law's own moment says of the velocity at the first impact."""
    block, start = PLAIN.replace(**LAWS[law]), 0.1

    def moment(theta: float) -> float:
        share = 1.0 - np.exp(-theta / 0.01) if law == "joint" else 1.0
        spring = 0.5 * WEIGHT * H * max(0.0, theta - 0.02) if law == "gap" else 0.0
        return WEIGHT * (B * np.cos(theta) - H * np.sin(theta)) * share + spring

    released = quad(moment, 0.0, start, points=[0.02], epsabs=1e-10)[0]
    run = free(block, start, 0.9)
    e = float(block.momentum_restitution[0])
    assert run.outputs["impacts"] == 1
    assert run.outputs["dissipated_energy"] == pytest.approx((1 - e**2) * released, rel=1e-9)


def test_coulomb_friction_holds_the_block_and_delays_the_onset() -> None:
    hold = PLAIN.replace(coulomb=WEIGHT * B)
    run = free(hold, 0.1, 2.0)
    assert run.rotation[-1] == 0.1 and run.outputs["dissipated_energy"] == 0.0
    shaking = Shaking(0.01, np.ones(50))
    block = PLAIN.replace(coulomb=0.1 * WEIGHT * B)
    onset = 1.1 * 9.80665 * B / H
    assert by_reference(block, shaking, onset * (1 - 1e-9)).outputs["status"] == 1
    assert by_reference(block, shaking, onset * (1 + 1e-9)).outputs["status"] == 2


@pytest.mark.parametrize("share", [0.02, 0.4])
def test_a_block_that_friction_lets_go_moves_on(share: float) -> None:
    """Held and let go inside one sample, or by a moment that is the couple to rounding."""
    shaking = random_motion(np.random.default_rng(4), duration=4.0)
    block = assemble({"height": 3.0, "width": 0.6, "mass": 1000.0, "gravity": 9.81}, True)
    run = by_reference(block.replace(coulomb=share * 1000.0 * 9.81 * 0.3), shaking, 3.0, tail=1.0)
    assert run.outputs["status"] == 2 and run.outputs["impacts"] > 2
    held = (run.rotation != 0.0) & (run.rate == 0.0)
    assert held.any() == (share == 0.4)


def test_work_of_friction_is_the_couple_times_the_angle() -> None:
    block = PLAIN.replace(coulomb=0.05 * WEIGHT * B, restitution=1.0)
    run = free(block, 0.1, 0.8)
    assert run.outputs["impacts"] == 1
    travelled = 0.1 + abs(run.rotation[-1])
    assert np.all(np.diff(np.abs(run.rotation[run.time > run.events[0].time])) >= 0.0)
    assert run.outputs["dissipated_energy"] == pytest.approx(0.05 * WEIGHT * B * travelled, rel=1e-9)


@pytest.mark.parametrize("law", LAWS)
def test_lanes_follow_the_reference(law: str) -> None:
    block = PLAIN.replace(**LAWS[law])
    shaking = random_motion(np.random.default_rng(7), duration=5.0, vertical=True)
    scale = 1.6 * 9.80665 * np.tan(ALPHA)
    slow = by_reference(block, shaking, scale, tail=2.0).outputs
    found = lanes.run(block, Request(shaking, np.array([scale]), tail=2.0)).outputs
    fast = {name: float(value[0]) for name, value in found.items()}
    assert slow["impacts"] > 3
    assert 0.02 < slow["peak_rotation_ratio"] < 0.8
    for name, tolerance in (
        ("peak_rotation", 1e-5), ("dissipated_energy", 1e-4), ("friction_demand", 2e-2), ("onset_time", 1e-6),
    ):  # fmt: skip
        assert fast[name] == pytest.approx(slow[name], rel=tolerance), name


@pytest.mark.parametrize("law", ["velocity", "amplitude", "wear", "eccentric", "rounded"])
def test_impact_law_of_the_lanes_is_the_formula(law: str) -> None:
    """e from the energies of the first two impacts of a free run against `models.housner.reference.impact`."""
    block = PLAIN.replace(**LAWS[law])
    b = [float(x[0]) - float(block.corner_radius[0]) for x in (block.right, block.left)]
    start = {"rotation_rate_1": np.array([0.3])}
    request = Request(Shaking.silence(3.0, 0.001), np.ones(1), initial=start, samples=3001, log=4)
    one = lanes.run(block, request)
    times = [event.time for event in one.events[0] if event.kind == "impact"]
    arcs = [0, *(round(time / 0.001) for time in times)]
    base = float(block.inertia[0]) + M * H**2
    inertia = [base + M * x**2 for x in b]
    peak = [float(np.max(np.abs(one.samples[0, arcs[k] : arcs[k + 1], 0]))) for k in range(2)]
    rate, taken = 0.3, 0.0
    for k in range(2):
        old, new = b[k % 2], b[(k + 1) % 2]
        e = restitution(
            block, np.array([old]), np.array([new]), rate=np.array([rate]), previous_peak=np.array([peak[k]]),
            largest_peak=np.array([max(peak[: k + 1])]), impacts=np.array([float(k)]),
        )  # fmt: skip
        after = float(e[0]) * rate
        taken += 0.5 * (inertia[k % 2] * rate**2 - inertia[(k + 1) % 2] * after**2)
        rate = after
        short = Shaking.silence((arcs[k + 1] + 2) * 0.001, 0.001)
        lost = float(lanes.run(block, Request(short, np.ones(1), initial=start)).outputs["dissipated_energy"][0])
        assert lost == pytest.approx(taken, rel=2e-6)
