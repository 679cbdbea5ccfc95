"""The linear algebra of a fit: derivatives, elimination of states, whitening."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.misfit import Misfit, answered, reduce
from diagnosis.fit.prediction import Predictor
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import TOLERANCE, Place, fit
from diagnosis.fit.starts import start_of
from diagnosis.fit.unknowns import fixed_values, of_specimen
from diagnosis.fit.whitening import (
    DISTURBANCE,
    DISTURBANCE_STEP,
    HALF_WIDTH,
    responses,
    sensor_noise_only,
    with_base_noise,
)
from diagnosis.search.candidates import candidates
from diagnosis.search.screen import at, score
from tests.diagnosis.made import SPECIMEN, recording


@pytest.fixture(scope="module")
def problem():
    measured = measure(SPECIMEN, [recording("a", 1), recording("b", 2)])
    fitted = base_fit(SPECIMEN, measured)
    return measured, fitted


def test_eliminating_the_states_is_the_full_least_squares(problem) -> None:
    _measured, fitted = problem
    linear = fitted.misfit.linearise(fitted.u + 0.3, fitted.states)
    reduced = reduce(linear)
    windows, samples = linear.residual.shape
    k, s = linear.by_unknown.shape[2], linear.by_state.shape[2]
    full = np.zeros((windows * samples, k + windows * s))
    for w in range(windows):
        rows = slice(w * samples, (w + 1) * samples)
        full[rows, :k] = linear.by_unknown[w]
        full[rows, k + w * s : k + (w + 1) * s] = linear.by_state[w]
    wanted = np.linalg.lstsq(full, -linear.residual.ravel(), rcond=None)[0]
    j, r = reduced.by_unknown.reshape(-1, k), reduced.residual.ravel()
    du = np.linalg.lstsq(j, -r, rcond=None)[0]
    np.testing.assert_allclose(du, wanted[:k], rtol=1e-7)


def test_states_that_a_window_tells_take_their_best_step_and_others_stay_together(problem) -> None:
    """Where two states act alike, only what the window tells of them moves: their sum, not each of them."""
    _measured, fitted = problem
    place = answered(Place.at(fitted.misfit, fitted.u + 0.3, fitted.states), fitted.misfit.predictor)
    change = place.change(0.0)
    ahead = place.linear.residual + place.linear.by_unknown @ change
    wanted = [-np.linalg.lstsq(b, r, rcond=None)[0] for b, r in zip(place.linear.by_state, ahead, strict=True)]
    largest = np.maximum(np.abs(fitted.states), fitted.measured.state_size)
    assert np.all(np.abs(place.shift(change) - wanted) < 0.01 * largest)
    columns = place.linear.by_state.copy()
    columns[..., 1] = columns[..., 0] * (largest[:, 0] / largest[:, 1])[:, None] * (1.0 + 1e-9)
    like = replace(place, linear=replace(place.linear, by_state=columns))
    moved = like.shift(change) / largest
    np.testing.assert_allclose(moved[:, 0], moved[:, 1], rtol=1e-5, atol=1e-9)
    left = ahead + np.einsum("wms,ws->wm", columns, moved * largest)
    along = np.einsum("wm,wm->w", columns[..., 0], ahead) ** 2 / np.sum(columns[..., 0] ** 2, axis=1)
    np.testing.assert_allclose(np.sum(left**2, axis=1), np.sum(ahead**2, axis=1) - along, rtol=1e-3)


def test_score_directions_are_finite_differences(problem) -> None:
    measured, fitted = problem
    opened = linearise_about(fitted)
    base = fitted.point
    smooth = ("restitution", "viscous_damping", "velocity_restitution", "tilt", "pivot_inset", "gain", "offset",
              "base_gain", "accelerometer_offset", "cross_axis", "delay", "clock", "drift",
              "degradation")  # fmt: skip
    found = {s.candidate.name: s for s in score(opened, candidates(measured, SPECIMEN))}
    for name in smooth:
        candidate = found[name].candidate
        null, step = candidate.null, np.zeros(len(candidate.unknowns))
        low, high = candidate.unknowns[0].bounds
        step[0] = 0.01 if null[0] < high else -0.01
        ends = [at(base, candidate, null + step), base]
        if low <= null[0] - step[0] <= high:
            ends[1] = at(base, candidate, null - step)
        width = step[0] * (1.0 if ends[1] is base else 2.0)
        r = fitted.misfit.residuals(ends)
        wanted = opened.reduced((r[0] - r[1]) / width)
        error = np.linalg.norm(found[name].column - wanted) / np.linalg.norm(wanted)
        assert error < 0.03, (name, error)


def test_gradient_of_the_loss(problem) -> None:
    _, fitted = problem
    misfit, u, states = fitted.misfit, fitted.u + np.array([0.4, -0.3]), fitted.states
    linear = misfit.linearise(u, states)
    weights = misfit.weights(linear.residual)
    rows, slopes = misfit.prior_rows(u)
    gradient = 2.0 * (np.einsum("w,wmi,wm->i", weights, linear.by_unknown, linear.residual) + slopes.T @ rows)
    for i in range(u.size):
        step = np.zeros(u.size)
        step[i] = 0.02
        slope = (misfit.loss(u + step, states) - misfit.loss(u - step, states)) / 0.04
        assert gradient[i] == pytest.approx(slope, rel=1e-3, abs=1e-3)


def test_whitening_is_the_inverse_root_of_the_covariance(problem) -> None:
    measured, _fitted = problem
    predictor = Predictor(measured)
    plain = Misfit(
        predictor, sensor_noise_only(predictor), of_specimen(SPECIMEN, measured.model), fixed_values(SPECIMEN)
    )
    response = responses(predictor, plain.point(start_of(plain.unknowns), measured.states))
    whitening = with_base_noise(predictor, response)
    w = 0
    n = measured.windows[w].samples
    recording_ = measured.recordings[0]
    floor = DISTURBANCE * np.max(np.abs(measured.shakings[0].horizontal))
    variance = (measured.base_noise[0] ** 2 * recording_.time_step + floor**2 * DISTURBANCE_STEP) / HALF_WIDTH
    g = response.values[w, 0, :n]
    cover = measured.sigma[w, 0] ** 2 * np.eye(n) + variance * g @ g.T
    unit = np.zeros((n, *measured.values.shape))
    unit[np.arange(n), w, 0, np.arange(n)] = 1.0
    averages = n // int(measured.strides[w])
    root = whitening(unit)[:, w, :averages].T
    np.testing.assert_allclose(root @ cover @ root.T, np.eye(averages), atol=1e-8)


def test_a_fit_with_nothing_ahead_ends_at_its_first_linearisation(problem, monkeypatch: pytest.MonkeyPatch) -> None:
    _measured, fitted = problem
    settled = fit(fitted.misfit, fitted.u, fitted.states)
    linearise, points = Misfit.linearising, []
    monkeypatch.setattr(Misfit, "linearising", lambda *given, **more: points.append(given) or linearise(*given, **more))
    again = fit(settled.misfit, settled.u, settled.states)
    assert len(points) == 1
    assert again.loss == pytest.approx(settled.loss, abs=1e-9)
    off = fit(settled.misfit, settled.u + 0.5, settled.states)
    assert len(points) >= 3  # from elsewhere it goes back
    assert off.loss < settled.loss + 5.0 * TOLERANCE
