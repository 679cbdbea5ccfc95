"""Energy: what the rubber has taken in and cannot give back is never negative, in either route."""

from itertools import pairwise

import numpy as np
import pytest

from models.interface import modes
from models.interface.lanes import run as lanes
from models.interface.reference import run as reference
from models.interface.reference.equation import Equation
from models.rubber import LAWS
from models.shaking import Shaking
from tests.models.interface.walls import SHORT, undamped, wall
from tests.models.requests import asked, outputs_of
from tests.models.rubber.laws import GIVEN, alone, laden
from tests.models.strategies import random_motion

HARD = Shaking(0.01, 6.0 * np.sin(2 * np.pi * 2.5 * 0.01 * np.arange(36)))
JOINTS = ("base", "top")
AMPLITUDES = {"locking": 5e-4}
"""Of the random paths' sines (m): a layer that locks stays below its lock strain."""


@pytest.mark.parametrize("name", LAWS)
def test_a_fibre_never_gives_back_more_than_it_took(name: str) -> None:
    """Random paths, opening too: over every step the work is at least the change of the stored energy.

    Of a fibre that can pull, and of one that cannot.
    """
    layer, count = alone(name), 20_000
    rng = np.random.default_rng(5)
    lines, ways = 2 * np.pi * rng.integers(1, 12, (4, 30)), rng.normal(0, AMPLITUDES.get(name, 3e-3), (4, 30))
    time = np.linspace(0.0, 1.0, count)[:, None]
    u = np.maximum(1e-3 + sum(way * np.sin(line * time) for way, line in zip(ways, lines, strict=True)), 0.0)
    h = layer.relaxed(u[0])
    before, worst, lost, most = None, 0.0, 0.0, 0.0
    for old, new in pairwise(u):
        middle, change = 0.5 * (old + new), new - old
        rates = layer.rates(middle, change * count, h)
        h = layer.reached(new, [one + rate / count for one, rate in zip(h, rates, strict=True)])
        pulled, energy = layer.stress(new, h), layer.energy(new, h)
        pressed = energy - np.minimum(pulled, 0.0) ** 2 / (2 * layer.slope(new, h))
        spring, energy = np.stack([pulled, np.maximum(pulled, 0.0)]), np.stack([energy, pressed])
        if before is not None:
            taken = 0.5 * (spring + before[0]) * change - (energy - before[1])
            worst, lost = np.minimum(worst, taken), lost + taken
        before, most = (spring, energy), np.maximum(most, energy)
    # to the error of the steps, greatest where the clip begins or ends within one
    assert np.all(worst > -1e-5 * most)
    assert np.all(lost > -1e-4 * most)
    if name not in ("hardening", "locking"):
        assert np.median(lost / most) > 0.03


@pytest.mark.parametrize(("name", "dashpot"), [*((name, "B") for name in LAWS), ("maxwell", "A"), ("mullins", "A")])
def test_layers_of_random_walls_never_give_energy(name: str, dashpot: str) -> None:
    """Lanes: strong shaking of 32 walls, some overturn; both joints, base and top on their own.

    The falling edge of a wall that overturns is pressed beyond the lock strain: the step is too coarse for energies.
    """
    rng = np.random.default_rng([3, list(LAWS).index(name), dashpot == "A"])
    values = laden(name, rng, 32)
    many = wall(values, dashpot=dashpot).replace(vertical_factor=1.0)
    scale = 9.81 * values["aspect_ratio"] * rng.uniform(0.3, 2.5, 32)
    found = lanes.run(many, asked(random_motion(rng, duration=2.5), scale, tail=1.0)).outputs
    assert np.sum(found["minimum_contact"] < 0.7) > 10
    assert not np.any(found["status"] == 5)
    counted = found["overturned"] == 0 if name == "locking" else np.full(32, True)
    assert counted.sum() > 20
    for joint in JOINTS:
        assert np.all(found[f"dissipated_energy_{joint}"][counted] >= 0.0), joint
    np.testing.assert_allclose(found["dissipated_energy"], sum(found[f"dissipated_energy_{j}"] for j in JOINTS))


@pytest.mark.parametrize("name", ["hardening", "locking", "permanent_set"])
def test_springs_that_only_store_lose_nothing(name: str) -> None:
    """No dashpots, no flow: to rounding in the reference, with the second order of the step in the lanes."""
    rigid = {"permanent_set.strain_limit": 50.0} if name == "permanent_set" else {}
    one = wall({**undamped(SHORT), **GIVEN[name], **rigid})
    slow = reference.run(one, asked(HARD, duration=0.35), 1e-9)
    assert slow.outputs["minimum_contact_base"] < 0.5
    equation = Equation(one)
    exchanged = max(sum(equation.stored(q, equation.relaxed())) for q in slow.samples[0, :, :4].tolist())
    errors = []
    for refinement in (1, 4):
        found = lanes.run(one, asked(HARD), refinement).outputs
        errors.append(max(abs(found[f"dissipated_energy_{joint}"][0]) for joint in JOINTS))
    for joint in JOINTS:
        assert abs(slow.outputs[f"dissipated_energy_{joint}"]) < 1e-8 * exchanged
    assert errors[0] < 2e-3 * exchanged
    assert errors[1] < errors[0] / 8


@pytest.mark.parametrize("name", LAWS)
def test_both_routes_move_and_dissipate_alike(name: str) -> None:
    """A random wall let go at four times its uplift rotation: with fine steps the same, and no energy is given."""
    rng = np.random.default_rng([8, list(LAWS).index(name)])
    one = wall({k: float(v[0]) for k, v in laden(name, rng, 1).items()})
    lean = 4.0 * float(modes.uplift_rotation(one, modes.static_state(one))[0])
    start = {"rotation_1": lean, "rotation_2": lean}
    request = asked(Shaking.silence(0.3, 0.01), initial=start, duration=0.3)
    ran = reference.run(one, request, 1e-6), lanes.run(one, request, 8)
    slow, fast = (outputs_of(each) for each in ran)
    assert slow["minimum_contact_base"] < 0.8
    there, here = (each.samples[0, :, :4] for each in ran)
    assert np.max(np.max(np.abs(here - there), axis=0) / np.max(np.abs(there), axis=0)) < 1e-3
    for joint in JOINTS:
        part = slow[f"dissipated_energy_{joint}"]
        assert part >= 0.0
        assert fast[f"dissipated_energy_{joint}"] == pytest.approx(part, abs=5e-3 * slow["dissipated_energy"])
        assert fast[f"peak_strain_{joint}"] == pytest.approx(slow[f"peak_strain_{joint}"], rel=3e-3)
