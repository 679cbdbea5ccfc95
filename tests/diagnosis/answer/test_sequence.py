"""A sequence of tests of a wall on rubber: what each layer has seen, and the specimen to use at a level of strain."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

import models
from diagnosis.answer.calibration import Calibration, drifts_of, specimen_at, specimen_of
from diagnosis.fit.intervals import Estimate
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.prediction import Predictor
from diagnosis.fit.setup import measure
from diagnosis.fit.solver import Fitted
from diagnosis.fit.starts import start_of
from diagnosis.fit.unknowns import fixed_values, of_specimen
from diagnosis.fit.whitening import sensor_noise_only
from grids.recordings.base import Recording
from grids.specimen import Specimen, parse_specimen
from grids.write_specimen import specimen_text
from models.errors import InputError
from rocking.commands import app
from tests.diagnosis.made import TIME_STEP, motion

PARAMETERS = {
    "wall_length": 0.72, "wall_height": 1.8, "wall_mass": 161.0, "top_mass": 5000.0, "top_length": 0.72,
    "top_height": 0.6, "layer_thickness": 0.01, "top_stiffness": 5e7, "base_damping": 6e5, "top_damping": 5e5,
}  # fmt: skip
WALL = Specimen("wall", "interface", PARAMETERS, calibrate={"base_stiffness": (2e7, 1e8)})
STIFFNESS = {"low": 6e7, "strong": 4e7, "low again": 4e7}
LEVELS = {"low": 0.4, "strong": 2.0, "low again": 0.4}


def fitted(name: str) -> Fitted:
    """The fit of one test, its stiffness known."""
    shaking = motion(1, duration=5.0, pga=LEVELS[name])
    true = {**PARAMETERS, "base_stiffness": STIFFNESS[name]}
    ran = models.get("interface").simulate(true, shaking, duration=shaking.duration)
    channels = {"base_acceleration_x": shaking.horizontal}
    rng = np.random.default_rng(1)
    for channel in ("rotation_1", "rotation_2"):
        x = np.asarray(ran.channels[channel])
        channels[channel] = x + 0.01 * np.max(np.abs(x)) * rng.normal(size=x.size)
    measured = measure(WALL, [Recording(name, TIME_STEP, shaking.time, channels)])
    predictor = Predictor(measured)
    unknowns = of_specimen(WALL, measured.model)
    misfit = Misfit(predictor, sensor_noise_only(predictor), unknowns, fixed_values(WALL))
    u = start_of(unknowns)
    u[0] = unknowns[0].coordinate(STIFFNESS[name])
    return Fitted(misfit, u, measured.states, np.zeros(len(measured.windows)), 0.0)


def around(value: float) -> Estimate:
    return Estimate(value, value * 0.97, value * 1.03, "N m-2")


@pytest.fixture(scope="module")
def found() -> Calibration:
    by_recording = {name: {"base_stiffness": around(value)} for name, value in STIFFNESS.items()}
    drifts = drifts_of(by_recording, [fitted(name) for name in STIFFNESS])
    joint = {"base_stiffness": around(4.6e7)}
    return Calibration(joint, np.eye(1), 0.1, 0.01, 1.0, 20, by_recording=by_recording, drifts=drifts)


def test_a_layer_remembers_its_largest_strain_and_counts_its_closings(found: Calibration) -> None:
    (drift,) = found.drifts
    values = {c.exposure.name: c.values for c in drift.curves}
    assert drift.drifts and drift.with_what[0].exposure.name == "strain"
    assert values["strain"][1] == values["strain"][2] > 2.0 * values["strain"][0]
    assert np.all(np.diff(values["cycles"]) >= 0.0)


def test_the_specimen_at_a_strain_stands_between_the_tests_and_reads_back(found: Calibration) -> None:
    low, high = (found.drifts[0].curves[0].values[k] for k in (0, 1))
    stiffness = [
        specimen_at(WALL, found, "strain", float(level)).parameters["base_stiffness"]
        for level in np.linspace(low, high, 5)
    ]
    assert np.all(np.diff(stiffness) < 0.0)
    assert stiffness[0] == pytest.approx(6e7, rel=0.01) and stiffness[-1] == pytest.approx(4e7, rel=0.01)
    written = specimen_at(WALL, found, "strain", float(low))
    assert parse_specimen(specimen_text(written)) == written and not written.calibrate
    assert specimen_of(WALL, found).parameters["base_stiffness"] == 4.6e7
    with pytest.raises(InputError, match="beyond the tests"):
        specimen_at(WALL, found, "strain", 2.0 * float(high))


def test_a_strain_of_what_has_none_is_refused(found: Calibration) -> None:
    with pytest.raises(InputError, match="give 3 tests or more"):
        specimen_at(WALL, replace(found, drifts=()), "strain", 0.2)
    ran = CliRunner().invoke(app, ["calibrate", "wall.toml", "test.csv", "--at-strain", "0.2"])
    assert ran.exit_code == 2 and "--out" in ran.output
