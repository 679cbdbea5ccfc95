"""Forces at the ports of a model leave what mechanisms that are such forces leave; impulses turn the bodies."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import models
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import Fitted
from diagnosis.forces.columns import Forces, forces
from models.interface.layered import FREE
from models.interface.reference.equation import Equation
from models.shaking import Shaking
from tests.diagnosis import stacks, walls
from tests.diagnosis.made import SPECIMEN, TRUE, at_truth, recording

SMALL = {
    ("block", "viscous_damping"): "viscous_damping.rate",
    ("block", "coulomb_damping"): "coulomb_damping.over_m_g_b",
    ("block", "restitution"): "restitution.factor_on_housner",
    ("stack", "viscous_damping"): "viscous_damping.rate",
    ("stack", "coulomb_damping"): "coulomb_damping.over_m_g_b",
    ("wall", "viscous_damping"): "viscous_damping.couple_damping",
    ("wall", "coulomb_damping"): "coulomb_damping.over_m_g_b",
    ("wall", "stiffness"): "added_stiffness.couple_stiffness",
    ("wall", "viscous_damping_top"): "top_damping",
}
CHANGES = {
    "viscous_damping.rate": 1e-2, "restitution.factor_on_housner": -1e-3, "coulomb_damping.over_m_g_b": 2e-4,
    "viscous_damping.couple_damping": 1e3, "added_stiffness.couple_stiffness": 1e4, "top_damping": 5e3,
}  # fmt: skip


@cache
def about(which: str) -> tuple[Forces, dict[str, float]]:
    """Forces along the motion at the truth, and its values."""
    if which == "block":
        measured = measure(SPECIMEN, [recording("a", 1)])
        return forces(at_truth(measured)), TRUE
    if which == "stack":
        measured = measure(stacks.WALL, [stacks.recorded(1)])
        fitted = base_fit(stacks.WALL, measured)
        return forces(fitted), dict(fitted.point.values)
    measured = measure(walls.WALL, [walls.recorded(1)])
    misfit = walls.misfit(measured)
    u = np.array([x.coordinate(walls.TRUE[x.name]) for x in misfit.unknowns])
    window = np.zeros(len(measured.windows))
    return forces(Fitted(misfit, u, measured.states, window, 0.0)), walls.TRUE


@pytest.mark.parametrize(("which", "kind"), list(SMALL))
def test_a_force_leaves_what_the_mechanism_that_is_this_force_leaves(which: str, kind: str) -> None:
    """But a factor: a little of the mechanism against the sum of the impulses along the motion."""
    found, values = about(which)
    m, name = found.fitted.measured, SMALL[which, kind]
    null = 1.0 if name.startswith("restitution") else values.get(name, 0.0)
    if name == "coulomb_damping.over_m_g_b":  # which way dry friction acts where nothing moves is a law of its own
        null = CHANGES[name]
    points = [Point({**found.fitted.point.values, name: null + c}, m.states) for c in (0.0, CHANGES[name])]
    plain, more = Predictor(m).predict(points)
    (force,) = (one for one in found.kinds if one.name == kind)
    followed = found.events.followed >= [window.samples for window in m.windows]  # a small change leaves a small one
    assert followed.sum() >= 5
    expected, column = (np.where(m.mask, x, 0.0)[followed].ravel() for x in (more - plain, found.predicted(force)))
    assert expected @ column > 0.99 * np.sqrt((expected @ expected) * (column @ column))


@pytest.mark.parametrize("joints", ["both", "base", "top"])
def test_an_impulse_turns_both_bodies_of_a_wall_as_their_mass_has_it(joints: str) -> None:
    """M(0) q'' of the full equations, the layers free, is the generalised force of each port on what is not bonded."""
    model = models.get("interface")
    wall = model.build(walls.TRUE, {"joints": joints})
    free = FREE[joints] * [[1.0], [1.0], [0.0], [0.0]]
    equation = Equation(wall)
    at = equation.kinematics((0.0,) * 4, (0.0,) * 4)
    mass = equation.mass(at)
    wanted = {"base": (1.0, 0.0, 0.0, 0.0), "top": (-1.0, 1.0, 0.0, 0.0), "block": at.jacobian_2[0]}
    ports = {kind.port.name: kind.port for kind in model.identification.forces}
    assert set(ports) == set(wanted)
    for name, port in ports.items():
        jumps = port.jumps(wall, {})
        rates = np.array([jumps["rotation_rate_1"], jumps["rotation_rate_2"], 0.0, 0.0])
        force = np.array(wanted[name])
        np.testing.assert_allclose(free.T @ mass @ rates, -free.T @ force, atol=1e-9 * max(np.abs(force)))
        np.testing.assert_allclose(free @ np.linalg.pinv(free) @ rates, rates, atol=1e-12 * max(np.abs(rates)))


STACK = {"wall_length": 0.6, "wall_height": 2.0, **stacks.REST}
MOMENTS = {
    "both open": (0.02, 0.05), "to opposite sides": (0.02, -0.01), "as one body": (0.02, 0.02),
    "the block alone": (0.0, -0.03),
}  # fmt: skip


def stack_jumps(name: str, theta: tuple[float, float], values: dict[str, float] = STACK) -> np.ndarray:
    model = models.get("stacked")
    ports = {kind.port.name: kind.port for kind in model.identification.forces}
    assert set(ports) == {"base", "top", "block"}
    at = {"rotation_1": np.array([theta[0]]), "rotation_2": np.array([theta[1]])}
    jumps = ports[name].jumps(model.build(values), at)
    return np.array([np.ravel(jumps["rotation_rate_1"])[0], np.ravel(jumps["rotation_rate_2"])[0]])


@pytest.mark.parametrize("moment", ["both open", "to opposite sides"])
def test_a_short_pulse_of_the_base_moves_a_stack_as_a_force_on_its_block(moment: str) -> None:
    """Under a wall without mass the base pushes the block alone: m2 a over the time of the pulse, as the model runs."""
    theta, model = MOMENTS[moment], models.get("stacked")
    light = {**STACK, "wall_mass": 1e-6}
    step, peak = 1e-5, 500.0
    start = dict(zip(("rotation_1", "rotation_2"), theta, strict=True))

    def rates(a: float) -> np.ndarray:
        pulse = Shaking(step, np.array([0.0, a, 0.0]))
        ran = model.simulate(light, pulse, initial=start, duration=2 * step, integrator="reference").channels
        return np.array([ran[f"rotation_rate_{k}"].ravel()[-1] for k in (1, 2)])

    expected = (rates(peak) - rates(0.0)) / (light["top_mass"] * peak * step)
    np.testing.assert_allclose(stack_jumps("block", theta, light), expected, rtol=1e-3, atol=1e-3 * max(abs(expected)))


def test_a_couple_in_the_one_joint_that_is_open_turns_what_stands_on_it() -> None:
    """As one body about its corner, 1/I_O; the block about its own, 1/(I_2 + m_2 (b_2^2 + h_2^2))."""
    stack = models.get("stacked").build(STACK)
    whole = float(stack.corner_inertia(1.0).item())
    np.testing.assert_allclose(stack_jumps("base", MOMENTS["as one body"]), [-1.0 / whole] * 2, rtol=1e-12)
    alone = float((stack.inertia_2 + stack.mass_2 * (stack.top_pivot**2 + stack.centre_2**2)).item())
    np.testing.assert_allclose(stack_jumps("top", MOMENTS["the block alone"]), [0.0, -1.0 / alone], rtol=1e-12)


def test_of_two_open_joints_either_answers_to_the_other_alike() -> None:
    """M is symmetric: the rate at which the base opens by a couple in the top joint, and the other way round."""
    for moment in ("both open", "to opposite sides"):
        lower, upper = stack_jumps("base", MOMENTS[moment])
        assert lower < 0.0 and upper - lower == pytest.approx(stack_jumps("top", MOMENTS[moment])[0], rel=1e-12)


def test_what_is_closed_stays_closed() -> None:
    for name in ("base", "top", "block"):
        lower, upper = stack_jumps(name, MOMENTS["as one body"])
        assert lower == pytest.approx(upper, abs=1e-15)
        assert stack_jumps(name, MOMENTS["the block alone"])[0] == 0.0
        np.testing.assert_array_equal(stack_jumps(name, (0.0, 0.0)), [0.0, 0.0])
