"""Rest, natural frequencies and the linear matrices against the numbers and the full equations."""

import numpy as np
import pytest

from models.interface import modes
from models.interface.reference.equation import Equation
from models.rubber import LAWS
from models.rubber.base import RubberLaw
from tests.models.interface.walls import LONG, MODEL, SHORT, block_on_strip, random_wall, wall

STRONG = {
    "hardening": {"hardening.beta2": 20.0},
    "locking": {"locking.lock_strain": 0.7},
    "maxwell": {"maxwell.arm_stiffness_ratio": 0.5, "maxwell.relaxation_time": 0.05},
    "bouc_wen": {"bouc_wen.post_yield_ratio": 0.4, "bouc_wen.yield_compression": 2e-3, "bouc_wen.exponent": 2.0},
    "mullins": {"mullins.softening": 0.3, "mullins.strain": 0.1},
    "permanent_set": {"permanent_set.rate": 2.0, "permanent_set.strain_limit": 0.3},
}
"""Numbers of each law that show at rest."""
FREQUENCIES = (
    (SHORT, (1.35130, 6.38983, 10.59931, 119.10733), 5e-6),
    (LONG, (6.3723, 17.5377, 29.4294, 119.975), 5e-5),
)


@pytest.mark.parametrize(("values", "expected", "digit"), FREQUENCIES)
def test_frequencies_of_the_illustrative_walls(values, expected, digit) -> None:
    found = modes.at_rest(wall(values)).frequencies[0]
    np.testing.assert_allclose(found[:3], expected[:3], rtol=0, atol=1.01 * digit)
    assert found[3] == pytest.approx(expected[3], abs=6e-4)
    assert MODEL.derive(values)["frequency_1"][0] == found[0]


@pytest.mark.parametrize(
    ("values", "expected"),
    [(SHORT, (1.3507, 6.3889, 10.5993, 119.107)), (LONG, (6.3713, 17.5377, 29.4280, 119.975))],
)
def test_frequencies_with_the_unstressed_height(values, expected) -> None:
    one = wall(values)
    lever = one.height_1 + one.top_thickness_in_height
    stiffness = modes.layer_matrix(one, one.base_stiffness, one.top_stiffness) - modes.gravity_matrix(one, lever)
    found = modes.modes(one, modes.mass_matrix(one, lever), stiffness).frequencies[0]
    assert np.all(np.abs(found - expected) < [6e-5, 6e-5, 6e-5, 6e-4])


def test_static_state_and_uplift_rotation_of_the_short_wall() -> None:
    one = wall(SHORT)
    rest = modes.static_state(one)[0]
    np.testing.assert_allclose(rest * 1e3, [0.0, 0.0, -1.1323, -1.0970], rtol=0, atol=6e-5)
    assert float(one.base_stiffness[0]) == pytest.approx(6.21e7, rel=1e-12)
    assert MODEL.derive(SHORT)["uplift_rotation"][0] == pytest.approx(3.145e-3, abs=6e-7)


@pytest.mark.parametrize("kinematics", ["toe_held", "midpoint_held"])
def test_at_rest_nothing_is_left_over(kinematics: str) -> None:
    rng = np.random.default_rng(7)
    for _ in range(20):
        one = wall(random_wall(rng), kinematics=kinematics)
        _, force = Equation(one).balance(modes.static_state(one)[0], (0.0,) * 4, 0.0, float(one.gravity[0]))
        assert np.max(np.abs(force)) < 1e-9 * float(one.mass[0] * one.gravity[0])


@pytest.mark.parametrize("kinematics", ["toe_held", "midpoint_held"])
@pytest.mark.parametrize("values", [SHORT, LONG])
def test_the_linear_matrices_are_the_jacobians_of_the_full_equations(values, kinematics: str) -> None:
    one = wall(values, kinematics=kinematics)
    equation, rest, g = Equation(one), modes.static_state(one)[0], float(one.gravity[0])
    lever = one.height_1 + one.top_thickness_in_height + rest[3]
    stiffness = modes.layer_matrix(one, one.base_stiffness, one.top_stiffness) - modes.gravity_matrix(one, lever)
    damping = modes.layer_matrix(one, one.base_damping, one.top_damping)

    def forces(q, v):
        return equation.balance(rest + q, v, 0.0, g)[1]

    def slope(function, j: int, size: float):
        """Central differences extrapolated to size 0; a held toe adds terms like theta |theta|, of odd order too."""
        step = np.zeros(4)
        step[j] = size
        coarse, middle, fine = ((function(step / n) - function(-step / n)) * n / (2 * size) for n in (1, 2, 4))
        return (8 * fine - 6 * middle + coarse) / 3

    still = np.zeros(4)
    by_place = -np.column_stack([slope(lambda q: forces(q, still), j, 1e-4) for j in range(4)])
    by_rate = -np.column_stack([slope(lambda v: forces(still, v), j, 1e-4) for j in range(4)])
    assert np.max(np.abs(by_place - stiffness[0])) < 1.6e-12 * np.max(stiffness)
    assert np.max(np.abs(by_rate - damping[0])) < 1e-9 * np.max(damping)
    np.testing.assert_allclose(
        equation.mass(equation.kinematics(rest, still)), modes.mass_matrix(one, lever)[0], rtol=1e-13
    )


def held(rest: float, u: np.ndarray, law: RubberLaw, p: dict) -> np.ndarray:
    """The hidden state at u after an elastic change from rest: what has flowed in the rubber is held."""
    if law.name == "maxwell":  # h = u - v, v held
        return u - rest
    if law.name == "bouc_wen":  # u - zeta held
        return law.relaxed(np.array([rest]), p) + (u - rest)
    # Mullins: a little more than at rest, so that neither side of a small turn exceeds it
    return np.full_like(u, rest * (1 + 1e-6)) if law.name == "mullins" else np.zeros_like(u)


