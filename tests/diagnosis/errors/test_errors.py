"""A laboratory's errors: estimated as they are, whitened, and no alarm where nothing is missing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.signal import butter, lfilter, sosfilt

from diagnosis.errors import model
from diagnosis.errors.adequacy import inadequacy, repeatability
from diagnosis.errors.hum import in_the_samples
from diagnosis.errors.likelihood import Piece, climbed, maximise, whitened
from diagnosis.errors.lines import lines
from diagnosis.errors.model import Errors, calibrated, disturbance_about, estimate, refitted
from diagnosis.errors.scattered import Events, least_loss
from diagnosis.errors.summary import summary
from diagnosis.errors.words import error_lines
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.setup import base_fit, measure
from diagnosis.search.candidates import candidates
from diagnosis.search.evidence import evidence
from diagnosis.search.found import Search
from diagnosis.search.null import null_distribution
from diagnosis.search.refit import Explanation
from diagnosis.search.screen import score
from grids.recordings.base import Recording
from tests.diagnosis.made import SPECIMEN, TIME_STEP, scattered
from tests.diagnosis.made import searched as searched_to_the_end


def autoregressive(rng: np.random.Generator, n: int) -> np.ndarray:
    """AR(1) with .85 at 200 Hz, of unit deviation."""
    noise = lfilter([1.0], [1.0, -0.85], rng.normal(size=n + 200))[200:]
    return noise * np.sqrt(1.0 - 0.85**2)


def drifting(rng: np.random.Generator, n: int) -> np.ndarray:
    """White noise on a drift to half its deviation."""
    return rng.normal(size=n) + np.linspace(0.0, 0.5, n)


def hum(rng: np.random.Generator, n: int) -> np.ndarray:
    return rng.normal(size=n) + np.sin(2.0 * np.pi * 12.3 * 0.005 * np.arange(n))


SMOOTH = ("restitution", "viscous_damping", "velocity_restitution", "coulomb_damping", "tilt", "pivot_inset", "gain",
          "offset", "base_gain", "accelerometer_offset", "delay", "clock")  # fmt: skip
CASES = {
    "white": (0.0, None),
    "scatter": (0.015, None),
    "autoregressive": (0.0, autoregressive),
    "drift": (0.0, drifting),
    "hum": (0.0, hum),
}


@cache
def about(case: str) -> tuple[Explanation, Explanation, Errors]:
    """The base fit under white noise, the same under the errors estimated with it, and these."""
    scatter, errors = CASES[case]
    noise = 0.005 if scatter else 0.01
    measured = measure(SPECIMEN, [scattered(f"train_{k}", k, scatter, noise, errors) for k in (1, 6)])
    first = base_fit(SPECIMEN, measured)
    fitted, found = refitted(first, disturbance_about(first))
    return Explanation((), first), Explanation((), fitted), found


def test_the_likelihood_does_not_depend_on_where_a_fit_left_the_drift() -> None:
    """A drift has its price in the likelihood of the errors: that of the fit must not come on top."""
    explanation, errors = about("drift")[1:]
    fitted = explanation.fitted
    level = fitted.misfit.level
    assert level.size
    elsewhere = replace(fitted, misfit=fitted.misfit.at_level(level + 3.0))
    found = [estimate(one, errors.base, errors) for one in (fitted, elsewhere)]
    assert found[0].loss == pytest.approx(found[1].loss, abs=1e-9)


def test_steps_towards_scattered_impacts_are_judged_at_the_drift_that_they_leave() -> None:
    _, base, errors = about("drift")
    misfit, fitted = errors.repeating(base.fitted.misfit), base.fitted
    now = Events(fitted.u, fitted.states, errors.kicks, np.zeros(errors.kicks.window.size))
    least = least_loss(misfit, now)
    best = minimize(lambda level: misfit.at_level(level).loss(fitted.u, fitted.states), np.zeros(misfit.level.size))
    assert least == pytest.approx(best.fun, abs=1e-3) and least < misfit.loss(fitted.u, fitted.states) - 1.0


@pytest.mark.parametrize(("rate", "share"), [(50.0, 0.4), (80.0, 0.4), (100.0, 0.5)])
def test_hum_is_sought_up_to_half_the_sampling_rate(rate: float, share: float) -> None:
    """From there on another line makes the same samples."""
    rng, time = np.random.default_rng(2), np.arange(80) / rate
    hum = share * rate
    piece = Piece(
        time, np.zeros(80, int), np.cos(2.0 * np.pi * hum * time + 0.4) + 0.1 * rng.normal(size=80),
        np.ones((80, 1)), np.zeros((80, 1)), 0.01 * np.eye(80), (),
    )  # fmt: skip
    found = [line.scale for line in lines([piece] * 3, 1, np.zeros(0), np.ones(3))]
    assert found[0] == pytest.approx(hum, abs=0.1) and max(found) < 0.5 * rate + 1e-9


def test_where_no_band_is_left_around_a_line_it_is_told_by_itself() -> None:
    """A slow sensor: from 6 to 7 Hz nothing is far enough from a line to be held against it."""
    time = np.arange(80) / 14.0
    for amplitude, expected in ((0.0, []), (1.0, [pytest.approx(6.6, abs=0.1)])):
        rng = np.random.default_rng(4)
        residual = amplitude * np.cos(2.0 * np.pi * 6.6 * time) + 0.1 * rng.normal(size=80)
        piece = Piece(
            time, np.zeros(80, int), residual, np.ones((80, 1)), np.zeros((80, 1)), 0.01 * np.eye(80), (),
        )  # fmt: skip
        assert [one.scale for one in lines([piece] * 3, 1, np.zeros(0), np.ones(3))] == expected


@pytest.mark.parametrize("amplitude", [0.0, 0.3])
def test_noise_that_is_denser_over_a_band_is_no_hum_but_a_line_in_it_is(amplitude: float) -> None:
    """Behind a steep filter errors are denser, up to its corner, than the estimated components have them."""
    rng, time = np.random.default_rng(7), np.arange(100) / 100.0
    low_pass = butter(4, 16.0, fs=100.0, output="sos")
    pieces = []
    for _ in range(30):
        filtered = sosfilt(low_pass, rng.normal(size=300))[200:]
        line = amplitude * np.cos(2.0 * np.pi * (11.0 * time + rng.uniform()))
        pieces.append(
            Piece(
                time, np.zeros(100, int), 0.3 * filtered / np.std(filtered) + line,
                np.ones((100, 1)), np.zeros((100, 1)), 0.02 * np.eye(100), (),
            )
        )  # fmt: skip
    found = [one.scale for one in lines(pieces, 1, np.zeros(0), np.ones(30))]
    assert found == ([] if amplitude == 0.0 else [pytest.approx(11.0, abs=0.1)])


@pytest.mark.parametrize("frequency", [30.0, 50.0, 60.0, 73.0])
def test_hum_is_told_at_its_own_frequency_and_size(frequency: float) -> None:
    """The mains among them: means of two samples at 200 Hz show 60 Hz at 40 Hz, and six tenths of it."""

    def hummed(rng: np.random.Generator, n: int) -> np.ndarray:
        return rng.normal(size=n) + 3.0 * np.sin(2.0 * np.pi * frequency * TIME_STEP * np.arange(n) + 0.3)

    recordings = [scattered(f"train_{k}", k, 0.0, 0.01, hummed) for k in (1, 6)]
    level = np.mean([0.03 * float(np.max(np.abs(r.channels["rotation_1"]))) for r in recordings])
    measured = measure(SPECIMEN, recordings)
    first = base_fit(SPECIMEN, measured)
    fitted, errors = refitted(first, disturbance_about(first))
    (line,) = summary(errors, fitted.measured).channels[0].hum
    assert line.frequency == pytest.approx(frequency, abs=0.05)
    assert line.amplitude == pytest.approx(level, rel=0.35)


def test_impacts_that_scatter_are_told() -> None:
    found = repeatability(about("scatter")[2], "impacts")
    assert found is not None and found.clear
    assert found.low95 < 0.015 < found.high95 < 0.03
    assert found.low95 < found.estimate < found.high95


@pytest.mark.parametrize(("scatter", "beyond"), [(0.02, False), (0.05, True)])
def test_impacts_that_scatter_by_more_than_may_be_are_warned_of(scatter: float, beyond: bool) -> None:
    """The warning and what the search does with such impacts have one limit."""
    measured = measure(SPECIMEN, [scattered(f"train_{k}", k, scatter, 0.005) for k in (1, 6)])
    first = base_fit(SPECIMEN, measured)
    fitted, errors = refitted(first, disturbance_about(first))
    told = summary(errors, fitted.measured)
    assert told.scatter is not None and told.scatter.at_limit is beyond is not errors.scatters
    assert ("scatter by 3.0% or more" in " ".join(error_lines(told))) is beyond


def test_impacts_that_repeat_do_not_scatter() -> None:
    found = repeatability(about("white")[2], "impacts")
    assert found is not None and not found.clear and found.high95 < 0.02


@pytest.mark.parametrize("case", CASES)
def test_the_model_is_adequate_where_nothing_is_missing(case: str) -> None:
    left = inadequacy(about(case)[2])
    assert left.judged and not left.large


@pytest.mark.parametrize(("bumps", "large"), [(1, False), (8, True)])
def test_one_window_does_not_make_the_model_inadequate(bumps: int, large: bool) -> None:
    errors = about("white")[2]
    pieces = list(errors.pieces)
    for k, sign in zip(range(bumps), (1.0, -1.0) * 4, strict=False):
        bump = 8.0 * sign * np.exp(-0.5 * ((pieces[k].time - pieces[k].time.mean()) / 0.1) ** 2)
        pieces[k] = replace(pieces[k], residual=pieces[k].residual + bump)
    theta, _ = climbed(pieces, errors.prior, np.maximum(errors.theta, 1e-3), errors.weights, 0, 10)
    theta, state = maximise(pieces, errors.prior, theta, errors.weights)
    bumped = replace(errors, pieces=tuple(pieces), theta=theta, deviance=state.deviance)
    assert inadequacy(bumped).large is large


@pytest.mark.parametrize("case", ["autoregressive", "hum", "scatter"])
def test_whitened_residuals_are_white(case: str) -> None:
    """Lags one to five within chance of zero, and of variance one."""
    errors = about(case)[2]
    products, squares, count = np.zeros(5), 0.0, 0
    for piece in errors.pieces:
        w = whitened(piece, errors.theta)
        squares += float(w @ w)
        count += w.size - piece.by_state.shape[1]
        products += [float(w[lag:] @ w[:-lag]) for lag in range(1, 6)]
    assert abs(squares / count - 1.0) < 0.1
    assert np.all(np.abs(products / squares) < 4.0 / np.sqrt(count))


def test_words_name_what_there_is() -> None:
    said = {case: " ".join(error_lines(summary(about(case)[2], about(case)[0].measured))) for case in CASES}
    assert "Impacts repeat to 1." in said["scatter"] and "Impacts repeat" not in said["white"]
    assert "hum at 12.3 Hz" in said["hum"]
    assert "hum" not in said["white"] and "low frequencies" in said["autoregressive"]


@pytest.mark.parametrize("case", ["scatter", "autoregressive"])
def test_errors_of_a_laboratory_raise_no_alarm(case: str) -> None:
    """With the errors taken for white noise something would be missing; as they are, nothing is."""
    first, base, _ = about(case)
    chance = {}
    for name, start in (("white", first), ("estimated", base)):
        opened = linearise_about(start.fitted)
        smooth = [c for c in candidates(start.measured, SPECIMEN) if c.name in SMOOTH]
        scores = score(opened, smooth)
        chance[name] = null_distribution(opened, scores).p_value(scores[0].statistic)
    assert chance["white"] < 1e-4
    assert chance["estimated"] > 0.01


def searched(
    errors: Callable[[np.random.Generator, int], np.ndarray] | None, names: tuple[str, ...], zero: float = 0.0
) -> Search:
    """``zero``: what the sensor reads at rest over the peak of the first recording."""
    recordings = [scattered(f"train_{k}", k, errors=errors) for k in (1, 6)]
    reads = zero * np.max(np.abs(recordings[0].channels["rotation_1"]))
    seen = [{**one.channels, "rotation_1": one.channels["rotation_1"] + reads} for one in recordings]
    measured = measure(SPECIMEN, [replace(one, channels=new) for one, new in zip(recordings, seen, strict=True)])
    fitted, found = calibrated(SPECIMEN, measured)
    tried = tuple(c for c in candidates(measured, SPECIMEN) if c.name in names)
    return searched_to_the_end(Search(Explanation((), fitted), tried, found))


LEANING = ("offset", "tilt", "accelerometer_offset", "drift", "gain")


def test_a_drift_is_no_offset() -> None:
    """Twice the drift of a poor sensor, the same way in both recordings."""
    found = searched(lambda rng, n: rng.normal(size=n) + np.linspace(0.0, 1.0, n), LEANING)
    assert found.best is None or found.best.names == ("drift",)
    assert not {"offset", "tilt", "accelerometer_offset"} & {r.names[0] for r in found.singles if found.gain(r) > 15.0}


def test_an_offset_without_drift_keeps_its_name() -> None:
    found = searched(None, LEANING, zero=0.03)
    assert found.best is not None and found.best.names == ("offset",)
    estimate = found.best.fitted.values["offset.offset_over_peak"]
    assert estimate == pytest.approx(0.03, abs=0.012)
    assert evidence(found)[0] > 15.0


def test_windows_shorter_than_the_lags_of_the_figure_are_summed_too(monkeypatch: pytest.MonkeyPatch) -> None:
    _, on, errors = about("white")
    lags = min(piece.time.size for piece in errors.pieces) + 12
    monkeypatch.setattr("diagnosis.errors.summary.LAGS", lags)
    correlation = summary(errors, on.measured).channels[0].spectrum.correlation
    assert len(correlation) == lags and np.all(np.isfinite(correlation))


def test_errors_are_estimated_anew_where_nothing_is_still_any_more(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is still depends on the fit; without it the model's own error cannot be told from the sensors'."""
    fitted = base_fit(SPECIMEN, measure(SPECIMEN, [scattered("a", 6)]))
    first = estimate(fitted, disturbance_about(fitted))
    monkeypatch.setattr(model, "stills", lambda *_: ())
    again = estimate(fitted, first.base, first)
    kinds = {c.kind for c in first.components} - {c.kind for c in again.components}
    assert kinds == {"inadequacy"} and again.theta.size == len(again.components)


@pytest.mark.parametrize(("rates", "hummed"), [((200.0, 250.0), (1, 1)), ((200.0, 400.0), (1, 0)), ((200.0,), (1,))])
def test_a_line_of_the_means_is_found_in_the_recording_that_holds_it(
    rates: tuple[float, ...], hummed: tuple[int, ...]
) -> None:
    """At other sampling rates it makes other lines; in ten minutes it is a needle."""
    rng, recordings = np.random.default_rng(5), []
    for rate, holds in zip(rates, hummed, strict=True):
        time = np.arange(round((600.0 if len(rates) == 1 else 20.0) * rate)) / rate
        values = rng.normal(size=time.size) + 3.0 * holds * np.sin(2.0 * np.pi * 60.007 * time)
        recordings.append(Recording("run", 1.0 / rate, time, {"rotation_1": values}))
    seen = replace(measure(SPECIMEN, [scattered("train_1", 1, 0.0)]), recordings=tuple(recordings))
    true, left = in_the_samples(seen, "rotation_1", 40.0)
    assert true == pytest.approx(60.0, abs=0.02) and left == pytest.approx(np.cos(0.3 * np.pi), abs=1e-3)
