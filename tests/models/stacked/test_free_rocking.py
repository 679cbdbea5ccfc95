"""Motion between and across events: energy, symmetry, and the limits of one body."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from models.housner.model import MODEL as HOUSNER
from models.runs import Request
from models.shaking import Shaking
from models.stacked.configuration import CONFIGURATIONS, State
from models.stacked.equation import held, motion
from models.stacked.model import MODEL
from models.stacked.reference import run as reference
from models.stacked.reference.overturning import energy
from tests.models.stacked.walls import LANES, A, B, G, random_stacks
from tests.models.strategies import random_motion

STARTS = ((B, 0.05, 0.05), (B, 0.0, 0.1), (B, 0.05, -0.07), (A, 0.08, 0.2), (A, -0.1, -0.1), (A, 0.02, -0.3))
"""Walls with theta_1 and theta_2 at release."""


def released(values: dict[str, float], theta_1: float, theta_2: float) -> float:
    """Energy above that of rest, in J."""
    stack = MODEL.build(values).one()
    start = State((int(np.sign(theta_1)), int(np.sign(theta_2 - theta_1))), (theta_1, theta_2 - theta_1), (0.0, 0.0))
    still = State((0, 0), (0.0, 0.0), (0.0, 0.0))
    return energy(stack, start, (0.0, G)) - energy(stack, still, (0.0, G))


@pytest.mark.parametrize("sides", CONFIGURATIONS[:-1])
def test_energy_is_kept_between_events(sides: tuple[int, int]) -> None:
    """Every configuration of a random stack under gravity and a constant acceleration, without its events."""
    stack = random_stacks(np.random.default_rng(3), 1).one()
    ground = (0.7, G)

    def derivative(_: float, y: np.ndarray) -> list[float]:
        state = State(sides, (y[0], y[1]), (y[2], y[3]))
        return [y[2], y[3], *held(motion(stack, *state.corners, state.q, state.rate, (*ground, 0.0), False), *sides)]

    start = np.array([0.05 * sides[0], 0.1 * sides[1], -0.3 * abs(sides[0]), 0.9 * abs(sides[1])])
    run = solve_ivp(derivative, (0.0, 0.5), start, "DOP853", rtol=1e-12, atol=1e-13)
    ends = [energy(stack, State(sides, (y[0], y[1]), (y[2], y[3])), ground) for y in run.y.T[[0, -1]]]
    assert np.abs(run.y[:, -1] - start).max() > 0.05
    assert ends[1] == pytest.approx(ends[0], rel=1e-11)


@pytest.mark.parametrize(("values", "theta_1", "theta_2"), STARTS)
@pytest.mark.parametrize("integrator", LANES)
def test_all_energy_is_lost_when_the_stack_is_at_rest(
    integrator: str, values: dict[str, float], theta_1: float, theta_2: float
) -> None:
    """What the impacts take, one by one, adds up to the energy released."""
    initial = {"rotation_1": theta_1, "rotation_2": theta_2}
    run = MODEL.simulate(values, Shaking.silence(25.0, 0.005), initial=initial, integrator=integrator)
    assert run.events[-1].kind == "rest"
    assert run.outputs["dissipated_energy"] == pytest.approx(released(values, theta_1, theta_2), rel=1e-8)
    assert run.outputs["residual_rotation"] == 0.0
    impacts = [event for event in run.events if event.kind == "impact"]
    assert len(impacts) == run.outputs["impacts_base"] + run.outputs["impacts_top"]


@pytest.mark.parametrize("integrator", LANES)
def test_mirrored_shaking_gives_the_mirrored_response(integrator: str) -> None:
    shaking = random_motion(np.random.default_rng(4), duration=6.0, vertical=True)
    left = Shaking(shaking.time_step, -shaking.horizontal, shaking.vertical)
    there, back = (MODEL.simulate(B, s, scale=2.5, tail=2.0, integrator=integrator) for s in (shaking, left))
    assert there.outputs["uplift_duration_top"] > 0.1
    for name in ("rotation_1", "rotation_2"):
        # closed joints are written about the right corner, so that roundings differ and impacts amplify them
        np.testing.assert_allclose(there.channels[name], -back.channels[name], atol=1e-7)


@pytest.mark.parametrize("integrator", LANES)
def test_a_seated_top_block_makes_one_body(integrator: str) -> None:
    """A flat block as long as the wall never opens: Housner's block with a mass on top."""
    values = {**A, "wall_length": 0.6, "top_height": 0.2}
    one = {
        "width": 0.6, "height": 3.0, "mass": 1000.0, "gravity": G, "top_mass": 500.0, "top_mass_height": 0.1,
        "top_mass_inertia": 500.0 * (0.6**2 + 0.2**2) / 12,
    }  # fmt: skip
    shaking = random_motion(np.random.default_rng(9), duration=8.0)
    stacked = MODEL.simulate(values, shaking, scale=3.0, tail=2.0, integrator=integrator)
    block = HOUSNER.simulate(one, shaking, scale=3.0, tail=2.0, integrator="reference")
    assert stacked.outputs["configurations"] == sum(
        1 << CONFIGURATIONS.index(sides) for sides in ((0, 0), (1, 0), (-1, 0))
    )
    assert stacked.outputs["impacts_base"] == block.outputs["impacts"] >= 4
    for name in ("onset_time", "uplift_duration", "dissipated_energy", "peak_rotation_ratio", "friction_demand"):
        here = f"{name}_base" if f"{name}_base" in stacked.outputs else f"{name}_1"
        assert stacked.outputs[here] == pytest.approx(block.outputs[name], rel=2e-5), name
    np.testing.assert_array_equal(stacked.channels["rotation_1"], stacked.channels["rotation_2"])
    np.testing.assert_allclose(stacked.channels["rotation_1"], block.channels["rotation_1"], atol=1e-7)


@pytest.mark.parametrize("integrator", LANES)
def test_without_top_mass_the_wall_is_housners_block(integrator: str) -> None:
    """m2 -> 0: the wall moves as if alone, whatever the upper block does on it."""
    shaking = random_motion(np.random.default_rng(6), duration=8.0, vertical=False)
    values = {**A, "wall_length": 0.5, "top_mass": 1e-7, "top_length": 0.5, "top_height": 0.3}
    one = {"width": 0.5, "height": 3.0, "mass": 1000.0, "gravity": G}
    stacked = MODEL.simulate(values, shaking, scale=2.2, tail=2.0, integrator=integrator)
    block = HOUSNER.simulate(one, shaking, scale=2.2, tail=2.0, integrator="reference")
    assert block.outputs["impacts"] >= 4
    np.testing.assert_allclose(stacked.channels["rotation_1"], block.channels["rotation_1"], atol=1e-6)


def test_the_linear_formulation_is_the_limit_of_small_rotations() -> None:
    """Half as slender and half as far released: a quarter of the relative difference."""
    apart = []
    for slender in (0.1, 0.05):
        stack = MODEL.build({**B, "wall_length": slender, "top_length": 0.6 * slender})
        alpha = float(stack.slenderness[0])
        start = {"rotation_1": np.array([0.3 * alpha]), "rotation_2": np.array([-0.2 * alpha])}
        plain, linear = (
            reference.run(stack, Request(Shaking.silence(0.6, 0.005), np.ones(1), {"formulation": word}, initial=start))
            for word in MODEL.options["formulation"]
        )
        assert len(plain.events[0]) >= 2
        apart.append(np.abs(plain.samples[..., :2] - linear.samples[..., :2]).max() / alpha)
    assert apart[0] < 1e-2
    assert apart[0] / apart[1] == pytest.approx(4.0, rel=0.1)
