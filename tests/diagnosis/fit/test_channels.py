"""What each channel adds, against dense covariances of the channels that are left."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from diagnosis.errors.model import calibrated
from diagnosis.fit.channels import added_by_channels
from diagnosis.fit.intervals import covariances
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.setup import measure
from diagnosis.fit.whitening import Whitening
from grids.recordings.base import Recording
from grids.recordings.levels import level_by_level
from tests.diagnosis.buildings import SPECIMEN, made

WINDOWS, CHANNELS, SAMPLES = 2, 3, 7


def whitening(rng: np.random.Generator, correlated: bool, columns: np.ndarray) -> Whitening:
    """Of errors of the sensors, independent or correlated, and of ``columns`` (W, C, n, K) that channels share."""
    shape = (WINDOWS, CHANNELS, SAMPLES)
    plain = cast(Any, SimpleNamespace(averaged=lambda values: values, compared=np.ones(shape, bool)))
    sensor = 1.0 + rng.random(shape)
    if correlated:
        factors = np.tril(0.2 * rng.normal(size=(*shape, SAMPLES)))
        sensor = factors * (1.0 - np.eye(SAMPLES)) + sensor[..., None] * np.eye(SAMPLES)
    return Whitening(plain, sensor).with_columns(columns)


@pytest.mark.parametrize("correlated", [False, True])
def test_the_errors_of_the_channels_that_are_left_are_their_part_of_the_covariance(correlated: bool) -> None:
    rng = np.random.default_rng(3)
    columns = rng.normal(size=(WINDOWS, CHANNELS, SAMPLES, 4))
    whole = whitening(rng, correlated, columns)
    unit = np.eye(CHANNELS * SAMPLES).reshape(-1, 1, CHANNELS, SAMPLES) * np.ones((WINDOWS, 1, 1))
    root = np.moveaxis(whole.of_averages(unit), 0, -1)
    precision = np.swapaxes(root, 1, 2) @ root
    for gone in range(CHANNELS):
        kept = np.repeat(np.arange(CHANNELS) != gone, SAMPLES)
        less = np.moveaxis(whole.without(gone).of_averages(unit), 0, -1)
        found = np.swapaxes(less, 1, 2) @ less
        for w in range(WINDOWS):
            left = np.linalg.inv(np.linalg.inv(precision[w])[np.ix_(kept, kept)])
            np.testing.assert_allclose(found[w][np.ix_(kept, kept)], left, rtol=1e-9, atol=1e-12)
            assert not np.any(found[w][~kept])


def test_intervals_grow_as_those_of_a_fit_without_the_channel() -> None:
    """A slab and a storey on rubber, whose own errors the two levels share."""
    storey = {"levels": 2.0, "storey_stiffness": 60.0, "storey_damping": 0.5}
    ranged = {**SPECIMEN.calibrate, "storey_stiffness": (20.0, 200.0)}
    parameters = {**SPECIMEN.parameters, **{name: x for name, x in storey.items() if name not in ranged}}
    specimen = replace(SPECIMEN, parameters=parameters, calibrate=ranged)
    runs = [level_by_level(made("small", 1.0, 1, **storey)), level_by_level(made("large", 2.5, 2, **storey))]
    fitted, errors = calibrated(specimen, measure(specimen, runs))
    assert fitted.misfit.whitening.shared is None and fitted.misfit.whitening.basis is not None
    found = added_by_channels(fitted)
    assert set(found) == {"level_displacement_x_0", "level_displacement_x_1"}
    whole = np.sqrt(np.diag(covariances(fitted)[1]))
    for gone, wider in found.items():
        left = measure(specimen, [without(run, gone) for run in runs], fitted.measured.reference_peak)
        predictor = replace(fitted.misfit.predictor, measured=left)
        misfit = Misfit(
            predictor, errors.expected(predictor, fitted.point), fitted.misfit.unknowns, fitted.misfit.fixed
        )
        alone = np.sqrt(np.diag(covariances(replace(fitted, misfit=misfit))[1]))
        np.testing.assert_allclose(list(wider.values()), alone / whole, rtol=0.05)
    # the storey's spring is told by what moves above the slab
    assert found["level_displacement_x_1"]["storey_stiffness"] > 1.5


def without(run: Recording, channel: str) -> Recording:
    return replace(run, channels={name: x for name, x in run.channels.items() if name != channel})
