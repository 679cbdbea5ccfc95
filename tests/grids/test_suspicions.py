"""The regression that suspicions rest on, where a recording gives it nothing to go by."""

from __future__ import annotations

import numpy as np

from grids.recordings.suspicions import fit_rocking

STEP, COUNT = 0.01, 400
TIME = STEP * np.arange(COUNT)


def test_a_rotation_that_the_base_has_no_share_in_says_nothing_of_the_body() -> None:
    """Of a sine the rotation alone explains the acceleration: rounding is left to the base, or exactly 0."""
    rotation, base = 0.05 * np.sin(5.0 * TIME), 2.0 * np.sin(8.0 * TIME)
    for ahead in range(60):
        fit = fit_rocking(rotation[: COUNT - ahead], base[ahead:], STEP)
        assert fit is not None and abs(fit.p2) < 1e-12
        assert fit.p2 != 0.0 or (fit.significance, fit.alpha) == (0.0, np.inf)
