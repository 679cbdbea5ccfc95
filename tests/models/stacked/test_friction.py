"""Dry friction between wall and base: onset, hold and release, its work, the limit of one block."""

import numpy as np
import pytest

import models
from models.runs import Request
from models.shaking import Shaking
from models.stacked.configuration import State
from models.stacked.equation import Rotations, System, motion
from models.stacked.lanes import run as lanes
from models.stacked.model import MODEL
from models.stacked.reference import run as reference
from models.stacked.reference.choice import candidates, margin
from models.stacked.reference.overturning import energy
from tests.models.stacked.walls import LANES, A, B, G, random_stacks, random_walls
from tests.models.strategies import random_motion

DRY = "coulomb_damping.over_m_g_b"
SEATED = {**A, "wall_length": 0.6, "top_height": 0.2}
"""A flat block as long as the wall: it stays seated while the wall rocks."""
LOOSE = {**A, "wall_length": 0.9, "top_length": 0.4, "top_height": 2.2}
"""Its upper block rocks too, also while friction holds the wall."""


def dry(over_m_g_b: float) -> dict[str, float]:
    return {DRY: over_m_g_b}


@pytest.mark.parametrize("integrator", LANES)
def test_it_raises_the_onset_at_the_base(integrator: str) -> None:
    """As one body on a ramp: a (M h) = (1 + m_c) M g b."""
    ramp = Shaking(0.01, np.linspace(0.0, 0.4 * G, 4001))
    plain, rubbed = (MODEL.simulate({**SEATED, **dry(size)}, ramp, integrator=integrator) for size in (0.0, 0.3))
    assert rubbed.outputs["onset_time"] == pytest.approx(1.3 * plain.outputs["onset_time"], rel=1e-9)


@pytest.mark.parametrize("integrator", LANES)
def test_it_holds_the_wall_until_the_couple_is_overcome(integrator: str) -> None:
    """A tipped wall stays where m_c M g b exceeds its moment; a slow ramp lets it go where it no longer does."""
    held, start = {**SEATED, **dry(0.9)}, {"rotation_1": 0.05}
    still = MODEL.simulate(held, Shaking.silence(2.0, 0.01), initial=start, integrator=integrator)
    assert np.all(still.channels["rotation_1"] == 0.05) and np.all(still.channels["rotation_2"] == 0.05)
    assert still.outputs["dissipated_energy"] == 0.0 and not still.events
    stack = MODEL.build(held).one()
    arm_x, arm_z = 0.3 * np.cos(0.05) - stack.centre * np.sin(0.05), 0.3 * np.sin(0.05) + stack.centre * np.cos(0.05)
    for way in (1.0, -1.0):  # outwards (a < 0), and inwards, where gravity helps
        needed = (0.9 * 0.3 * G + way * G * arm_x) / arm_z
        ramp = Shaking(0.01, -way * np.linspace(0.0, 1.1 * needed, 1101))
        gone = MODEL.simulate(held, ramp, initial=start, integrator=integrator)
        moved = np.flatnonzero(gone.channels["rotation_1"] != 0.05)[0]
        assert gone.time[moved] == pytest.approx(10.0, abs=0.0101)
        assert way * gone.channels["rotation_rate_1"][moved + 1] > 0.0


@pytest.mark.parametrize("integrator", LANES)
def test_its_work_is_the_couple_times_the_angle(integrator: str) -> None:
    """As one body, before the first impact."""
    start = {"rotation_1": 0.05}
    run = MODEL.simulate({**SEATED, **dry(0.2)}, Shaking.silence(0.4, 0.005), initial=start, integrator=integrator)
    travelled = 0.05 - run.channels["rotation_1"][-1]
    assert run.outputs["impacts_base"] == 0 and travelled > 0.01
    assert run.outputs["dissipated_energy"] == pytest.approx(0.2 * 1500 * G * 0.3 * travelled, rel=1e-9)


