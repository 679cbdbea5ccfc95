"""The compiled lanes against the plain reference, and what lanes promise."""

import numpy as np
import pytest

from models.runs import Request
from models.shaking import Shaking
from models.stacked.configuration import NAMES
from models.stacked.lanes import run as lanes
from models.stacked.model import MODEL
from models.stacked.reference import run as reference
from tests.models.stacked.walls import B, random_walls
from tests.models.strategies import random_motion

WALLS = 6


@pytest.mark.parametrize("dry", [0.0, 0.6])
@pytest.mark.parametrize("linear", [False, True])
def test_lanes_agree_with_the_reference(linear: bool, dry: float) -> None:
    """Outputs of random walls, without and with dry friction, where the lanes' own answer is not one of the step."""
    stack, scale = random_walls(21, WALLS)
    couple = np.random.default_rng(21).uniform(0.02, 1.0, WALLS) * dry
    stack = stack.replace(coulomb=couple * stack.mass * stack.gravity * stack.half_length_1)
    shaking = random_motion(np.random.default_rng(1), duration=4.5)
    words = {"formulation": "linear" if linear else "nonlinear"}
    request = Request(shaking, scale, words, tail=3.0)
    coarse, fine = (lanes.run(stack, request, n).outputs for n in (1, 2))
    counted = ("impacts_base", "impacts_top", "configurations")
    peaks = ("peak_rotation_1", "peak_rotation_2")
    steady = ~coarse["overturned"]
    for name in counted:
        steady &= coarse[name] == fine[name]
    for name in peaks:
        steady &= np.abs(coarse[name] - fine[name]) < 1e-7
    assert steady.sum() >= 0.5 * WALLS
    slow = [reference.run(stack.take([k]), request.take([k])).outputs for k in np.flatnonzero(steady)]
    expected = {name: np.concatenate([one[name] for one in slow]) for name in slow[0]}
    found = {name: values[steady] for name, values in coarse.items()}
    for name in counted:
        np.testing.assert_array_equal(found[name], expected[name])
    assert found["impacts_base"].sum() + found["impacts_top"].sum() > 50
    for name in NAMES:
        np.testing.assert_allclose(found[f"time_in_{name}"], expected[f"time_in_{name}"], atol=1e-4)
    for name in (*peaks, "onset_time_base", "onset_time_top"):
        np.testing.assert_allclose(found[name], expected[name], atol=1e-6)
    np.testing.assert_allclose(found["dissipated_energy"], expected["dissipated_energy"], rtol=1e-5)
    # the demand is the largest over the steps' ends and the events, not over the whole motion
    for name in ("friction_demand_base", "friction_demand_top"):
        bounded = expected[name] < 2.0
        np.testing.assert_allclose(found[name][bounded], expected[name][bounded], rtol=5e-3)


def test_overturning_agrees_with_the_reference() -> None:
    stack, scale = random_walls(22, 8)
    shaking = random_motion(np.random.default_rng(3), duration=5.0)
    request = Request(shaking, 3.0 * scale, tail=8.0)
    found, expected = (MODEL.run(integrator, stack, request).outputs for integrator in MODEL.integrators)
    assert 3 <= found["overturned"].sum() <= 8
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
    request = Request(shaking, scale, tail=1.0)
    together = lanes.run(stack, request).outputs
    order = np.random.default_rng(0).permutation(40)
    for lanes_of in (order, [0], [17], [39]):
        again = lanes.run(stack.take(lanes_of), request.take(lanes_of)).outputs
        for name, values in together.items():
            np.testing.assert_array_equal(again[name], values[lanes_of], err_msg=name)


def test_order_of_convergence(monkeypatch: pytest.MonkeyPatch) -> None:
    """The state after ten events converges with the fourth power of the step."""
    monkeypatch.setattr(lanes, "LARGEST_PHASE", 1.0)
    stack, silence = MODEL.build(B), Shaking.silence(1.5, 0.02)
    # rotation_2 against the base: the top joint is open by -.07
    initial = {"rotation_1": np.array([0.05]), "rotation_2": np.array([-0.02])}
    request = Request(silence, np.ones(1), initial=initial, samples=silence.horizontal.size)
    exact = reference.run(stack, request, 1e-13)
    assert len(exact.events[0]) >= 8
    errors = []
    for refinement in (2, 4, 8):
        last = lanes.run(stack, request, refinement).samples[0, -1, :2]
        errors.append(np.abs(last - exact.samples[0, -1, :2]).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(orders > 3.5)


def test_windows_continue_a_history() -> None:
    """Lanes that start from a state inside a history follow it."""
    shaking = random_motion(np.random.default_rng(8), duration=6.0, vertical=False)
    whole = MODEL.simulate(B, shaking, scale=2.5)
    rotation = whole.channels["rotation_1"]
    first = np.flatnonzero(np.abs(rotation) > 0.3 * np.abs(rotation).max())[::40][:5]
    states = {name: whole.channels[name][first] for name in MODEL.states}
    windows = MODEL.trajectories(B, shaking.scaled(2.5), first=first, samples=60, initial=states)
    for k, start in enumerate(first):
        span = min(60, rotation.size - start)
        expected = whole.channels["rotation_2"][start : start + span]
        np.testing.assert_allclose(windows["rotation_2"][k, :span], expected, atol=1e-9)
