"""The compiled lanes against the plain reference, and what lanes promise."""

import numpy as np
import pytest

from models.base import FloatArray
from models.shaking import Shaking
from models.stacked import account, reference
from models.stacked.lanes import run as lanes
from models.stacked.model import MODEL
from models.stacked.stack import Stack, build
from tests.models.stacked.walls import B, random_wall
from tests.models.strategies import random_motion

WALLS = 16


def random_walls(seed: int, count: int) -> tuple[Stack, FloatArray]:
    """Walls with their onset accelerations."""
    rng = np.random.default_rng(seed)
    walls = [random_wall(rng) for _ in range(count)]
    values = {name: np.array([wall[name] for wall in walls]) for name in walls[0]}
    values["pivot_inset.inset_over_half_width_top"] = rng.uniform(0.0, 0.2, count)
    values["restitution.factor_on_housner_base"] = rng.uniform(0.8, 1.0, count)
    values["eccentricity.offset_over_half_width"] = rng.uniform(-0.1, 0.1, count)
    values["viscous_damping.rate"] = rng.uniform(0.0, 0.3, count)
    onset = MODEL.derive(values)["onset_acceleration"]
    return build(values, vertical=True), onset * rng.uniform(1.2, 4.0, count)


@pytest.mark.parametrize("linear", [False, True])
def test_lanes_agree_with_the_reference(linear: bool) -> None:
    """Outputs of random walls, where the lanes' own answer does not depend on the step."""
    stack, scale = random_walls(21, WALLS)
    shaking = random_motion(np.random.default_rng(1), duration=6.0)
    coarse = lanes.run(stack, shaking, scale, tail=3.0, linear=linear).account
    fine = lanes.run(stack, shaking, scale, tail=3.0, linear=linear, refinement=2).account
    counted = [account.IMPACTS_BASE, account.IMPACTS_TOP]
    peaks = [account.PEAK_1, account.PEAK_2]
    stands = np.isnan(coarse[:, account.OVERTURNED_2])
    steady = np.all(coarse[:, counted] == fine[:, counted], axis=1) & stands
    steady &= np.all(np.abs(coarse[:, peaks] - fine[:, peaks]) < 1e-7, axis=1)
    assert steady.sum() >= 0.5 * WALLS
    expected = np.array(
        [
            reference.run(stack.take([k]), shaking, scale[k], tail=3.0, linear=linear).account
            for k in np.flatnonzero(steady)
        ]
    )
    found = coarse[steady]
    np.testing.assert_array_equal(found[:, [*counted, account.VISITED]], expected[:, [*counted, account.VISITED]])
    assert found[:, counted].sum() > 100
    times = slice(account.TIME_IN, None)
    np.testing.assert_allclose(found[:, times], expected[:, times], atol=1e-4)
    for column in (*peaks, account.ONSET_BASE, account.ONSET_TOP):
        np.testing.assert_allclose(found[:, column], expected[:, column], atol=1e-6)
    lost = [account.LOST_BASE, account.LOST_TOP]
    np.testing.assert_allclose(found[:, lost].sum(axis=1), expected[:, lost].sum(axis=1), rtol=1e-5)
    # the demand is the largest over the steps' ends and the events, not over the whole motion
    for column in (account.FRICTION_BASE, account.FRICTION_TOP):
        bounded = expected[:, column] < 2.0
        np.testing.assert_allclose(found[bounded, column], expected[bounded, column], rtol=5e-3)


def test_overturning_agrees_with_the_reference() -> None:
    stack, scale = random_walls(22, 16)
    shaking = random_motion(np.random.default_rng(3), duration=5.0)
    found = account.outputs(stack, lanes.run(stack, shaking, 3.0 * scale, tail=8.0).account)
    accounts = [reference.run(stack.take([k]), shaking, 3.0 * scale[k], tail=8.0).account for k in range(16)]
    expected = account.outputs(stack, np.array(accounts))
    assert 3 <= found["overturned"].sum() <= 16
    for name in ("overturned", "overturned_1", "overturned_2", "status"):
        np.testing.assert_array_equal(found[name], expected[name])
    np.testing.assert_allclose(found["overturning_time"], expected["overturning_time"], atol=0.02)
    assert np.all(found["peak_rotation"][found["overturned"]] == np.pi / 2)


def test_history_and_events_agree_with_the_reference() -> None:
    shaking = random_motion(np.random.default_rng(4), duration=6.0)
    here, there = (MODEL.simulate(B, shaking, scale=2.5, tail=2.0, integrator=i) for i in ("lanes", "reference"))
    assert len(here.events) > 20
    assert [(e.kind, e.body) for e in here.events] == [(e.kind, e.body) for e in there.events]
    assert max(abs(e.time - f.time) for e, f in zip(here.events, there.events, strict=True)) < 1e-6
    for name in ("rotation_1", "rotation_2", "displacement_1_x", "displacement_2_x"):
        np.testing.assert_allclose(here.channels[name], there.channels[name], atol=1e-7)


def test_a_lane_does_not_know_its_neighbours() -> None:
    """Bit for bit the same alone, in another order, and among others."""
    stack, scale = random_walls(5, 40)
    shaking = random_motion(np.random.default_rng(6), duration=5.0)
    together = lanes.run(stack, shaking, scale, tail=1.0).account
    order = np.random.default_rng(0).permutation(40)
    shuffled = lanes.run(stack.take(order), shaking, scale[order], tail=1.0).account
    np.testing.assert_array_equal(shuffled, together[order])
    for k in (0, 17, 39):
        alone = lanes.run(stack.take([k]), shaking, scale[[k]], tail=1.0).account
        np.testing.assert_array_equal(alone[0], together[k])


def test_order_of_convergence(monkeypatch: pytest.MonkeyPatch) -> None:
    """The state after ten events converges with the fourth power of the step."""
    monkeypatch.setattr(lanes, "LARGEST_PHASE", 1.0)
    stack, silence = build(B, vertical=False), Shaking.silence(1.5, 0.02)
    initial = {"q1": np.array([0.05]), "q2": np.array([-0.07])}
    exact = reference.run(
        stack, silence, tail=0.0, initial={name: value[0] for name, value in initial.items()}, rtol=1e-13
    )
    assert len(exact.events) >= 8
    errors = []
    for refinement in (2, 4, 8):
        ran = lanes.run(
            stack, silence, np.ones(1), initial=initial, samples=exact.history.shape[1], refinement=refinement
        )
        assert ran.trace is not None
        errors.append(np.abs(ran.trace[0, -1, :2] - exact.history[:2, -1]).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(orders > 3.5)


def test_windows_continue_a_history() -> None:
    """Lanes that start from a state inside a history follow it."""
    shaking = random_motion(np.random.default_rng(8), duration=6.0, vertical=False)
    whole = MODEL.simulate(B, shaking, scale=2.5)
    rotation = whole.channels["rotation_1"]
    first = np.flatnonzero(np.abs(rotation) > 0.3 * np.abs(rotation).max())[::40][:5]
    states = {name: whole.channels[name][first] for name in MODEL.states}
    windows = MODEL.trajectories(B, shaking, first=first, samples=60, initial=states, scale=2.5)
    for k, start in enumerate(first):
        span = min(60, rotation.size - start)
        expected = whole.channels["rotation_2"][start : start + span]
        np.testing.assert_allclose(windows["rotation_2"][k, :span], expected, atol=1e-9)
