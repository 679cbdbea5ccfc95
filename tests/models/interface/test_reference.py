"""The full equations: energy, the written-out midpoint form, Housner's limit, rubber at one joint."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipk, ellipkinc

from models.interface import modes
from models.interface.reference import run as reference
from models.interface.reference.equation import Equation
from models.shaking import Shaking
from tests.models.interface.walls import SHORT, block_on_strip, random_wall, undamped, wall
from tests.models.requests import asked


def potential(equation: Equation, q: np.ndarray) -> float:
    """Of gravity and the relaxed layers (J)."""
    at, one = equation.kinematics(q, (0.0,) * 4), equation.wall
    weight = one.gravity * (one.mass_1 * at.centre_1[1] + one.mass_2 * at.centre_2[1])
    return float(weight + sum(equation.stored(q, equation.relaxed())))


@pytest.mark.parametrize("kinematics", ["toe_held", "midpoint_held"])
def test_free_rocking_without_dashpots_conserves_energy(kinematics: str) -> None:
    one = wall(undamped(SHORT), kinematics=kinematics)
    begun = {"rotation_1": 0.036, "rotation_2": 0.036}
    outcome = reference.run(one, asked(Shaking.silence(1.0, 0.01), initial=begun, duration=1.0))
    equation = Equation(one)
    energy = [equation.kinetic(s[:4], s[4:]) + potential(equation, s[:4]) for s in outcome.samples[0]]
    released = energy[0] - potential(equation, modes.static_state(one)[0])
    assert np.max(np.abs(np.array(energy) - energy[0])) < 1e-6 * released
    assert abs(outcome.outputs["dissipated_energy"]) < 1e-6 * released
    assert outcome.outputs["impacts"] >= 5


def test_the_midpoint_held_equations_are_the_written_out_ones() -> None:
    rng = np.random.default_rng(3)
    for _ in range(50):
        values = random_wall(rng)
        one = wall(values, kinematics="midpoint_held")
        p = one.one()
        q, v = rng.normal(0, [0.3, 0.3, 0.01, 0.01]), rng.normal(0, 1, 4)
        a, big_g = rng.normal(0, 3), 9.0
        (t1, t2, _, z2), (w1, w2, _, y2) = q, v
        lever = p.height_1 + p.top_thickness_in_height + z2
        s, d, m2, h2 = p.mass_1 * p.centre_1 + p.mass_2 * lever, t1 - t2, p.mass_2, p.centre_2
        both = p.mass_1 + m2
        mass = [
            [p.inertia_1 + p.mass_1 * p.centre_1**2 + m2 * lever**2, m2 * h2 * lever * np.cos(d), -s * np.sin(t1), 0],
            [0, p.inertia_2 + m2 * h2**2, -m2 * h2 * np.sin(t2), m2 * h2 * np.sin(d)],
            [0, 0, both, m2 * np.cos(t1)],
            [0, 0, 0, m2],
        ]
        mass = np.array(mass) + np.triu(mass, 1).T
        n = [
            m2 * h2 * lever * np.sin(d) * w2**2
            + 2 * m2 * lever * w1 * y2
            - big_g * s * np.sin(t1)
            + a * s * np.cos(t1),
            m2 * h2 * (-lever * np.sin(d) * w1**2 + 2 * np.cos(d) * w1 * y2 - big_g * np.sin(t2) + a * np.cos(t2)),
            -s * np.cos(t1) * w1**2 - m2 * h2 * np.cos(t2) * w2**2 - 2 * m2 * np.sin(t1) * w1 * y2 + both * big_g,
            m2 * (-lever * w1**2 - h2 * np.cos(d) * w2**2 + big_g * np.cos(t1) + a * np.sin(t1)),
        ]
        equation = Equation(one)
        base, top, _ = equation.strips(q, v, np.zeros(0))
        couple = top.moment * np.cos(t2 - t1)
        forces = [-base.moment * np.cos(t1) + couple, -couple, base.force, top.force]
        found_mass, found = equation.balance(q, v, a, big_g)
        np.testing.assert_allclose(found_mass, mass, atol=1e-9 * np.max(mass))
        np.testing.assert_allclose(found, np.array(forces) - n, rtol=1e-9, atol=1e-6)


STIFF = [
    ("toe_held", 1e8, 5.765), ("toe_held", 1e9, 1.704), ("toe_held", 1e10, 0.528),
    ("midpoint_held", 1e8, 3.827), ("midpoint_held", 1e9, -0.153), ("midpoint_held", 1e10, -1.305),
]  # fmt: skip


@pytest.mark.parametrize(("kinematics", "stiffness", "percent"), STIFF)
def test_quarter_period_of_one_block_on_a_stiffer_and_stiffer_strip(kinematics, stiffness, percent) -> None:
    one = wall(block_on_strip(stiffness), joints="base", kinematics=kinematics)
    alpha, b, h, g, m = np.arctan(0.25), 0.25, 1.0, 9.81, 1000.0
    start = 0.6 * alpha
    k = np.cos((alpha - start) / 2)
    p = np.sqrt(m * g * np.hypot(b, h) / (m * (0.5**2 + 2.0**2) / 12.0 + m * (b**2 + h**2)))
    housner = (ellipk(k**2) - ellipkinc(np.arcsin(np.cos(alpha / 2) / k), k**2)) / p
    lean = np.sin(start)
    z = lean * (b - np.sqrt(2.0 * m * g / (stiffness * lean)))
    equation = Equation(one)

    def derivative(_, y):
        second = equation.acceleration((y[0], y[0], y[1], 0.0), (y[2], y[2], y[3], 0.0), 0.0, g)
        return [y[2], y[3], second[0], second[2]]

    def upright(_, y):
        return y[0]

    upright.terminal = True
    found = solve_ivp(derivative, (0.0, 2.0), [start, z, 0.0, 0.0], "DOP853", events=upright, rtol=1e-8, atol=1e-12)
    assert 100.0 * (found.t[-1] / housner - 1.0) == pytest.approx(percent, abs=6e-4)


def test_a_bonded_joint_is_the_limit_of_a_stiff_one() -> None:
    base_only = {k: v for k, v in SHORT.items() if not k.startswith(("layer", "damping"))}
    base_only |= {"base_layer_thickness": 0.01, "base_stiffness": 6.21e7, "base_damping": 1e5}
    # the layer is thin, so that both walls are equally high
    stiff = {**base_only, "top_layer_thickness": 1e-9, "top_stiffness": 6.21e11, "top_damping": 1e7}
    bonded = modes.at_rest(wall(base_only, joints="base")).frequencies[0]
    limit = modes.at_rest(wall(stiff)).frequencies[0]
    np.testing.assert_allclose(limit[:2], bonded, rtol=2e-4)
