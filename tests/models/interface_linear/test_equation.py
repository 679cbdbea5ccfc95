"""The corrected matrices: against the full model's Jacobian, the exact strip, and the printed form."""

import numpy as np
import pytest

from models.interface import modes
from models.interface.reference.equation import Equation
from models.interface.strip import strip
from models.interface_linear import equation
from tests.models.interface.walls import LONG, MODEL, SHORT, random_wall
from tests.models.interface.walls import wall as full_wall
from tests.models.interface_linear.walls import wall


@pytest.mark.parametrize("values", [SHORT, LONG])
def test_full_contact_is_the_jacobian_of_the_full_model_at_rest(values) -> None:
    one = wall(values)
    full = Equation(full_wall(values, kinematics="midpoint_held", dashpot="A"))
    rest, g = modes.static_state(one)[0], float(one.gravity[0])
    mass, damping, stiffness = (m[0] for m in equation.matrices(one, (0, 0), equation.lever(one) + rest[3]))

    def slope(function, j: int):
        """Central differences extrapolated to size 0."""
        step = np.zeros(4)
        step[j] = 1e-4
        coarse, middle, fine = ((function(step / n) - function(-step / n)) * n / 2e-4 for n in (1, 2, 4))
        return (8 * fine - 6 * middle + coarse) / 3

    still = np.zeros(4)
    by_place = [slope(lambda q: full.balance(rest + q, still, 0.0, g)[1], j) for j in range(4)]
    by_rate = [slope(lambda v: full.balance(rest, v, 0.0, g)[1], j) for j in range(4)]
    assert np.max(np.abs(np.column_stack(by_place) + stiffness)) < 1.6e-12 * np.max(stiffness)
    assert np.max(np.abs(np.column_stack(by_rate) + damping)) < 1e-9 * np.max(damping)
    np.testing.assert_allclose(full.mass(full.kinematics(rest, still)), mass, rtol=1e-13)
    # the load: what a horizontal acceleration does to the full model at rest
    load = full.balance(rest, still, 1.0, g)[1]
    height = equation.lever(one)
    shift = np.array([float(one.mass_2[0]) * rest[3], 0.0, 0.0, 0.0])
    np.testing.assert_allclose(equation.loads(one)[0, :, 0], load + shift, rtol=1e-12, atol=1e-9 * height[0])


@pytest.mark.parametrize("values", [SHORT, LONG])
def test_frequencies_with_the_unstressed_height(values) -> None:
    expected = (1.3507, 6.3889, 10.5993, 119.107) if values is SHORT else (6.3713, 17.5377, 29.4280, 119.975)
    one = wall(values)
    derived = modes.derived(one, equation.at_rest(one), equation.rest(one))
    found = [derived[f"frequency_{k}"][0] for k in range(1, 5)]
    assert np.all(np.abs(np.array(found) - expected) < [6e-5, 6e-5, 6e-5, 6e-4])


def strips_of(one, q, v, joint: int, low: float, high: float) -> np.ndarray:
    """Generalised force of the fibres of [low, high] of one joint, each fibre -(k w + c w') by quadrature."""
    nodes, weights = np.polynomial.legendre.leggauss(6)
    x = 0.5 * (low + high) + 0.5 * (high - low) * nodes
    weights = 0.5 * (high - low) * weights
    k, c = ((one.base_stiffness, one.base_damping), (one.top_stiffness, one.top_damping))[joint]
    turn, z = equation.joint_axes(joint)
    force = np.zeros(4)
    for place, weight in zip(x, weights, strict=True):
        w = z - place * turn
        force -= weight * (k[0] * (w @ q) + c[0] * (w @ v)) * w
    return force


@pytest.mark.parametrize("joint", [0, 1])
@pytest.mark.parametrize("side", [1, -1])
def test_half_contact_is_the_sum_of_the_fibres_of_that_half(joint: int, side: int) -> None:
    rng = np.random.default_rng(3)
    for _ in range(10):
        one = wall(random_wall(rng))
        b = float(equation.half_width(one, joint)[0])
        q, v = rng.normal(size=4) * 1e-3, rng.normal(size=4) * 1e-2
        sides = (side, 0) if joint == 0 else (0, side)
        other = float(equation.half_width(one, 1 - joint)[0])
        low, high = (0.0, b) if side > 0 else (-b, 0.0)
        expected = strips_of(one, q, v, joint, low, high) + strips_of(one, q, v, 1 - joint, -other, other)
        _, damping, stiffness = (m[0] for m in equation.matrices(one, sides))
        found = -(stiffness + modes.gravity_matrix(one, equation.lever(one))[0]) @ q - damping @ v
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * np.max(np.abs(expected)))


