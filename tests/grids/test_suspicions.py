"""The regression that suspicions rest on, where a recording gives it nothing to go by."""

from __future__ import annotations

import numpy as np
import pytest

from grids.recordings import Recording
from grids.recordings.suspicions import fit_rocking, suspicions_of

STEP, COUNT = 0.01, 400
TIME = STEP * np.arange(COUNT)


def test_a_rotation_that_the_base_has_no_share_in_says_nothing_of_the_body() -> None:
    """Of a sine the rotation alone explains the acceleration: rounding is left to the base, or exactly 0."""
    rotation, base = 0.05 * np.sin(5.0 * TIME), 2.0 * np.sin(8.0 * TIME)
    for ahead in range(60):
        fit = fit_rocking(rotation[: COUNT - ahead], base[ahead:], STEP)
        assert fit is not None and abs(fit.p2) < 1e-12
        assert fit.p2 != 0.0 or (fit.significance, fit.alpha) == (0.0, np.inf)


@pytest.mark.parametrize(("moved", "suspected"), [(0.0, False), (0.002, False), (0.06, True)])
def test_a_zero_that_moves_between_the_rests_is_suspected(moved: float, suspected: bool) -> None:
    """Of 3 m s-2 with noise of .4 per cent; where the record ends in motion nothing is told."""
    rng, time = np.random.default_rng(1), 0.005 * np.arange(1600)
    shaken = (time > 2.0) & (time < 6.0)
    base = 3.0 * np.sin(9.0 * time) * shaken + moved * (time > 4.0) + 0.012 * rng.normal(size=time.size)

    def said(count: int) -> bool:
        channels = {"base_acceleration_x": base[:count], "rotation_1": 0.01 * base[:count]}
        found = suspicions_of(Recording("run", 0.005, time[:count], channels))
        return any("at rest before the shaking" in one for one in found)

    assert said(time.size) == suspected
    assert not said(1000)
