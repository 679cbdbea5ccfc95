"""Fits side by side, and points with stages of their own: as one by one, each by a predictor with its stages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import Fitted, fit, fit_together
from diagnosis.fit.whitening import sensor_noise_only
from grids.stages import Stage
from models.base import FloatArray
from models.errors import InputError
from tests.diagnosis.fit import carried as wall
from tests.diagnosis.made import SPECIMEN, TRUE, recording

BLOCK = {"restitution.factor_on_housner": 0.9, "offset.offset_over_peak": 0.02, "delay.delay": 0.004}
Staged = Mapping[str, Sequence[Stage]]
WALL = {**wall.TRUE, **wall.HARDENING}


def of(name: str, *spans: tuple[float, float], recording: str = "b") -> Staged:
    return {name: tuple(Stage(recording, *span) for span in spans)}


SETTINGS: list[Staged] = [
    {},
    of("restitution", (4.0, 6.0)), of("restitution", (3.2, 6.4)), of("restitution", (0.0, 0.0)),
    of("restitution", (2.5, 4.0), (5.0, 7.0)),
    of("offset", (4.0, np.inf)), of("offset", (5.0, np.inf)),
    of("delay", (4.0, np.inf)),
    {**of("restitution", (4.5, np.inf)), **of("offset", (4.0, 6.0))},
]  # fmt: skip
"""Laws and instruments; at instants of their own, often changing in a window, and in another order."""


def each_by_its_own_predictor(predictor: Predictor, points: Sequence[Point]) -> FloatArray:
    own = [replace(predictor, stages=point.stages or {}) for point in points]
    return np.stack([one.predict([replace(p, stages=None)])[0] for one, p in zip(own, points, strict=True)])


def test_points_with_stages_of_their_own_are_predicted_as_by_predictors_with_these() -> None:
    measured = measure(SPECIMEN, [recording("a", 1), recording("b", 2)], reference_peak=0.03)
    states = measured.states
    points = [Point({**TRUE, **BLOCK}, states + 1e-4 * k, stages=one) for k, one in enumerate(SETTINGS)]
    predictor = Predictor(measured, stages=of("restitution", (0.0, 3.0), recording="a"))
    found = predictor.predict(points)
    np.testing.assert_allclose(found, each_by_its_own_predictor(predictor, points), rtol=0.0, atol=1e-12)
    assert np.unique(found.reshape(len(points), -1), axis=0).shape[0] == len(points)
    plain = Point({**TRUE, **BLOCK}, states)
    np.testing.assert_array_equal(predictor.predict([points[1], plain])[1], predictor.predict([plain])[0])


def test_a_point_is_predicted_alike_in_any_company() -> None:
    """Of instruments that move the base otherwise and look ahead further, of recordings sampled otherwise."""
    slow = recording("b", 2)
    slow = replace(
        slow, time_step=2.0 * slow.time_step, time=slow.time[::2],
        channels={name: x[::2] for name, x in slow.channels.items()},
    )  # fmt: skip
    measured = measure(SPECIMEN, [recording("a", 1), slow, recording("c", 3)], reference_peak=0.03)
    sensors: list[dict[str, float]] = [
        {}, {"filter.corner_hz": 20.0, "filter.order": 2.0}, {"filter.corner_hz": 9.0, "filter.order": 4.0},
        {"filter.high_pass_hz": 0.3, "filter.order": 1.0}, {"clock.rate": 2e-3}, {"delay.delay": 0.007},
        {"filter.corner_hz": 30.0, "filter.order": 2.0, "base_gain.gain": 0.05},
        {"filter.corner_hz": 12.0, "filter.order": 2.0, "filter.zero_phase": 1.0},
    ]  # fmt: skip
    points = [Point({**TRUE, **one}, measured.states + 1e-4 * k) for k, one in enumerate(sensors)]
    predictor = Predictor(measured)
    together, mask = predictor.predict(points), measured.mask
    for one, point in zip(together, points, strict=True):
        np.testing.assert_allclose(one[mask], predictor.predict([point])[0][mask], rtol=0.0, atol=1e-13)


def test_a_filter_looks_ahead_of_the_end_of_a_motion_to_where_the_block_stayed() -> None:
    """Not to zero rotation: what is recorded in a window at its end is near that of a motion that goes on."""
    measured = measure(SPECIMEN, [recording("a", 1)], reference_peak=0.03)
    window, (whole,) = measured.windows[3], measured.shakings
    cut = replace(whole, horizontal=whole.horizontal[: window.first + window.samples])
    point, only = (
        Point({**TRUE, "filter.corner_hz": 9.0, "filter.order": 4.0}, measured.states),
        np.arange(len(measured.windows)) == 3,
    )
    wanted, found = (
        Predictor(replace(measured, shakings=(motion,))).predict([point], only=only)[0, 3][measured.mask[3]]
        for motion in (whole, cut)
    )
    rate = np.max(np.abs(np.diff(wanted)))
    assert 0.0 < np.max(np.abs(found - wanted)) < 2.0 * rate < 0.5 * np.abs(wanted[-1])


def test_what_a_wall_carries_is_that_of_the_points_stages() -> None:
    measured = wall.measured_of(wall.seen(wall.made(tuple(wall.HARDENING.items())), {}))
    spans = [(2.0, np.inf), (3.1, np.inf), (0.0, 2.6), (0.0, 0.0)]
    points = [Point(WALL, measured.states, stages=of("hardening", span, recording="shake_1")) for span in spans]
    found = Predictor(measured).predict(points)
    np.testing.assert_allclose(found, each_by_its_own_predictor(Predictor(measured), points), rtol=0.0, atol=1e-12)
    assert np.max(np.abs(found[0] - found[1])) > 1e-5


def misfits(predictor: Predictor, values: Mapping[str, float], settings: Sequence[Staged]) -> list[Misfit]:
    whitening = sensor_noise_only(predictor)
    return [Misfit(replace(predictor, stages=one), whitening, (), values) for one in settings]


@pytest.mark.parametrize("iterations", [0, 4])
def test_fits_side_by_side_are_those_one_by_one(iterations: int) -> None:
    measured = measure(SPECIMEN, [recording("a", 1), recording("b", 2)], reference_peak=0.03)
    several = misfits(Predictor(measured), {**TRUE, **BLOCK}, SETTINGS)
    together = fit_together(several, np.zeros(0), measured.states, iterations)
    for one, misfit in zip(together, several, strict=True):
        alone = fit(misfit, np.zeros(0), measured.states, iterations)
        assert one.misfit.predictor.stages == misfit.predictor.stages
        assert one.loss == pytest.approx(alone.loss, rel=1e-9)
        np.testing.assert_allclose(one.states, alone.states, rtol=1e-6, atol=1e-12)
    assert len({round(one.loss, 3) for one in together}) == len(SETTINGS)


@cache
def two_with_unknowns() -> tuple[Fitted, list[Misfit]]:
    """A base fit, and its misfit with a restitution that acts for two seconds, or never."""
    measured = measure(SPECIMEN, [recording("b", 2)], reference_peak=0.03)
    base = base_fit(SPECIMEN, measured)
    fixed = {**base.misfit.fixed, "restitution.factor_on_housner": 0.95}
    settings = [of("restitution", (4.0, 6.0)), of("restitution", (0.0, 0.0))]
    predictor = base.misfit.predictor
    several = [replace(base.misfit, fixed=fixed, predictor=replace(predictor, stages=one)) for one in settings]
    return base, several


def test_fits_with_unknowns_side_by_side_end_where_each_does() -> None:
    base, several = two_with_unknowns()
    for one, misfit in zip(fit_together(several, base.u, base.states), several, strict=True):
        alone = fit(misfit, base.u, base.states)
        assert one.loss == pytest.approx(alone.loss, rel=1e-6)
        np.testing.assert_allclose(one.u, alone.u, atol=1e-5)


def test_parameters_of_one_that_the_model_refuses_leave_the_others_as_they_are(monkeypatch: pytest.MonkeyPatch) -> None:
    base, several = two_with_unknowns()
    away = base.u + 1.0
    begun, alone = fit(several[0], away, base.states, 0), fit(several[1], away, base.states, 1)
    predict, first = Predictor.predict, True

    def refused(self: Predictor, points: Any, *rest: Any, **more: Any) -> Any:
        nonlocal first
        if any(point.stages == several[0].predictor.stages for point in points):
            if not first:
                raise InputError("not these")
            first = False
        return predict(self, points, *rest, **more)

    monkeypatch.setattr(Predictor, "predict", refused)
    stays, other = fit_together(several, away, base.states, 1)
    assert stays.loss == pytest.approx(begun.loss, rel=1e-9)
    assert other.loss == pytest.approx(alone.loss, rel=1e-9)
    assert other.loss < fit(several[1], away, base.states, 0).loss - 1.0