@pytest.mark.parametrize("side", [1, -1])
def test_the_jump_at_the_switch(side: int) -> None:
    """A quarter of the force and of the moment, an eighth of the energy: errata item 9."""
    one = wall(SHORT)
    b = float(one.base_half_width[0])
    turn = side * 3e-3
    q = np.array([turn, turn, -b * abs(turn), 0.0])
    lift = modes.gravity_matrix(one, equation.lever(one))[0]
    full, half = ((equation.matrices(one, (s, 0))[2][0] + lift) @ q for s in (0, side))
    assert half[2] == pytest.approx(0.75 * full[2], rel=1e-12)
    assert half[0] == pytest.approx(1.25 * full[0], rel=1e-12)
    assert q @ half == pytest.approx(0.875 * (q @ full), rel=1e-12)
    expected = strip(b, float(one.base_stiffness[0]), 0.0, float(q[2]), turn)
    assert -full[2] == pytest.approx(expected.force, rel=1e-12)
    assert full[0] == pytest.approx(expected.moment, rel=1e-12)
    sigma = equation.strain_rows(one, 0, side)[0, :4] @ q
    np.testing.assert_allclose(full - half, sigma * equation.jump(one, 0, side)[0], atol=1e-9 * abs(full[2]))


def test_the_printed_sign_drives_a_wall_that_leans_to_the_left() -> None:
    """Errata item 6: in static half contact under the weight, the printed coupling turns the moment around."""
    one = wall(SHORT)
    b, k, weight = (float(x[0]) for x in (one.base_half_width, one.base_stiffness, one.mass * one.gravity))
    lift = modes.gravity_matrix(one, equation.lever(one))[0]
    moments = {}
    for turn, printed in ((5e-3, 1), (-5e-3, -1), (-5e-3, 1)):
        # z from the vertical balance of the matrix itself
        layers = equation.matrices(one, (printed, 0))[2][0] + lift
        z = -(weight + layers[2, 0] * turn) / layers[2, 2]
        moments[turn, printed] = float(layers[0] @ [turn, turn, z, 0.0])
    right = weight * b / 2.0 + k * b**3 / 12.0 * 5e-3
    assert moments[5e-3, 1] == pytest.approx(right, rel=1e-12)
    assert moments[-5e-3, -1] == pytest.approx(-right, rel=1e-12)
    # restoring for a lean to the left is negative; the print pushes the wall on
    assert moments[-5e-3, 1] == pytest.approx(weight * b / 2.0 - k * b**3 / 12.0 * 5e-3, rel=1e-12)
    assert moments[-5e-3, 1] > 0.0


def test_a_held_joint_stays_at_the_switch_between_full_and_half_force() -> None:
    rng = np.random.default_rng(5)
    one = wall(random_wall(rng))
    rows = equation.systems(one)[0]
    for joint, state in ((0, equation.HELD_RIGHT), (0, equation.HELD_LEFT), (1, equation.HELD_RIGHT)):
        side = equation.SIDE[state]
        half = equation.HALF_RIGHT if side > 0 else equation.HALF_LEFT
        held, full, part = (equation.STATES * s if joint == 0 else s for s in (state, equation.FULL, half))
        gap = equation.gap(one, joint, side)[0]
        turn = side * 2e-3
        q, v = np.zeros(4), np.zeros(4)
        q[joint], v[joint] = turn, 0.3 * turn
        for x in (q, v):
            x[2 + joint] = -gap[joint] * x[joint] / gap[2 + joint]
        y = np.concatenate([q, v, [0.4, float(one.gravity[0])]])
        in_full, in_half, in_held = (rows[c, :4] @ y for c in (full, part, held))
        assert abs(gap @ in_held) < 1e-12 * max(abs(gap @ in_full), abs(gap @ in_half))
        share = (gap @ in_full) / (gap @ in_full - gap @ in_half)
        np.testing.assert_allclose(in_held, in_full + share * (in_half - in_full), atol=1e-9 * np.max(np.abs(in_full)))
        # mu = share sigma: the watched values tell where the share leaves [0, 1]
        sigma = equation.strain_rows(one, joint, side)[0] @ y / equation.sizes(one)[1][0, joint]
        watched = rows[held, equation.WATCH + 2 * joint : equation.WATCH + 2 * joint + 2] @ y
        np.testing.assert_allclose(watched, [-share * sigma, (share - 1.0) * sigma], atol=1e-12 * abs(sigma))


def test_options_and_mechanisms_are_few() -> None:
    linear = wall(SHORT, "base")
    assert not linear.clip and not linear.toe_held
    from tests.models.interface_linear.walls import MODEL as LINEAR

    assert set(LINEAR.options) == {"joints"} and set(MODEL.options) > {"joints"}
    assert set(LINEAR.mechanisms) == {"pivot_inset", "tilt", "vertical_acceleration"}
