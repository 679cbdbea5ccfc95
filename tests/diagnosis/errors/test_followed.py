"""Windows of two bodies end where a change of what is fitted, by its deviation, is out of proportion."""

from __future__ import annotations

import numpy as np

from diagnosis.errors.followed import followed, in_proportion
from diagnosis.fit.solver import Fitted
from tests.diagnosis.fit.test_solver import of_a_stack

CHANGE = 0.5
"""Deviations of a state, along one that a window's own samples tell worst."""


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
    cut = followed(of_a_stack())
    assert cut.measured.mask.sum() < of_a_stack().measured.mask.sum()
    assert {w.first for w in cut.measured.windows} <= {w.first for w in of_a_stack().measured.windows}
    steps = [cut.measured.recordings[w.recording].time_step for w in cut.measured.windows]
    assert cut.measured.lengths is not None
    lengths = [w.samples * step for w, step in zip(cut.measured.windows, steps, strict=True)]
    assert min(lengths) >= 0.99 * cut.measured.lengths.shortest
    assert bends(of_a_stack()).max() > 1.0 > np.median(bends(of_a_stack()))
    assert bends(cut).max() < 1.0


def test_windows_that_are_in_proportion_stay_of_a_stack() -> None:
    found = in_proportion(of_a_stack())
    lengths = np.array([w.samples for w in of_a_stack().measured.windows])
    assert np.all(found <= lengths) and np.mean(found == lengths) > 0.3
