"""Impacts that scatter: found one by one, and the law about which they scatter with them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from diagnosis.data.measured import AsItWas
from diagnosis.errors.followed import followed
from diagnosis.errors.kicks import kicks
from diagnosis.errors.model import Errors, calibrated, refitted
from diagnosis.errors.scattered import Events, known_changes, linear_about
from diagnosis.fit.intervals import covariances
from diagnosis.fit.setup import base_fit, measure
from diagnosis.fit.solver import Fitted
from diagnosis.fit.whitening import sensor_noise_only
from grids.recordings.base import Recording
from models.shaking import Shaking
from tests.diagnosis import made

SCATTER = 0.02
SEEDS = (4, 13)
"""Of motions under which the block stays up."""
RESTED = round(1.5 / made.TIME_STEP)
SPECIMEN = replace(made.SPECIMEN, calibrate={"restitution": (0.7, 1.0)})


class Kept:
    """Normal numbers that are remembered."""

    def __init__(self, seed: int) -> None:
        self.rng, self.drawn = np.random.default_rng(seed), []

    def normal(self) -> float:
        self.drawn.append(float(self.rng.normal()))
        return self.drawn[-1]


@cache
def recorded(seed: int) -> tuple[Recording, np.ndarray, np.ndarray]:
    """A recording with noise of .3 % of its peak, samples after its impacts and the changes of the rate there."""
    lead = np.zeros(RESTED)
    shaking = Shaking(made.TIME_STEP, np.concatenate([lead, made.motion(seed).horizontal, lead]))
    kept = Kept(seed)
    rotation = made._with_kicks(shaking, SCATTER, kept)  # type: ignore[arg-type]
    after = np.flatnonzero(rotation[1:] * rotation[:-1] < 0.0)[: len(kept.drawn)] + 1
    seen = made._seen(f"run_{seed}", seed, shaking, rotation, {}, 0.003)
    return seen, after, SCATTER * np.array(kept.drawn[: after.size])


@cache
def scene() -> tuple[Fitted, Errors]:
    return calibrated(SPECIMEN, measure(SPECIMEN, [recorded(seed)[0] for seed in SEEDS]))


def test_pulses_change_the_rate_after_an_event() -> None:
    """Where all events of a window are changed at once the run with pulses is that restarted after each."""
    measured = measure(made.SPECIMEN, [made.recording("a", 1)])
    fitted = base_fit(made.SPECIMEN, measured)
    predictor, point = fitted.misfit.predictor, fitted.point
    found = kicks(predictor, point)
    changes = 0.01 * np.random.default_rng(0).normal(size=found.window.size)
    events = Events(fitted.u, fitted.states, found, changes)
    known = AsItWas(events.pulses(measured), np.zeros(measured.values.shape))
    moved = replace(predictor, measured=replace(measured, as_it_was=known)).predict([point])[0]
    by = np.zeros((len(measured.windows), found.columns.shape[-1]))
    by[found.window, found.place] = changes
    ahead = np.einsum("wcnk,wk->wcn", found.columns, by)
    actual = np.where(measured.mask, moved - predictor.predict([point])[0], 0.0)
    own = np.unique(found.window)
    each = np.sqrt(((actual - ahead)[own] ** 2).sum(axis=(1, 2)) / (ahead[own] ** 2).sum(axis=(1, 2)))
    assert own.size >= 6 and np.median(each) < 0.1  # a pulse ends two samples after the event


def test_changes_of_single_impacts_are_found() -> None:
    fitted, errors = scene()
    changes = known_changes(fitted.measured, errors.kicks)
    pairs = []
    for r, seed in enumerate(SEEDS):
        _, after, true = recorded(seed)
        for k in np.flatnonzero(fitted.measured.recording_of[errors.kicks.window] == r):
            nearest = int(np.argmin(np.abs(after - errors.kicks.sample[k])))
            if abs(after[nearest] - errors.kicks.sample[k]) <= 3:
                pairs.append((true[nearest], changes[k]))
    true, found = np.array(pairs).T
    assert true.size > 12
    assert np.corrcoef(true, found)[0, 1] > 0.8


def test_an_estimate_about_the_events_as_they_were_stays() -> None:
    """Linear about a motion without scatter, it went back and forth by up to four of its standard deviations."""
    fitted, errors = scene()
    again, _ = refitted(fitted, errors.base, errors, 1)
    # of both: where an impact comes or goes within a difference step one of them is far too small
    sd = np.max([np.sqrt(np.diag(covariances(one)[0])) for one in (fitted, again)], axis=0)
    assert np.all(np.abs(again.u - fitted.u) < 0.5 * sd)
    assert abs(errors.scatter - SCATTER) < 0.5 * SCATTER


def test_windows_end_where_small_changes_no_longer_leave_small_ones() -> None:
    """A change of the impact law by .3 % up and down leaves the same in what is left of them, within the noise."""
    whole = base_fit(SPECIMEN, measure(SPECIMEN, [recorded(21)[0]]))
    cut = followed(whole)
    assert all(a.first in [b.first for b in whole.measured.windows] for a in cut.measured.windows)
    assert cut.measured.mask.sum() < whole.measured.mask.sum()

    def bent(fitted: Fitted) -> np.ndarray:
        m, point, predictor = fitted.measured, fitted.point, fitted.misfit.predictor
        e = point.values["restitution"]
        points = [replace(point, values={**point.values, "restitution": e * share}) for share in (1.003, 0.997, 1.0)]
        up, down, plain = predictor.predict(points)
        return np.max(np.abs(up + down - 2.0 * plain) * m.mask, axis=(1, 2)) / m.units[:, 0]

    assert bent(whole).max() > 5.0
    assert bent(cut).max() < 1.0


def test_pulses_that_stood_for_what_is_gone_go_too() -> None:
    """A mechanism that is found takes what passed for scatter: the motion is no longer one with these changes."""
    measured = measure(SPECIMEN, [made.scattered("still", 6, noise=0.003)])
    fitted, errors = calibrated(SPECIMEN, measured)
    assert not errors.scatters and fitted.measured.as_it_was is None
    changes = np.full(errors.kicks.window.size, 0.01)
    other = linear_about(fitted.misfit, Events(fitted.u, fitted.states, errors.kicks, changes))
    again, found = refitted(replace(fitted, misfit=other), errors.base, errors)
    assert again.measured.as_it_was is None and not found.scatters
    sd = np.sqrt(np.diag(covariances(fitted)[0]))
    assert np.all(np.abs(again.u - fitted.u) < 0.2 * sd)


def test_averages_of_residuals_have_these_residuals() -> None:
    """Of errors that are coloured, scatter and come from the base, and of white ones."""
    fitted, errors = scene()
    assert errors.whitening.sensor.ndim == 4 and errors.whitening.basis is not None
    for whitening in (errors.whitening, sensor_noise_only(fitted.misfit.predictor).with_columns(errors.base)):
        compared = fitted.measured.compared.reshape(fitted.measured.compared.shape[0], -1)
        rows = np.random.default_rng(1).normal(size=(3, *compared.shape)) * compared
        averages = whitening.averages(rows)
        assert averages.shape[-2:] == fitted.measured.compared.shape[1:]
        np.testing.assert_allclose(whitening.of_averages(averages), rows, atol=1e-9)
