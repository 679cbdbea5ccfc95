"""Windows of two bodies end where a change of what is fitted, by its deviation, is out of proportion."""

from __future__ import annotations

from functools import cache

import numpy as np

from diagnosis.errors.followed import followed, in_proportion
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import Fitted
from grids.specimen import Specimen
from tests.diagnosis.search.test_ladder import ON_TOP, rocking_on_top

CHANGE = 0.5
"""Deviations of a state, along one that a window's own samples tell worst."""


STACK = Specimen("stack", "stacked", ON_TOP, {"wall_length": 0.005, "wall_height": 0.005})


@cache
def whole() -> Fitted:
    return base_fit(STACK, measure(STACK, [rocking_on_top(seed, True) for seed in (1, 2)]))


def bends(fitted: Fitted) -> np.ndarray:
    """Largest departure (W,) from proportion over the noise, the states changed along their worst-known direction."""
    m, misfit = fitted.measured, fitted.misfit
    by_state = misfit.linearise(fitted.u, fitted.states).by_state
    _, values, axes = np.linalg.svd(by_state, full_matrices=False)
    step = CHANGE * axes[:, -1] / values[:, -1, None]
    states = (fitted.states + step, fitted.states - step, fitted.states)
    up, down, plain = misfit.predictor.predict([misfit.point(fitted.u, x) for x in states])
    return np.max(np.abs(up + down - 2.0 * plain) / (2.0 * m.units[:, :, None]) * m.mask, axis=(1, 2))


def test_what_is_left_of_the_windows_is_in_proportion() -> None:
    cut = followed(whole())
    assert cut.measured.mask.sum() < whole().measured.mask.sum()
    assert {w.first for w in cut.measured.windows} <= {w.first for w in whole().measured.windows}
    steps = [cut.measured.recordings[w.recording].time_step for w in cut.measured.windows]
    assert cut.measured.lengths is not None
    lengths = [w.samples * step for w, step in zip(cut.measured.windows, steps, strict=True)]
    assert min(lengths) >= 0.99 * cut.measured.lengths.shortest
    assert bends(whole()).max() > 1.0 > np.median(bends(whole()))
    assert bends(cut).max() < 1.0


def test_windows_that_are_in_proportion_stay_whole() -> None:
    found = in_proportion(whole())
    lengths = np.array([w.samples for w in whole().measured.windows])
    assert np.all(found <= lengths) and np.mean(found == lengths) > 0.3
