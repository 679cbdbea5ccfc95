"""A zero of the base accelerometer that drifts: an error of the recording, no missing physics."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from diagnosis.errors.adequacy import drifting_base
from diagnosis.errors.base_drift import SHARE
from diagnosis.errors.components import Component
from diagnosis.errors.draws import draw
from diagnosis.errors.drifts import BASE, columns, knots_of
from diagnosis.errors.model import Errors, disturbance_about, estimate, refitted
from diagnosis.errors.summary import summary
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.prediction import Predictor
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import Fitted
from diagnosis.fit.whitening import base_columns, responses
from diagnosis.search.candidates import candidates
from diagnosis.search.null import null_distribution
from diagnosis.search.screen import score
from grids.recordings.base import Recording
from tests.diagnosis.made import SPECIMEN, at_truth, recording, scattered

BASE_ALONE = (Component("base_drift", None, np.inf),)
SMOOTH = ("restitution", "viscous_damping", "velocity_restitution", "coulomb_damping", "tilt", "pivot_inset", "gain",
          "offset", "base_gain", "accelerometer_offset", "delay", "clock")  # fmt: skip


def drifting(name: str, seed: int, share: float) -> Recording:
    """The plain block's recording, its base read with a zero that swings by a ``share`` of the peak in nine seconds."""
    one = scattered(name, seed)
    base = one.channels["base_acceleration_x"]
    zero = share * np.max(np.abs(base)) * np.sin(2.0 * np.pi * one.time / 9.0 + seed)
    return replace(one, channels={**one.channels, "base_acceleration_x": base + zero})


@cache
def about(share: float) -> tuple[Fitted, Fitted, Errors]:
    """The base fit under white noise, the same under the errors estimated with it, and these."""
    first = base_fit(SPECIMEN, measure(SPECIMEN, [drifting(f"train_{k}", k, share) for k in (1, 6)]))
    return first, *refitted(first, disturbance_about(first))


def test_what_a_drift_leaves_is_what_the_model_does_with_that_base() -> None:
    """Columns of the knots against runs with the base changed by a line between them; near impacts they bend.

    In two recordings, of which the base of the second moves by less and is measured with more noise.
    """
    first, rng = scattered("train_1", 1), np.random.default_rng(3)
    base = first.channels["base_acceleration_x"]
    less = {**first.channels, "base_acceleration_x": 0.6 * base + 0.05 * rng.normal(size=base.size)}
    measured = measure(SPECIMEN, [first, replace(first, name="train_2", channels=less)])
    fitted, predictor = at_truth(measured), Predictor(measured)
    base = base_columns(predictor, responses(predictor, fitted.point))
    knots = knots_of(measured, BASE_ALONE)
    assert knots is not None
    values = np.where(knots.channel == BASE, rng.normal(size=knots.time.size), 0.0)
    found = columns(knots, values[:, None], measured, base)[..., 0]

    zeros = []
    for r, shaking in enumerate(measured.shakings):
        time = shaking.time_step * np.arange(shaking.horizontal.size)
        own = (knots.channel == BASE) & (knots.recording == r)
        peak = np.max(np.abs(shaking.horizontal))
        zeros.append(SHARE * peak * np.interp(time, knots.time[own], values[own]))

    def ran(sign: float) -> np.ndarray:
        pairs = zip(measured.shakings, zeros, strict=True)
        moved = [replace(shaking, horizontal=shaking.horizontal + sign * zero) for shaking, zero in pairs]
        return predictor.predict([fitted.point], moved)[0]

    expected = np.where(measured.mask, 0.5 * (ran(1.0) - ran(-1.0)), 0.0)
    assert np.max(np.abs(expected)) > 0.1 * float(measured.unit[0])
    assert np.sum((found - expected) ** 2) < 0.03**2 * np.sum(expected**2)


@pytest.mark.parametrize("share", [0.005, 0.01])
def test_its_size_is_told(share: float) -> None:
    _, fitted, errors = about(share)
    told, rms = summary(errors, fitted.measured).base_drift, share / np.sqrt(2.0)
    assert told is not None and 0.5 * rms < told < 2.0 * rms


def test_where_there_is_none_none_is_told() -> None:
    assert drifting_base(about(0.0)[2], 10.0) == 0.0


def test_a_tilt_is_no_drift_of_any_size() -> None:
    """Beyond what accelerometers do it stays to be explained: 65 remain, of a drift without bounds 53."""
    leaning = measure(SPECIMEN, [recording(f"train_{k}", k, {"tilt": {"tilt": 0.02}}) for k in (1, 6)])
    first = base_fit(SPECIMEN, leaning)
    fitted, _ = refitted(first, disturbance_about(first))
    (tilt,) = (c for c in candidates(leaning, SPECIMEN) if c.name == "tilt")
    assert score(linearise_about(fitted), [tilt])[0].statistic > 58.0


def test_draws_of_the_errors_hold_it() -> None:
    """Their mean square is that of the columns, noise of the base and drift, where sensors are exact."""
    _, fitted, errors = about(0.01)
    of_base = np.array([component.kind == "base_drift" for component in errors.components])
    alone = replace(errors, theta=np.where(of_base, errors.theta, 0.0))
    knots, rng = knots_of(fitted.measured, errors.components), np.random.default_rng(8)
    assert knots is not None
    drift = columns(knots, errors.prior.root(alone.theta), fitted.measured, errors.base)
    noise, mask = np.sum(errors.base**2, axis=-1), fitted.measured.mask
    found = np.mean([draw(alone, fitted.measured, rng) ** 2 for _ in range(200)], axis=0)
    assert np.sum(drift[mask] ** 2) > 2.0 * np.sum(noise[mask])
    assert np.sum(found[mask]) == pytest.approx(np.sum(noise[mask]) + np.sum(drift[mask] ** 2), rel=0.15)


def test_it_raises_no_alarm() -> None:
    """With the errors taken for white noise something would be missing; as they are, nothing is."""
    chance = {}
    for name, fitted in zip(("white", "estimated"), about(0.01), strict=False):
        opened = linearise_about(fitted)
        scores = score(opened, [c for c in candidates(fitted.measured, SPECIMEN) if c.name in SMOOTH])
        chance[name] = null_distribution(opened, scores).p_value(scores[0].statistic)
    assert chance["white"] < 1e-4
    assert chance["estimated"] > 0.01


def test_a_model_without_noise_of_the_base_has_none() -> None:
    fitted, _, errors = about(0.0)
    bare = estimate(fitted, np.zeros((*errors.base.shape[:3], 0)))
    assert not any(component.kind == "base_drift" for component in bare.components)
    assert drifting_base(bare, 10.0) is None
