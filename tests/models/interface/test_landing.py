"""Layers that give way along the joints: rubber that lifts lets go and lands unsheared."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import models
from models.interface.effects import CELLS, LANDED
from models.interface.landing import BOUNDS, lengths, rates
from models.runs import Prescribed
from models.shaking import Shaking
from tests.models.interface.walls import SHORT

MODEL = models.get("interface")
STEP = 0.002
TIME = STEP * np.arange(900)
PULSES = np.where(TIME < 0.8, np.sin(2.0 * np.pi * 2.5 * TIME), 0.0)
QUIET = 25.0
"""s until nothing moves any more."""
SOFT = {**SHORT, "interface_shear.shear_over_normal": 0.3}


def shaken(size: float) -> Shaking:
    return Shaking(STEP, size * PULSES)


@given(st.floats(0.1, 2.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_the_parts_make_up_the_stretch(b: float, one: float, other: float) -> None:
    low, high = b * min(one, other), b * max(one, other)
    found = lengths(np.array(b), np.array(low), np.array(high))
    assert np.all(found >= 0.0)
    assert np.sum(found) == pytest.approx(high - low, abs=1e-12)


def test_what_lands_takes_the_present_slip_and_what_lifts_keeps_its_own() -> None:
    """The front runs over one part at the speed v: m d' is the slip at landing integrated over d."""
    b, s, v = 0.5, 0.01, -0.3
    front = b * float(BOUNDS[8]) + 0.02
    touching = b * float(BOUNDS[9]) - front
    landed = np.linspace(0.0, 1e-3, CELLS)
    motion = s, v * s, 0.0  # z' = s front'
    found = rates(b, (front, b), motion, (5e-3, 0.1), landed)
    assert found[8] == pytest.approx((5e-3 - landed[8]) * -v / touching)
    np.testing.assert_array_equal(found[:8], 0.1)  # nothing touches there
    np.testing.assert_array_equal(found[9:], 0.0)
    lifting = rates(b, (front, b), (s, -v * s, 0.0), (5e-3, 0.1), landed)
    assert lifting[8] == 0.0


def test_a_wall_that_has_rocked_stays_displaced_and_one_that_has_not_lifted_does_not() -> None:
    found = []
    for size in (0.2, 4.0):
        channels = MODEL.simulate(SOFT, shaken(size), tail=QUIET).channels
        slip = channels["displacement_1_x"]
        found.append((abs(slip[-1]), float(np.max(np.abs(slip)))))
    (still, size), (stays, most) = found
    assert still < 1e-5 * size  # what has not died out yet
    assert stays / most > 100.0 * still / size


def test_where_it_stays_the_sheared_layers_are_in_balance() -> None:
    """At rest the layer's force is nought: the slip is the mean of those at landing."""
    shaking = Shaking(STEP, np.append(shaken(4.0).horizontal, np.zeros(int(QUIET / STEP))))
    run = MODEL.simulate(SOFT, shaking)
    motion = {name: run.channels[name][None] for name in ("rotation_1", "rotation_2")}
    motion |= {name: run.channels[name][None] for name in ("rotation_rate_1", "rotation_rate_2")}
    marks = np.array([run.time.size - 1])
    carried = MODEL.carry(SOFT, shaking, Prescribed(motion, marks, np.zeros(1, np.int64)))
    landed = np.array([carried[name][0, 0] for name in LANDED[:CELLS]])
    slip = carried["displacement_x_1"][0, 0]
    assert abs(slip) > 1e-5
    assert np.mean(landed) == pytest.approx(slip, rel=5e-3)
    assert np.ptp(landed) > abs(slip)