@pytest.mark.parametrize("integrator", LANES)
def test_the_ledger_balances_under_shaking(integrator: str) -> None:
    """Energy lost = energy put in by the base - energy present, with friction that holds now and then."""
    shaking = random_motion(np.random.default_rng(32), duration=3.0, vertical=False)
    fine = 5
    time = np.arange((shaking.horizontal.size - 1) * fine + 1) / fine
    a = 3.0 * np.interp(time, np.arange(shaking.horizontal.size), shaking.horizontal)
    run = MODEL.simulate({**LOOSE, **dry(0.3)}, Shaking(shaking.time_step / fine, a), integrator=integrator)
    c = run.channels
    assert run.outputs["impacts_base"] > 3 and run.outputs["impacts_top"] > 3 and not run.outputs["overturned"]
    assert np.mean((c["rotation_1"] != 0.0) & (c["rotation_rate_1"] == 0.0)) > 0.01
    stack = MODEL.build(LOOSE).one()
    across = stack.mass_1 * c["displacement_1_x"] + stack.mass_2 * c["displacement_2_x"]
    put_in = -np.sum(0.5 * (a[1:] + a[:-1]) * np.diff(across))
    q, rate = (c["rotation_1"][-1], c["rotation_2"][-1]), (c["rotation_rate_1"][-1], c["rotation_rate_2"][-1])
    opening, turning = (q[0], q[1] - q[0]), (rate[0], rate[1] - rate[0])
    end = State((int(np.sign(opening[0])), int(np.sign(opening[1]))), opening, turning)
    still = State((0, 0), (0.0, 0.0), (0.0, 0.0))
    present = energy(stack, end, (0.0, G)) - energy(stack, still, (0.0, G))
    assert run.outputs["dissipated_energy"] == pytest.approx(put_in - present, rel=1e-4)