@pytest.mark.parametrize("joints", ["both", "base"])
@pytest.mark.parametrize("name", LAWS)
def test_frequencies_are_those_of_the_jacobian_with_the_flow_held(name: str, joints: str) -> None:
    """Of the full nonlinear equations at the law's own static state; under the linear law they differ."""
    one = wall({**SHORT, "top_layer_modulus": 6e6, "base_layer_modulus": 4.95e6, **STRONG[name]}, joints=joints)
    equation, rest = Equation(one), modes.static_state(one)[0]

    def force(q: np.ndarray) -> np.ndarray:
        hidden = []
        for joint, z, angle, compressed in (("base", q[2], q[0], -rest[2]), ("top", q[3], q[1] - q[0], -rest[3])):
            if joint in equation.fibres:
                fibres = equation.fibres[joint]
                u = fibres.x[0] * np.sin(angle) - z
                hidden += [held(compressed, u, law, p) for law, p in one.laws_at(joint) if law.hidden]
        strips = equation.strips(q, np.zeros(4), np.concatenate(hidden) if hidden else np.zeros(0))[:2]
        return equation.balance(q, np.zeros(4), 0.0, float(one.gravity[0]), strips)[1]

    free = equation.free
    sizes = 1e-10 / np.array([0.36, 0.36, 1.0, 1.0])[:, None] * free
    slope = np.column_stack([(force(rest + d) - force(rest - d)) / 2 for d in sizes.T]) / np.max(sizes, axis=0)
    mass = free.T @ equation.mass(equation.kinematics(rest, np.zeros(4))) @ free
    squares = np.sort(np.linalg.eigvals(np.linalg.solve(mass, -free.T @ slope)).real)
    np.testing.assert_allclose(modes.at_rest(one).squares[0], squares, rtol=1e-4)
    plain = modes.at_rest(wall({**SHORT, "top_layer_modulus": 6e6, "base_layer_modulus": 4.95e6}, joints=joints))
    if name in ("hardening", "locking", "maxwell", "mullins"):  # the others unload along k, and at the very top only
        assert abs(modes.at_rest(one).squares[0, 0] / plain.squares[0, 0] - 1.0) > 0.05


@pytest.mark.parametrize("name", LAWS)
def test_uplift_rotation_is_where_a_base_turned_slowly_lifts(name: str) -> None:
    """Turned in small steps under its weight, with the history of 400 fibres followed; the last open end tells."""
    one = wall({**SHORT, **STRONG[name]})
    layer, b, k = one.layer("base"), float(one.base_half_width[0]), float(one.base_stiffness[0])
    weight, z = float(one.mass[0] * one.gravity[0]), float(modes.static_state(one)[0, 2])
    x = ((np.arange(400) + 0.5) / 200 - 1) * b
    u = np.full(400, -z)
    h, theta = layer.relaxed(u), 0.0
    while z + b * theta < 0.0:
        theta += 2e-6
        for _ in range(3):  # the middle sinks until the weight is carried
            new = np.maximum(x * theta - z, 0.0)
            # slow, without creep
            rates = layer.rates(u, new - u, h)
            moved = h if name in ("maxwell", "permanent_set") else [h[0] + rates[0]]
            stress = np.maximum(layer.stress(new, moved), 0.0)
            z += (np.sum(stress) * 2 * b / 400 - weight) / (2 * b * k)
        u, h = new, moved
    values = {**SHORT, **STRONG[name]}
    assert MODEL.derive(values)["uplift_rotation"][0] == pytest.approx(theta, rel=4e-3)
    assert MODEL.derive(values)["static_compression_base"][0] == -float(modes.static_state(one)[0, 2])


def test_what_a_bonded_joint_leaves_out() -> None:
    found = MODEL.derive(SHORT, {"joints": "top"})
    assert np.isnan(found["uplift_rotation"][0])
    assert str(found["static_compression_base"][0]) == "0.0"


def test_full_contact_frequencies_of_one_block() -> None:
    b, h, m, k = 0.25, 1.0, 1000.0, 1e8
    found = modes.at_rest(wall(block_on_strip(k), joints="base")).squares[0]
    inertia = m * (0.5**2 + 2.0**2) / 12.0
    turning = ((2.0 / 3.0) * k * b**3 - m * 9.81 * h) / (inertia + m * h**2)
    np.testing.assert_allclose(found, sorted([turning, 2.0 * k * b / m]), rtol=1e-12)


def test_shapes_diagonalise_and_damping_ratios_are_modal() -> None:
    one = wall(SHORT)
    found = modes.at_rest(one)
    lever = one.height_1 + one.top_thickness_in_height + modes.static_state(one)[:, 3]
    mass = modes.mass_matrix(one, lever)[0]
    product = found.shapes[0].T @ mass @ found.shapes[0]
    scale = np.sqrt(np.outer(np.diag(product), np.diag(product)))
    np.testing.assert_allclose((product / scale) - np.eye(4), 0.0, atol=1e-10)
    # proportional dashpots and stiffness, gravity apart: xi_n = c/(2 k) omega_n for the axial modes
    ratio = float(one.base_damping[0] / one.base_stiffness[0]) / 2.0
    np.testing.assert_allclose(found.damping[0, 2:], ratio * np.sqrt(found.squares[0, 2:]), rtol=1e-9)
