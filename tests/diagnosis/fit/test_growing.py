"""Windows of two bodies grow as long as what is fitted acts in proportion in them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from diagnosis.answer.diagnose import diagnose
from diagnosis.answer.heldout import as_far_as_followed
from diagnosis.data.measured import Measured
from diagnosis.fit.growing import DEVIATIONS, FIRST, SHORTEST, changed_points, cut_again, in_proportion
from diagnosis.fit.intervals import covariances
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Predictor
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import Fitted, fit_thoroughly
from diagnosis.fit.unknowns import Unknown
from diagnosis.fit.whitening import sensor_noise_only
from grids.specimen import Specimen
from models.base import FloatArray
from tests.diagnosis.made import TIME_STEP
from tests.diagnosis.stacks import ON_TOP, rocking_on_top

FALLS = 7
LENGTHS = ("wall_length", "wall_height", "top_length", "top_height")
STACK = Specimen("stack", "stacked", ON_TOP, dict.fromkeys(LENGTHS, 0.005))


@cache
def stack(*seeds: int) -> Fitted:
    """The base fit of two recordings of a stack as its specimen says."""
    return base_fit(STACK, measure(STACK, [rocking_on_top(seed, True) for seed in seeds]))


def bends(fitted: Fitted) -> np.ndarray:
    """What is out of proportion (W,), over the noise, the states changed along their worst-known direction."""
    m, misfit = fitted.measured, fitted.misfit
    by_state = misfit.linearise(fitted.u, fitted.states).by_state
    _, values, axes = np.linalg.svd(by_state, full_matrices=False)
    step = DEVIATIONS * axes[:, -1] / values[:, -1, None]
    states = (fitted.states + step, fitted.states - step, fitted.states)
    up, down, plain = misfit.predictor.predict([misfit.point(fitted.u, x) for x in states])
    bend = (up + down - 2.0 * plain) / (2.0 * m.units[:, :, None]) * m.mask
    return np.asarray(np.linalg.norm(bend, axis=(1, 2)))


def test_a_parameter_that_changes_nothing_is_no_obstacle() -> None:
    """The corner of a pitch that the base does not make, as a restitution of a joint that never closes would be."""
    fitted = stack(5, 6)
    idle = Unknown("table_pitch.low_pass_hz", "Hz", 0.0, 2.0, 1.0, 1.0)
    misfit = replace(fitted.misfit, unknowns=(*fitted.misfit.unknowns, idle))
    wider = replace(fitted, misfit=misfit, u=np.append(fitted.u, 1.0))
    moved = [point.values["table_pitch.low_pass_hz"] for point in changed_points(wider)]
    assert moved and np.all(np.isfinite(moved)) and np.ptp(moved) < 1e-6


def test_what_a_window_holds_is_in_proportion() -> None:
    """But for what the last round has bent; in windows of full length at the same parameters far less is."""
    found = stack(5, 6)
    whole = measure(STACK, found.measured.recordings)
    longest = {(w.recording, w.first): w for w in whole.windows}
    used = [longest[w.recording, w.first] for w in found.measured.windows]
    shares = np.array([a.samples / b.samples for a, b in zip(found.measured.windows, used, strict=True)])
    assert SHORTEST <= shares.min() < 1.0 == shares.max() and np.mean(shares > FIRST) > 0.8
    full = fit_thoroughly(cut_again(found.misfit, used), found.u, found.states)
    assert bends(full).max() > 1.5 * DEVIATIONS > bends(found).max()
    assert np.median(bends(found)) < 0.5 * DEVIATIONS


class Falling(Predictor):
    """Predictions of which the first but one cannot go on from sample `FALLS` of the first window."""

    def predict(self, *args: Any, **more: Any) -> FloatArray:
        found = super().predict(*args, **more).copy()
        found[1, 0, 0, FALLS:] = np.nan
        return found


def test_a_window_that_is_in_proportion_stays_and_one_in_which_a_body_may_fall_ends_there() -> None:
    found = stack(5, 6)
    lengths = np.array([w.samples for w in found.measured.windows])
    assert np.mean(in_proportion(found, found.misfit) == lengths) > 0.9
    falling = Falling(found.measured, found.misfit.predictor.options)
    assert in_proportion(found, replace(found.misfit, predictor=falling))[0] == FALLS < lengths[0]


@pytest.mark.parametrize("seeds", [(1, 2), (3, 4), (5, 6), (7, 8)])
def test_a_stack_is_as_its_specimen_says_within_its_intervals(seeds: tuple[int, int]) -> None:
    """Windows of full length end in valleys that are narrow by chance: 5.6 and 4.4 deviations off in two of them."""
    found = stack(*seeds)
    sandwich, laplace = covariances(found)
    deviation = np.sqrt(np.maximum(np.diag(sandwich), np.diag(laplace)))
    true = [unknown.coordinate(ON_TOP[unknown.name]) for unknown in found.misfit.unknowns]
    assert np.max(np.abs(found.u - true) / deviation) < 2.5
    assert found.loss < 1.2 * found.measured.count.sum()


def test_recordings_held_out_are_compared_in_windows_of_the_same_kind() -> None:
    """As long as what the states change is in proportion: beyond that a prediction is worth nothing."""
    base = stack(5, 6)
    whole = measure(STACK, [rocking_on_top(8, True)])
    held = as_far_as_followed(whole, base)
    assert 0.3 * whole.mask.sum() < held.mask.sum() < 0.95 * whole.mask.sum()
    assert {(w.recording, w.first) for w in held.windows} <= {(w.recording, w.first) for w in whole.windows}

    def fitted(measured: Measured) -> Fitted:
        predictor = Predictor(measured)
        plain = Misfit(predictor, sensor_noise_only(predictor), (), base.point.values)
        return fit_thoroughly(plain, np.zeros(0), measured.states)

    assert bends(fitted(whole)).max() > 1.5 * DEVIATIONS > bends(fitted(held)).max()


def test_a_whole_diagnosis_compares_what_can_be_followed() -> None:
    """Nothing is missing in the stack; what is shown of the recording held out is in the windows that grew."""
    found = diagnose(STACK, stack(5, 6).measured.recordings, [rocking_on_top(8, True)])
    assert found.verdict == "nothing_missing"
    held = as_far_as_followed(measure(STACK, [rocking_on_top(8, True)]), stack(5, 6))
    shown = next(w for w in found.windows if w.held_out)
    assert len(shown.start) == len(held.windows)
    assert np.sum(shown.end - shown.start) == pytest.approx(sum(w.samples for w in held.windows) * TIME_STEP)


def test_states_go_along_with_a_change_of_the_parameters() -> None:
    """What is left of it in a window is what no state could take up: it is not for states that a window ends."""
    found = stack(5, 6)
    linear = found.misfit.linearise(found.u, found.states)
    basis = np.linalg.qr(linear.by_state)[0]
    points = changed_points(found)[2 * found.states.shape[1] :]
    left = found.misfit.residuals(points)
    changes = left[0::2] - left[1::2]
    along = np.linalg.norm(np.einsum("wms,pwm->pws", basis, changes), axis=2) / np.linalg.norm(changes, axis=2)
    assert len(points) == 2 * found.u.size and np.median(along) < 0.3
