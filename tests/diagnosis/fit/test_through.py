"""Models that run from rest through whole recordings: predictions, fits, errors in proportion to the motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import models
from diagnosis.answer.calibration import calibrate
from diagnosis.data.measured import left_out
from diagnosis.data.stretches import averages
from diagnosis.errors.own import AS_MOTION, own_error
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.setup import as_recorded, measure
from diagnosis.fit.unknowns import fixed_values
from diagnosis.fit.whitening import sensor_noise_only
from grids.instruments.integrated_displacement import high_passed
from grids.recordings.base import Recording
from grids.specimen import Specimen
from models.errors import InputError
from models.kinematics import Place
from models.shaking import Shaking

STEP, COUNT, CORNER = 0.01, 4000, 0.12
TRUE = {"levels": 2.0, "total_mass": 2.0, "storey_stiffness": 900.0, "storey_damping": 2.0, "rubber_thickness": 0.2}
BEARINGS = {"bearing_stiffness": 14.0, "bearing_damping": 0.9}
SPECIMEN = Specimen(
    title="two levels", model="isolated", parameters=TRUE,
    calibrate={"bearing_stiffness": (4.0, 40.0), "bearing_damping": (0.1, 4.0)},
)  # fmt: skip


def made(noise: float, integrated: bool, seed: int = 1) -> Recording:
    """A simulated test: a base with energy up to 5 Hz, displacements measured or integrated."""
    rng = np.random.default_rng(seed)
    time = STEP * np.arange(COUNT)
    spectrum = np.fft.rfft(rng.normal(size=COUNT))
    frequency = np.fft.rfftfreq(COUNT, STEP)
    spectrum *= (frequency > 0.15) * np.exp(-0.5 * (frequency / 2.5) ** 2)
    envelope = np.clip(time - 3.0, 0.0, 4.0) / 4.0 * np.exp(-np.clip(time - 22.0, 0.0, None) / 4.0)
    base = np.fft.irfft(spectrum, COUNT) * envelope
    base *= 2.0 / np.max(np.abs(base))
    ran = models.get("isolated").simulate({**TRUE, **BEARINGS}, Shaking(STEP, base), duration=time[-1])
    x, a = (np.asarray(ran.channels[f"level_{what}_x"]) for what in ("displacement", "acceleration"))
    if integrated:
        x = high_passed(high_passed(x, CORNER, STEP), CORNER, STEP)
    x = x + noise * np.std(x) * rng.normal(size=x.shape)
    channels = {"base_acceleration_x": base, "level_displacement_x": x, "level_acceleration_x": a}
    return Recording("made", STEP, time, channels, ("0", "1"))


@pytest.mark.parametrize("integrated", [False, True])
def test_stretches_are_cut_from_one_run_and_means_of_it(integrated: bool) -> None:
    recording = made(0.0, integrated)
    specimen, seen = as_recorded(SPECIMEN, [recording])
    assert bool(seen) == integrated
    m = measure(specimen, [recording])
    channels = [f"level_displacement_x_{k}" for k in range(2)]
    assert list(m.channels) == (channels if integrated else [f"level_acceleration_x_{k}" for k in range(2)] + channels)
    assert m.states.shape == (len(m.windows), 0) and m.mask.all(axis=1).sum() == m.recordings[0].time.size
    predictor = Predictor(m)
    found = predictor.predict([Point({**fixed_values(specimen), **BEARINGS}, m.states)])[0]
    shown = [m.channels.index(c) for c in channels]
    error = np.where(m.mask, found - m.values, 0.0)[:, shown]
    assert np.sqrt(np.mean(error**2)) < 0.01 * np.sqrt(np.mean(m.values[:, shown] ** 2))


def with_instruments(recording: Recording, noise: float) -> Recording:
    """The recording with a potentiometer on the bearings, a geophone on the roof and load cells under the bearings."""
    places = {
        "potentiometer": Place("displacement", 1), "geophone": Place("velocity", 2), "cells": Place("force", 1),
    }  # fmt: skip
    base = recording.channels["base_acceleration_x"]
    ran = models.get("isolated").simulate({**TRUE, **BEARINGS}, Shaking(STEP, base), duration=recording.time[-1])
    rng, read = np.random.default_rng(7), {}
    for name, place in places.items():
        true = place.read(ran.channels, STEP, (base, np.zeros_like(base)))
        read[name] = true + noise * np.std(true) * rng.normal(size=true.size)
    return replace(recording, channels={**recording.channels, **read}, places=places)


@pytest.mark.parametrize("integrated", [False, True])
def test_instruments_at_the_levels_are_compared_as_they_read(integrated: bool) -> None:
    """A potentiometer measures displacements as they are, whether or not those of the levels were integrated."""
    specimen, _ = as_recorded(SPECIMEN, [with_instruments(made(0.0, integrated), 0.0)])
    m = measure(specimen, [with_instruments(made(0.0, integrated), 0.0)])
    found = Predictor(m).predict([Point({**fixed_values(specimen), **BEARINGS}, m.states)])[0]
    for name in ("potentiometer", "geophone", "cells"):
        k = m.channels.index(name)
        error, size = (np.where(m.mask, x, 0.0)[:, k] for x in (found - m.values, m.values))
        assert np.sqrt(np.mean(error**2)) < 0.01 * np.sqrt(np.mean(size**2))
    fitted = calibrate(SPECIMEN, [with_instruments(made(0.01, integrated), 0.01)], profile=False)
    assert fitted.misfit < 0.04
    for name, true in BEARINGS.items():
        estimate, rounding = fitted.parameters[name], 1e-3 * true  # of runs on means
        assert estimate.low95 - rounding < true < estimate.high95 + rounding


def held(recording: Recording, *levels: int) -> Recording:
    """The recording of some levels alone, in that order."""
    rows = {name: x[list(levels)] if x.ndim == 2 else x for name, x in recording.channels.items()}
    return replace(recording, channels=rows, levels=tuple(map(str, levels)))


def test_the_roof_alone_is_fitted_to_its_noise() -> None:
    found = calibrate(SPECIMEN, [held(made(0.01, integrated=True), 1)], profile=False)
    assert found.misfit < 0.04
    for name, true in BEARINGS.items():
        estimate, rounding = found.parameters[name], 1e-3 * true  # of runs on means
        assert estimate.low95 - rounding < true < estimate.high95 + rounding, (name, estimate)


def test_recordings_are_compared_by_the_levels_that_all_of_them_hold() -> None:
    whole = made(0.0, integrated=True)
    turned, roof = replace(held(whole, 1, 0), name="turned"), replace(held(whole, 1), name="roof")
    both, one = measure(SPECIMEN, [whole, turned]), measure(SPECIMEN, [turned, roof])
    assert one.channels == tuple(c for c in both.channels if c.endswith("_1"))
    for m in (both, one):
        of = [m.values[m.recording_of == r] for r in range(2)]
        np.testing.assert_array_equal(of[0], of[1])
    assert left_out([turned, roof]) == {f"level_{what}_x_0": ("roof",) for what in ("displacement", "acceleration")}


def test_a_rigid_body_is_compared_with_the_slab_of_a_building() -> None:
    body = replace(SPECIMEN, parameters={"levels": 1.0, "total_mass": 2.0, "rubber_thickness": 0.2})
    whole = made(0.0, integrated=False)
    both, alone = measure(body, [whole]), measure(body, [held(whole, 0)])
    assert both.channels == alone.channels and all(c.endswith("_0") for c in both.channels)
    np.testing.assert_array_equal(both.values, alone.values)
    with pytest.raises(InputError, match=r"is of level 1, .* has 1 here, numbered from 0, of which 0 is not recorded"):
        measure(body, [held(whole, 1)])


def test_levels_that_the_model_or_another_recording_has_not_are_refused() -> None:
    whole = made(0.0, integrated=True)
    with pytest.raises(InputError, match=r"level_displacement_x_2 of made is of level 2, .* isolated has 2 here"):
        measure(SPECIMEN, [replace(whole, levels=("1", "2"))])
    with pytest.raises(InputError, match=r"level_displacement_x is of no level that all of made, roof hold"):
        measure(SPECIMEN, [held(whole, 0), replace(held(whole, 1), name="roof")])


def test_means_are_those_of_the_samples() -> None:
    np.testing.assert_allclose(averages(np.arange(11.0), 4), [1.5, 5.5])


def test_calibration_recovers_bearings_through_the_filter_within_the_intervals() -> None:
    found = calibrate(SPECIMEN, [made(0.01, integrated=True)], profile=False)
    for name, true in BEARINGS.items():
        estimate = found.parameters[name]
        rounding = 1e-3 * true  # of runs on means
        assert estimate.low95 - rounding < true < estimate.high95 + rounding, (name, estimate)
        assert estimate.high95 - estimate.low95 < 0.1 * true
    assert found.misfit < 0.04


def test_a_model_s_own_error_goes_with_the_recording_and_is_shared_by_its_levels() -> None:
    small = made(0.0, integrated=False)
    large = replace(small, name="large", channels={name: 3.0 * x for name, x in small.channels.items()})
    m = measure(SPECIMEN, [small, large])
    columns = own_error(m, 0.3)
    of = [np.flatnonzero(m.recording_of == r)[0] for r in range(2)]
    np.testing.assert_allclose(columns[of[1]], 3.0 * columns[of[0]], atol=1e-12)
    variance = np.sum(columns[of[0]] ** 2, axis=-1)[m.mask[of[0]]].reshape(len(m.channels), -1)
    np.testing.assert_allclose(variance, np.repeat(variance[:, :1], variance.shape[1], axis=1), rtol=2e-3)
    one, other = (columns[of[0], m.channels.index(f"level_displacement_x_{k}")] for k in range(2))
    correlation = np.sum(one * other) / np.sqrt(np.sum(one**2) * np.sum(other**2))
    assert correlation == pytest.approx(1.0, abs=1e-9)


def test_a_model_s_own_error_lasts_as_long_in_a_recording_of_other_samples() -> None:
    m = measure(SPECIMEN, [made(0.0, integrated=False), replace(made(0.0, integrated=False, seed=2), name="other")])
    first, second = m.recordings
    m = replace(m, recordings=(first, replace(second, time_step=2.0 * first.time_step)))
    columns = own_error(m, 0.3)
    for r, recording in enumerate(m.recordings):
        one = columns[np.flatnonzero(m.recording_of == r)[1], 0]
        covariance = one @ one.T
        expected = np.exp(-0.5 * (5.0 * recording.time_step / 0.3) ** 2)
        assert np.mean(np.diagonal(covariance, 5)) / covariance[0, 0] == pytest.approx(expected, rel=0.01)


def test_a_model_s_own_error_is_correlated_as_the_motion_is() -> None:
    m = measure(SPECIMEN, [made(0.0, integrated=False)])
    w, c = 1, m.channels.index("level_displacement_x_0")
    columns = own_error(m, AS_MOTION)[w, c] / m.unit[c]
    covariance = columns @ columns.T
    x = m.recordings[0].channels["level_displacement_x_0"]
    for lag in (0, 3, 10):
        mean = float(np.mean(np.diagonal(covariance, lag)))
        assert mean == pytest.approx(float(x[lag:] @ x[: x.size - lag] / (x @ x)), abs=0.01)


def test_a_loss_without_free_states_is_the_squared_misfit_at_first() -> None:
    specimen, _ = as_recorded(SPECIMEN, [made(0.01, integrated=True)])
    m = measure(specimen, [made(0.01, integrated=True)])
    predictor = Predictor(m)
    misfit = Misfit(predictor, sensor_noise_only(predictor), (), {**fixed_values(specimen), **BEARINGS})
    residual = misfit.residuals([misfit.point(np.zeros(0), m.states)])[0]
    assert np.mean(residual[m.compared.reshape(residual.shape)] ** 2) < 0.2


def test_without_the_leading_channel_nothing_is_compared() -> None:
    bare = made(0.0, integrated=False)
    channels = {name: x for name, x in bare.channels.items() if name != "level_displacement_x"}
    with pytest.raises(InputError, match="level_displacement_x is missing in made: model isolated is compared by it"):
        measure(SPECIMEN, [replace(bare, channels=channels)])
