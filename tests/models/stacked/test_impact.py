"""Impacts: published numbers, energy, the limits of one body and of no body on top."""

from dataclasses import replace

import numpy as np
import pytest

from models.stacked.configuration import BASE, TOP, State
from models.stacked.model import MODEL
from models.stacked.reference.choice import candidates, margin
from models.stacked.reference.impact import closed, impact, impulses, kinetic_energy
from models.stacked.stack import Stack
from tests.models.stacked.walls import A, random_stacks

SINGLE = MODEL.build(A).one()


@pytest.mark.parametrize(
    ("joint", "sides", "opening", "rates", "expected_sides", "expected"),
    [
        (BASE, (1, 1), (0.0, 0.05), (-1.0, 0.5), (-1, 1), (-0.7872007, -0.52644442)),
        (BASE, (1, -1), (0.0, -0.03), (-1.0, -0.2), (-1, -1), (-0.96779452, 0.16873162)),
        (TOP, (1, 1), (0.04, 0.0), (0.3, -0.4), (1, -1), (0.24583152, -0.04916195)),
    ],
)
def test_published_impacts(
    joint: int,
    sides: tuple[int, int],
    opening: tuple[float, float],
    rates: tuple[float, float],
    expected_sides: tuple[int, int],
    expected: tuple[float, float],
) -> None:
    """theta_1', theta_2' after the impact, to the digits given."""
    after = impact(SINGLE, joint, State(sides, opening, (rates[0], rates[1] - rates[0])), False)
    assert after.sides == expected_sides
    assert after.rate[0] == pytest.approx(expected[0], abs=1e-8)
    assert after.rate[0] + after.rate[1] == pytest.approx(expected[1], abs=1e-8)


def test_products_of_the_impact_as_published() -> None:
    """C at theta = 0 for every pair of pivots before and after, in theta_1, theta_2."""
    s = SINGLE
    m1, m2, h1, h2, b1, b2 = s.mass_1, s.mass_2, s.centre_1, s.centre_2, s.base_pivot, s.top_pivot
    for s1, s2 in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        for n1, n2 in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
            before, after = s1 * b1 - s2 * b2, n1 * b1 - n2 * b2
            c11 = s.inertia_1 + m1 * (h1**2 + s1 * n1 * b1**2) + m2 * (4 * h1**2 + after * before)
            c12 = m2 * (2 * h1 * h2 + after * s2 * b2)
            c21 = m2 * (2 * h1 * h2 + n2 * b2 * before)
            c22 = s.inertia_2 + m2 * (h2**2 + s2 * n2 * b2**2)
            first, second = 0.7, -0.4
            found = impulses(s, State((s1, s2), (0.0, 0.0), (first, second - first)), False)(n1, n2)
            assert found.r1 - found.r2 == pytest.approx(c11 * first + c12 * second, rel=1e-12)
            assert found.r2 == pytest.approx(c21 * first + c22 * second, rel=1e-12)


def random_impacts(count: int) -> list[tuple[Stack, int, State]]:
    """Walls just before an impact, a third of them with the other joint closed."""
    rng = np.random.default_rng(11)
    many = random_stacks(rng, count)
    found = []
    for k in range(count):
        joint = int(rng.integers(2))
        sides = [int(s) for s in rng.choice([-1, 1], 2)]
        rate = rng.standard_normal(2)
        rate[joint] = -sides[joint] * abs(rate[joint])
        q = [0.0, 0.0]
        if rng.random() < 1 / 3:
            sides[1 - joint], rate[1 - joint] = 0, 0.0
        else:
            q[1 - joint] = sides[1 - joint] * float(rng.uniform(0.0, 0.3))
        found.append((many.one(k), joint, State((sides[0], sides[1]), (q[0], q[1]), (rate[0], rate[1]))))
    return found


IMPACTS = random_impacts(5000)


