"""A sequence of tests of a wall on rubber: what each layer has seen, and the specimen to use at a level of strain."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console
from typer.testing import CliRunner

import models
from diagnosis.answer.calibration import Calibration, calibrated_specimen, drifts_of, specimen_at
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
from rocking.commands.calibrate import profile_table
from tests.diagnosis.made import TIME_STEP, motion

PARAMETERS = {
    "wall_length": 0.72, "wall_height": 1.8, "wall_mass": 161.0, "top_mass": 5000.0, "top_length": 0.72,
    "top_height": 0.6, "layer_thickness": 0.01, "top_stiffness": 5e7, "base_damping": 6e5, "top_damping": 5e5,
}  # fmt: skip
WALL = Specimen("wall", "interface", PARAMETERS, calibrate={"base_stiffness": (2e7, 1e8)})
BLOCK = """title = "block"
model = "housner"
[parameters]
width = 0.25
height = 1.1
mass = 120.0
[tolerance]
width = 0.005
"""
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
    assert np.all(np.diff(values["closings"]) >= 0.0)


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
    assert calibrated_specimen(WALL, found).parameters["base_stiffness"] == 4.6e7
    with pytest.raises(InputError, match="beyond the tests"):
        specimen_at(WALL, found, "strain", 2.0 * float(high))


def test_a_strain_of_what_has_none_is_refused(found: Calibration) -> None:
    with pytest.raises(InputError, match="give 3 tests or more"):
        specimen_at(WALL, replace(found, drifts=()), "strain", 0.2)
    ran = CliRunner().invoke(app, ["calibrate", "wall.toml", "test.csv", "--at-strain", "0.2"])
    assert ran.exit_code == 2 and "--out" in ran.output


def test_a_level_that_no_test_reached_is_refused_where_nothing_drifts_too(found: Calibration) -> None:
    (drift,) = found.drifts
    constant = replace(found, drifts=(replace(drift, drifts=False),))
    assert specimen_at(WALL, constant, "strain", float(drift.curves[0].values[0])).parameters["base_stiffness"] > 0.0
    with pytest.raises(InputError, match="beyond the tests"):
        specimen_at(WALL, constant, "strain", 7.0)


def test_a_layer_that_drifts_with_nothing_that_is_told_is_refused(found: Calibration) -> None:
    """Two tests tell that it changes, and not with what: the value of all tests is that of none."""
    (drift,) = found.drifts
    other = replace(drift, parameter="top_stiffness", curves=())
    with pytest.raises(InputError, match="top_stiffness changes with nothing that these tests tell"):
        specimen_at(WALL, replace(found, drifts=(drift, other)), "strain", float(drift.curves[0].values[0]))


def test_tolerances_stay_about_what_was_measured() -> None:
    """Calibrated again and again, a width stays within what the laboratory knows of it."""
    block = parse_specimen(BLOCK)
    estimate = {"width": Estimate(0.2463, 0.2460, 0.2466, "m")}
    moved = calibrated_specimen(block, Calibration(estimate, np.eye(1), 0.1, 0.01, 1.0, 20))
    assert moved.parameters["width"] == 0.2463 and moved.measured == {"width": 0.25}
    assert parse_specimen(specimen_text(moved)) == moved
    again = calibrated_specimen(moved, Calibration(estimate, np.eye(1), 0.1, 0.01, 1.0, 20))
    for specimen in (moved, again):
        (unknown,) = of_specimen(specimen, models.get("housner"))
        assert unknown.prior == (0.25, 0.00125) and unknown.start == max(0.2463, unknown.low)
    with pytest.raises(InputError, match=r"\[measured\] height is not in \[tolerance\]"):
        parse_specimen(BLOCK + "[measured]\nheight = 1.1\n")


def test_profiles_are_legible_in_a_narrow_terminal(found: Calibration) -> None:
    at = np.array([0.0491, 0.0496, 0.0502])
    shown = Console(width=80, file=io.StringIO())
    shown.print(profile_table(replace(found, profiles={"base_stiffness": (at, np.array([3.9, 0.0, 4.1]))})))
    assert all(f"{value:.5g}" in shown.file.getvalue() for value in at)  # type: ignore[attr-defined]
