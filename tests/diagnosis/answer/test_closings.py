"""A layer that wears as its joint opens and closes, from simulated tests to the specimen after a number of closings."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner, Result

import models
from diagnosis import calibrate
from diagnosis.answer.calibration import Calibration, specimen_at
from grids.specimen import Specimen, read_specimen
from grids.write_specimen import specimen_text
from models.errors import InputError
from rocking.commands import app
from tests.diagnosis.made import motion

PARAMETERS = {
    "wall_length": 0.72, "wall_height": 1.8, "wall_mass": 161.0, "top_mass": 5000.0, "top_length": 0.72,
    "top_height": 0.6, "layer_thickness": 0.01, "top_stiffness": 5e7, "base_damping": 6e5, "top_damping": 5e5,
}  # fmt: skip
WALL = Specimen("wall", "interface", PARAMETERS, calibrate={"base_stiffness": (2e7, 1e8)})
LEVELS = (1.2, 1.5, 1.5, 1.5)
"""Largest acceleration of the table by test, m s-2."""
NOISE = 0.01
"""Of the peak of each rotation."""
ROUNDS = 6
"""Until the stiffness of a test and the closings at its end belong together."""
COLUMNS = """between_samples = "linear"
time = { column = "time", unit = "s" }

[columns]
base_acceleration_x = { column = "base_acceleration_x", unit = "m s-2" }
rotation_1 = { column = "rotation_1", unit = "rad" }
rotation_2 = { column = "rotation_2", unit = "rad" }
"""
FILES = [f"test_{k}.csv" for k in range(1, len(LEVELS) + 1)]


def worn(closings: float) -> float:
    """Stiffness of the base layer, N m-2."""
    return 7e7 * (1.0 - 0.4 * -np.expm1(-closings / 30.0))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wall and the recordings of its tests; each has the stiffness that its closings leave at its end."""
    path = tmp_path_factory.mktemp("sequence")
    (path / "wall.toml").write_text(specimen_text(WALL))
    before = 0.0
    for k, (name, level) in enumerate(zip(FILES, LEVELS, strict=True)):
        base, after = motion(1, duration=3.0, pga=level), before
        for _ in range(ROUNDS):
            wall = {**PARAMETERS, "base_stiffness": worn(after)}
            ran = models.get("interface").simulate(wall, base, duration=base.duration)
            after = before + float(ran.outputs["impacts_base"])
        before, rng = after, np.random.default_rng(k)
        rotations = [np.ravel(ran.channels[f"rotation_{body}"]) for body in (1, 2)]
        seen = [x + NOISE * np.max(np.abs(x)) * rng.normal(size=x.size) for x in rotations]
        table = np.stack([base.time, base.horizontal, *seen], axis=1)
        head = "time,base_acceleration_x,rotation_1,rotation_2"
        np.savetxt(path / name, table, fmt=["%.3f", "%.6f", "%.4e", "%.4e"], delimiter=",", header=head, comments="")
        (path / name).with_suffix(".toml").write_text(COLUMNS)
    return path


@pytest.fixture(scope="module")
def found(folder: Path) -> Calibration:
    """Fitted once for all tests, without the profiles."""
    return calibrate(folder / "wall.toml", [folder / name for name in FILES], profile=False)


@pytest.fixture
def said(folder: Path, found: Calibration, monkeypatch: pytest.MonkeyPatch) -> Path:
    """In the folder of the recordings, the fit done."""
    monkeypatch.chdir(folder)
    monkeypatch.setattr("diagnosis.calibrate", lambda *_, **__: found)
    return folder


def rocking(*words: str) -> Result:
    return CliRunner().invoke(app, ["calibrate", "wall.toml", *FILES, *words])


def test_the_tests_tell_closings_from_strain(found: Calibration) -> None:
    (drift,) = found.drifts
    values = {c.exposure.name: c.values for c in drift.curves}
    assert drift.drifts and [c.exposure.name for c in drift.with_what] == ["closings"]
    assert set(values) == {"strain", "closings"} and np.all(np.diff(values["closings"]) >= 1.0)
    for test, closings in zip(drift.estimates.values(), values["closings"], strict=True):
        assert test.estimate == pytest.approx(worn(closings), rel=0.01)


def test_the_wall_after_a_number_of_closings_is_written(said: Path, found: Calibration) -> None:
    values = found.drifts[0].curves[0].values
    between = round(float(values[0] + values[-1]) / 2)
    assert between not in values
    ran = rocking("--out", "worn.toml", "--at-closings", str(between))
    assert ran.exit_code == 0, ran.output
    assert f"closings of the base layer so far, {values[0]:.3g} to {values[-1]:.3g}" in " ".join(ran.stdout.split())
    written = read_specimen(said / "worn.toml")
    assert written.title == f"wall, after {between} closings" and not written.calibrate
    assert written.parameters["base_stiffness"] == pytest.approx(worn(between), rel=0.01)
    assert written.parameters["base_stiffness"] != pytest.approx(found.parameters["base_stiffness"].estimate, rel=0.01)


@pytest.mark.usefixtures("said")
@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("--at-closings 900", "closings = 900 lies beyond the tests"),
        ("--at-closings 0", "closings = 0 lies beyond the tests"),
        ("--at-strain 0.5", "changes with closings of the base layer so far and not with the strain"),
    ],
)
def test_what_the_tests_do_not_tell_is_one_sentence(words: str, sentence: str) -> None:
    ran = rocking("--out", "none.toml", *words.split())
    assert ran.exit_code == 2 and sentence in ran.stderr and ran.stderr.count("error:") == 1
    assert not Path("none.toml").exists()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("--at-closings 9 --at-strain 0.1 --out none.toml", "--at-strain and --at-closings each say"),
        ("--at-closings 9", "--at-closings says which specimen to write: name its file with --out"),
        ("--at-closings -9 --out none.toml", "closings = -9: give a number of zero or more"),
        ("--at-strain -0.1 --out none.toml", "strain = -0.1: give a number of zero or more"),
        ("--at-strain nan --out none.toml", "strain = nan: give a number of zero or more"),
    ],
)
def test_what_no_tests_could_tell_is_refused_before_the_work(
    words: str, sentence: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    monkeypatch.setattr("diagnosis.calibrate", None)
    ran = rocking(*words.split())
    assert ran.exit_code == 2 and sentence in ran.stderr and ran.stderr.count("error:") == 1, ran.output


def test_an_exposure_of_which_nothing_is_known_is_refused(found: Calibration) -> None:
    with pytest.raises(InputError, match="'temperature' is not followed over a sequence of tests: give strain or clos"):
        specimen_at(WALL, found, "temperature", 20.0)
    with pytest.raises(InputError, match="3 tests or more tell what a layer was then; given are 2"):
        two = {name: found.by_recording[name] for name in list(found.by_recording)[:2]}
        specimen_at(WALL, replace(found, by_recording=two), "closings", 9.0)
    with pytest.raises(
        InputError, match="closings is not followed over a sequence of tests for 'housner': leave it out"
    ):
        specimen_at(replace(WALL, model="housner"), found, "closings", 9.0)