def test_energy_never_increases_and_one_target_is_consistent() -> None:
    for stack, joint, state in IMPACTS:
        system = impulses(stack, state, False)
        base, top = (0, state.sides[1]) if joint == BASE else (state.sides[0], 0)
        consistent = [pair for pair in candidates(base, top) if margin(system, base, top, *pair) > 0.0]
        after = impact(stack, joint, state, False)
        assert consistent == [after.sides]
        before = kinetic_energy(stack, state, False)
        assert kinetic_energy(stack, after, False) <= before * (1 + 1e-14)
        assert kinetic_energy(stack, closed(stack, joint, state, False), False) <= before * (1 + 1e-14)


@pytest.mark.parametrize("factor", [0.5, 0.9, 1.1])
@pytest.mark.parametrize("ratio", [np.nan, 0.0, 0.7, 1.0])
def test_given_restitution(factor: float, ratio: float) -> None:
    """The joint's rate is the one asked for unless energy would grow; then energy is kept."""
    kept = 0
    for stack, joint, state in IMPACTS[::10]:
        given = replace(stack, base_factor=factor, top_factor=factor, base_restitution=ratio, top_restitution=ratio)
        free = impact(stack, joint, state, False)
        after = impact(given, joint, state, False)
        wanted = factor * (free.rate[joint] if np.isnan(ratio) else ratio * state.rate[joint])
        before, left = kinetic_energy(stack, state, False), kinetic_energy(stack, after, False)
        assert left <= before * (1 + 1e-13)
        if after.rate[joint] != pytest.approx(wanted, rel=1e-12, abs=1e-300):
            assert abs(after.rate[joint]) < abs(wanted)
            assert left == pytest.approx(before, rel=1e-12)
        else:
            kept += 1
    assert kept > 50


def test_one_body_before_and_after_gives_its_own_restitution() -> None:
    """A flat block as long as the wall stays seated; theta' is multiplied by 1 - 2 M b^2/I_O."""
    wall = MODEL.build({**A, "top_length": 1.0, "top_height": 0.3})
    e = float(wall.momentum_restitution[0])
    b, mass = 0.5, 1500.0
    inertia = 1000 * (1 + 9) / 12 + 1000 * (1.5**2 + b**2) + 500 * (1 + 0.09) / 12 + 500 * (3.15**2 + b**2)
    assert e == pytest.approx(1 - 2 * mass * b**2 / inertia, rel=1e-15)
    after = impact(wall.one(), BASE, State((1, 0), (0.0, 0.0), (-1.0, 0.0)), False)
    assert after.sides == (-1, 0)
    assert after.rate[1] == 0.0
    assert after.rate[0] == pytest.approx(-e, abs=2e-16)


@pytest.mark.parametrize("sides", [(1, 1), (1, -1), (1, 0)])
def test_without_top_mass_the_wall_is_housners(sides: tuple[int, int]) -> None:
    """m2 -> 0: e = 1 - 1.5 sin^2(alpha) of the wall alone, whatever the upper block does."""
    wall = MODEL.build({**A, "top_mass": 1e-9}).one()
    e = 1 - 1.5 * 0.5**2 / (0.5**2 + 1.5**2)
    up = sides[1] * 0.02
    after = impact(wall, BASE, State(sides, (0.0, up), (-1.0, 0.3 * sides[1])), False)
    assert after.rate[0] == pytest.approx(-e, abs=1e-11)


def test_alone_on_an_unmoved_wall_the_upper_block_is_housners() -> None:
    """A very heavy wall: the upper block's e is its own."""
    wall = MODEL.build({**A, "wall_mass": 1e13}).one()
    e = 1 - 1.5 * 0.3**2 / (0.3**2 + 0.6**2)
    after = impact(wall, TOP, State((0, 1), (0.0, 0.0), (0.0, -1.0)), False)
    assert after.sides[1] == -1
    assert abs(after.rate[0]) < 1e-9
    assert after.rate[1] == pytest.approx(-e, abs=1e-9)
