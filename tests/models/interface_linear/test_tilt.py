"""A base that leans under a linear wall: gravity along it, and a rest that leans too."""

from __future__ import annotations

import numpy as np
import pytest

from models.errors import InputError
from models.interface_linear import equation
from models.shaking import Shaking
from tests.models.interface.walls import MODEL as FULL_MODEL
from tests.models.interface.walls import SHORT
from tests.models.interface_linear.walls import MODEL, wall

TILT = 0.01
STEP = 0.01


def shaking(size: float) -> Shaking:
    time = STEP * np.arange(201)
    return Shaking(STEP, size * np.sin(7.0 * time) * np.sin(np.pi * time / 2.0) ** 2)


def leaning(tilt: float) -> dict[str, float]:
    return {**SHORT, "tilt.tilt": tilt}


@pytest.mark.parametrize("integrator", ["lanes", "reference"])
def test_a_wall_that_leans_rests_where_its_layers_hold_it(integrator: str) -> None:
    rest, still = equation.rest(wall(leaning(TILT)))[0], Shaking.silence(0.5, STEP)
    ran = MODEL.simulate(leaning(TILT), still, duration=0.5, integrator=integrator).channels
    for body in (1, 2):
        np.testing.assert_allclose(ran[f"rotation_{body}"], rest[body - 1], rtol=1e-9)
    for joint, z in (("base", rest[2]), ("top", rest[3])):
        np.testing.assert_allclose(ran[f"compression_{joint}"], -z, rtol=1e-9)
    # clockwise is to the right: the wall leans with its base, and as the full equations have it at this size
    full = FULL_MODEL.simulate(leaning(TILT), still, duration=0.5).channels
    assert rest[0] > 0.0
    np.testing.assert_allclose(rest[:2], [full["rotation_1"][0], full["rotation_2"][0]], rtol=0.02)


def test_both_routes_move_a_wall_that_leans_alike_and_differently_on_either_side() -> None:
    base = shaking(1.5)
    fast, slow = (MODEL.simulate(leaning(TILT), base, integrator=i).channels for i in ("lanes", "reference"))
    plain = MODEL.simulate(SHORT, base).channels
    peak = np.max(np.abs(slow["rotation_1"]))
    assert np.max(np.abs(fast["rotation_1"] - slow["rotation_1"])) < 1e-6 * peak
    assert np.max(np.abs(fast["rotation_1"] - plain["rotation_1"])) > 0.1 * peak
    turned = MODEL.simulate(leaning(-TILT), Shaking(STEP, -base.horizontal)).channels
    np.testing.assert_allclose(turned["rotation_1"], -fast["rotation_1"], atol=1e-9 * peak)


def test_a_level_base_is_the_wall_without_it_and_a_steep_one_is_refused() -> None:
    base = shaking(1.5)
    level, plain = (MODEL.simulate(values, base).channels for values in (leaning(0.0), SHORT))
    for name, x in plain.items():
        np.testing.assert_array_equal(level[name], x)
    with pytest.raises(InputError, match="leans so far that a joint is open at rest"):
        MODEL.simulate({**leaning(0.05), "wall_length": 0.5, "layer_modulus": 2e7}, base)