@pytest.mark.parametrize("step", [0.01, 0.04, 0.1])
def test_it_never_puts_energy_in_at_any_step(step: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """The energy lost never falls from one instant to the next, however few the steps."""
    monkeypatch.setattr(lanes, "LARGEST_PHASE", 10.0)
    rng = np.random.default_rng(2)
    shaking = Shaking(step, rng.normal(size=round(4.0 / step)))
    for values in (SEATED, LOOSE):
        stack = MODEL.build({**values, **dry(0.15)})
        lost = []
        for k in range(2, shaking.horizontal.size, max(1, round(0.04 / step))):
            part = Shaking(step, shaking.horizontal[:k])
            found = lanes.run(stack, Request(part, np.array([3.0]))).outputs
            lost.append(float(found["dissipated_energy_base"][0]))
            if found["overturned"][0]:
                break
        assert lost[-1] > 1.0 and np.all(np.diff(lost) >= 0.0)


@pytest.mark.parametrize("integrator", LANES)
def test_with_next_to_nothing_on_top_it_is_that_of_one_block(integrator: str) -> None:
    """Onset, impacts and motion of Housner's block with the same couple, which holds it at times."""
    holds = 0
    for seed, size in ((4, 0.02), (5, 0.136), (4, 0.4)):
        shaking = random_motion(np.random.default_rng(seed), duration=4.0)
        wall = {**A, "wall_length": 0.6, "top_mass": 1e-6, "top_length": 0.5, "top_height": 0.2, **dry(size)}
        stack = MODEL.simulate(wall, shaking, scale=3.0, tail=1.0, integrator=integrator)
        block = {"height": 3.0, "width": 0.6, "mass": 1000.0, "gravity": G, **dry(size)}
        one = models.get("housner").simulate(block, shaking, scale=3.0, tail=1.0, integrator=integrator)
        assert one.outputs["impacts"] > 2
        assert stack.outputs["onset_time_base"] == pytest.approx(one.outputs["onset_time"])
        # the steps of one block take no notice of hops within one
        tolerance = 1e-5 if integrator == "lanes" else 5e-7
        np.testing.assert_allclose(stack.channels["rotation_1"], one.channels["rotation_1"], atol=tolerance)
        holds += int(np.sum((one.channels["rotation_1"] != 0.0) & (one.channels["rotation_rate_1"] == 0.0)))
    assert holds > 3


def test_a_couple_of_rounding_leaves_the_plain_stack() -> None:
    """The kernel that knows friction against the one that does not; and beside a pitching table."""
    shaking = random_motion(np.random.default_rng(1), duration=4.0)
    pitched = {"table_pitch.pitch_per_acceleration": 1e-3}
    for more, sign in (({}, 1.0), (pitched, -1.0)):
        plain, switched = (
            MODEL.simulate({**B, **more, **extra}, shaking, scale=2.5 * sign, tail=1.0) for extra in ({}, dry(1e-15))
        )
        assert plain.outputs["impacts_top"] > 2
        # impacts amplify roundings
        np.testing.assert_allclose(plain.channels["rotation_2"], switched.channels["rotation_2"], atol=1e-7)


def test_exactly_one_way_on_is_admissible() -> None:
    """10 000 random stacks: at rest, and with a tipped wall at its turning point, under random accelerations.

    A squat stack whose wall is thrown may leave its upper block behind: two corners for that, as without friction.
    """
    rng = np.random.default_rng(7)
    stack = random_stacks(rng, 10_000)
    stack = stack.replace(coulomb=rng.uniform(0.0, 0.6, stack.size) * stack.mass * G * stack.half_length_1)
    level = np.minimum(stack.half_width / stack.centre, stack.half_width_2 / stack.centre_2)
    a = G * level * np.exp(rng.uniform(-0.5, 3.0, stack.size)) * rng.choice([-1.0, 1.0], stack.size)
    still, pairs = (0.0, 0.0), candidates(0, 0)
    for corner, q in ((0, still), (1, (0.5 * stack.slenderness, 0.0))):

        def system(c1: int, c2: int, corner: int = corner, q: Rotations = q) -> System:
            return motion(stack, corner or c1, c2, q, still, (a, G, 0.0), False, c1)

        admissible = np.stack([margin(system, 0, 0, *pair) > 0.0 for pair in pairs])
        assert {(0, 0), (0, 1)} < {pair for pair, one in zip(pairs, admissible, strict=True) if np.any(one)}
        ways = [np.any([one for one, (s1, _) in zip(admissible, pairs, strict=True) if s1 == way], axis=0)
                for way in (1, -1, 0)]  # fmt: skip
        assert np.all(np.sum(ways, axis=0) == 1)
        assert np.mean(np.sum(admissible, axis=0) == 1) > (0.98 if corner else 0.9999)


def test_an_upper_block_comes_to_rest_on_a_wall_that_is_held() -> None:
    """Its last small impacts free the wall no more: of many stacks none bounces without end."""
    stack, scale = random_walls(0, 1500)
    size = np.exp(np.random.default_rng(0).uniform(np.log(1e-3), np.log(2.0), stack.size))
    stack = stack.replace(coulomb=size * stack.mass * stack.gravity * stack.half_length_1)
    request = Request(random_motion(np.random.default_rng(100), duration=6.0, vertical=True), 1.3 * scale, tail=3.0)
    assert not np.any(lanes.run(stack, request).outputs["status"] == 5)
    one = (stack.take([1497]), request.take([1497]))
    found, expected = lanes.run(*one).outputs, reference.run(*one).outputs
    for name in ("impacts_base", "impacts_top", "configurations"):
        assert found[name] == expected[name], name
    assert found["residual_rotation_1"] == pytest.approx(expected["residual_rotation_1"], abs=1e-7)


def test_an_overturning_wall_is_not_held() -> None:
    """Beyond its balance a wall falls only where its own weight overcomes friction, and is held where it does not."""
    alpha = float(MODEL.build(SEATED).slenderness[0])
    silence = Shaking.silence(0.02, 0.01)
    for integrator in LANES:
        ends = []
        for beyond in (0.02, 0.3):
            start = {"rotation_1": alpha + beyond, "rotation_rate_1": 0.02}
            run = MODEL.simulate({**SEATED, **dry(0.5)}, silence, initial=start, tail=6.0, integrator=integrator)
            ends.append((run.outputs["overturned"], run.channels["rotation_rate_1"][-1]))
        assert ends == [(0.0, 0.0), (1.0, 0.0)]
