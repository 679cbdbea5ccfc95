"""Forces at the ports of a model leave what mechanisms that are such forces leave; impulses turn the bodies."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import models
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import measure
from diagnosis.fit.solver import Fitted
from diagnosis.forces.columns import Forces, forces
from models.interface.layered import FREE
from models.interface.reference.equation import Equation
from tests.diagnosis.fit import test_walls as walls
from tests.diagnosis.forces.test_scan import _fitted
from tests.diagnosis.made import SPECIMEN, TRUE, recording

SMALL = {
    ("block", "viscous_damping"): "viscous_damping.rate",
    ("block", "coulomb_damping"): "coulomb_damping.over_m_g_b",
    ("block", "restitution"): "restitution.factor_on_housner",
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
        return forces(_fitted(measured, measured.values)), TRUE
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
        jumps = port.jumps(wall)
        rates = np.array([jumps["rotation_rate_1"], jumps["rotation_rate_2"], 0.0, 0.0])
        force = np.array(wanted[name])
        np.testing.assert_allclose(free.T @ mass @ rates, -free.T @ force, atol=1e-9 * max(np.abs(force)))
        np.testing.assert_allclose(free @ np.linalg.pinv(free) @ rates, rates, atol=1e-12 * max(np.abs(rates)))
