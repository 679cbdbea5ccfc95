"""What a history shows: cut before the end of the shaking, and after overturning."""

import numpy as np
import pytest

from tests.models.housner.adapter import EXACT, INTEGRATORS, MODEL, rectangle
from tests.models.housner.pulses import constant

BLOCK = rectangle(0.2, 2.0)
PUSH = constant(3.0, 300)
STRONG = 1.2 * 0.2 * 9.80665
"""1.2 alpha g for 3 s: the block is upright for the first half second and overturns within the push."""


@pytest.mark.parametrize("integrator", EXACT)
def test_a_cut_history_knows_nothing_of_what_comes_later(integrator: str) -> None:
    whole = MODEL.simulate(BLOCK, PUSH, scale=STRONG, integrator=integrator)
    cut = MODEL.simulate(BLOCK, PUSH, scale=STRONG, duration=0.5, integrator=integrator)
    assert whole.outputs["overturned"] == 1.0 and 0.6 < whole.outputs["overturning_time"] < 3.0
    size = cut.time.size
    np.testing.assert_allclose(cut.channels["rotation_1"], whole.channels["rotation_1"][:size], rtol=0, atol=1e-9)
    assert cut.outputs["overturned"] == 0.0 and np.isnan(cut.outputs["overturning_time"])
    assert cut.outputs["peak_rotation"] == pytest.approx(np.max(np.abs(cut.channels["rotation_1"])), rel=1e-9)
    assert [event.kind for event in cut.events] == ["onset"]


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_block_that_has_overturned_stays_down(integrator: str) -> None:
    run = MODEL.simulate(BLOCK, PUSH, scale=STRONG, tail=1.0, integrator=integrator)
    rotation = run.channels["rotation_1"]
    down = np.flatnonzero(np.abs(rotation) >= np.pi / 2 - 1e-12)
    assert down.size and np.all(np.abs(rotation[down[0] :]) == np.pi / 2)
    assert np.all(np.diff(np.abs(rotation[: down[0] + 1])) >= 0.0)
    assert np.all(run.channels["rotation_rate_1"][down[0] :] == 0.0)
