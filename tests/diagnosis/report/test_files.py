"""What a diagnosis writes: JSON by the design's schema, a specimen that reads back, every curve."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import get_args
from xml.etree import ElementTree

import numpy as np
import pytest
import xarray as xr

from diagnosis.answer.result import Effect, Verdict
from diagnosis.fit.intervals import Estimate
from diagnosis.report import diagnosis_json, extend
from diagnosis.report.earlier import remove_earlier
from diagnosis.report.pictures import write_figures
from diagnosis.report.svg import Picture
from grids.write_specimen import specimen_text
from models.shaking import Shaking
from rocking import read_specimen
from study.history import simulate_specimen
from tests.diagnosis.report.example import AT, FORCE, REPEAT, diagnosis, recordings, specimen
from tests.diagnosis.report.schema import AnswerFile


@pytest.mark.parametrize("verdict", get_args(Verdict))
def test_json_is_what_the_design_says(verdict: Verdict) -> None:
    found = diagnosis(verdict)
    read = AnswerFile.model_validate_json(diagnosis_json(found))
    assert read.verdict == verdict and read.statement == found.statement
    assert [e.name for e in read.effects] == [e.name for e in found.effects]
    assert [place.share for place in read.located] == [place.share for place in found.located]


def test_json_knows_no_infinity_and_takes_numpy_numbers() -> None:
    bend = Effect(
        "wall_flexibility", "wall_flexibility", {"first_frequency": Estimate(40.0, 12.0, np.inf, "Hz")},
        np.float64(31.0), np.float64(0.002),
    )  # fmt: skip
    further = {**REPEAT, "recording": {**REPEAT["recording"], "scale": np.float32(0.5)}, "static_test": ""}
    law = {**FORCE, "terms": [{**FORCE["terms"][0], "at": np.array(AT)}]}
    found = replace(
        diagnosis(), effects=(bend,), holdout=None, next_experiment=further, missing_force=law, finished=False
    )
    text = diagnosis_json(found)
    read = AnswerFile.model_validate_json(text)
    assert read.effects[0].parameters["first_frequency"].high95 is None
    assert read.fit.holdout is None
    assert read.missing_force is not None and read.missing_force.terms[0].at == AT
    assert read.next_experiment is not None and read.next_experiment.recording is not None
    assert read.next_experiment.recording.scale == 0.5 and read.next_experiment.static_test is None  # none is known
    assert json.loads(text)["provenance"]["finished"] is False


def test_json_tells_bounds_and_noise() -> None:
    hit = Effect("tilt", "tilt", {"tilt": Estimate(0.05, 0.04, 0.05, "rad", "high")}, 31.0, 0.002)
    read = AnswerFile.model_validate_json(diagnosis_json(replace(diagnosis(), effects=(hit,))))
    assert read.effects[0].parameters["tilt"].at_bound == "high"
    assert read.fit.holdout is not None
    assert [read.fit.train.noise_floor, read.fit.holdout.noise_floor] == [0.027, 0.028]


def test_written_json_is_the_same(answer: Path) -> None:
    assert (answer / "diagnosis.json").read_text("utf-8") == diagnosis_json(diagnosis())


def test_a_second_diagnosis_takes_the_figures_of_the_first_away_and_no_others(tmp_path: Path) -> None:
    drawn = {name: Picture("<svg ></svg>", "<svg ></svg>") for name in ("raster", "read_old")}
    write_figures(drawn, tmp_path)
    (tmp_path / "mine.svg").write_text("<svg></svg>")
    write_figures({"raster": drawn["raster"]}, tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mine.svg", "raster.svg"]


def test_what_an_earlier_answer_left_goes_and_a_users_own_stays(tmp_path: Path) -> None:
    own = {"law.csv": "mine", "runs.csv": "mine", "fit.nc": "mine", "extended.toml": 'title = "mine"'}
    theirs = {
        "law.csv": "a law", "runs.csv": "run,group,overturned,PGA", "fit.nc": "curves", "diagnosis.json": "{}",
        "extended.toml": '[mechanisms.table_force]\nfile = "law.csv"',
    }  # fmt: skip
    for held, left in ((own, set(own)), (theirs, {"diagnosis.json", "extended.toml"})):
        for name, text in held.items():
            (tmp_path / name).write_text(text)
        remove_earlier(tmp_path)
        assert {path.name for path in tmp_path.iterdir()} == left


def test_figures_are_xml(answer: Path) -> None:
    for path in (answer / "figures").glob("*.svg"):
        ElementTree.parse(path)


def test_extended_specimen_reads_back_with_the_effect_on(answer: Path) -> None:
    found = read_specimen(answer / "extended.toml")
    assert found.mechanisms == {"pivot_inset": {"inset_over_half_width": 0.1203}}
    assert found.parameters["width"] == 0.2501
    assert found.tolerance == specimen().tolerance


def test_extended_specimen_holds_what_was_calibrated() -> None:
    ranges = {"restitution": (0.8, 1.0), "viscous_damping.rate": (0.0, 0.5)}
    unsure = replace(specimen(), calibrate=ranges)
    fitted = {"restitution": Estimate(0.91, 0.9, 0.92, "1"), "viscous_damping.rate": Estimate(0.1, 0.0, 0.2, "s-1")}
    found = extend(unsure, replace(diagnosis(), base=fitted))
    assert found.calibrate == {} and found.parameters["restitution"] == 0.91
    assert found.mechanisms["viscous_damping"] == {"rate": 0.1}


def test_a_high_pass_reads_back_and_is_simulated(tmp_path: Path) -> None:
    """The only mechanism that may act through a parameter other than its first."""
    pole = {"high_pass_hz": Estimate(3.6, 3.0, 4.4, "Hz"), "order": Estimate(1.0, 1.0, 1.0, "1")}
    found = replace(diagnosis(), effects=(Effect("filter", "filter", pole, 80.0, 1e-6),))
    (tmp_path / "extended.toml").write_text(specimen_text(extend(specimen(), found)), encoding="utf-8")
    block = read_specimen(tmp_path / "extended.toml")
    assert block.mechanisms["filter"] == {"corner_hz": np.inf, "high_pass_hz": 3.6, "order": 1.0}
    shaking = Shaking(0.005, 3.0 * np.sin(np.arange(600) * 0.04))
    plain, seen = (simulate_specimen(b, shaking, duration=shaking.duration)["rotation_1"] for b in (specimen(), block))
    assert float(abs(seen - plain).max()) > 0.1 * float(abs(plain).max())


def test_nothing_missing_leaves_the_specimen_its_name_and_mechanisms() -> None:
    found = extend(specimen(), diagnosis("nothing_missing"))
    assert found.title == specimen().title and found.mechanisms == {}


def test_fit_file_holds_every_curve_and_number(answer: Path) -> None:
    found = diagnosis()
    for trace, strip in zip(found.traces, found.windows, strict=True):
        with xr.open_dataset(answer / "fit.nc", group=trace.recording) as group:
            for kind in ("measured", "before", "after"):
                np.testing.assert_array_equal(group[f"rotation_1_{kind}"].values, getattr(trace, kind))
                assert group[f"rotation_1_{kind}"].attrs["units"] == "rad"
            np.testing.assert_array_equal(group["window_rotation_1_after"].values, strip.after)
            assert group.attrs["held_out"] == str(trace.held_out).lower()
            assert ("rotation_1_from_rest_after" in group) == trace.held_out
    with xr.open_dataset(answer / "fit.nc") as root:
        inset = root.sel(parameter="pivot_inset.inset_over_half_width")
        assert [float(inset[k]) for k in ("low95", "estimate", "high95")] == [0.1161, 0.1203, 0.1247]
        assert float(root["gain"].sel(suspect="pivot_inset")) == 1480.0
        assert np.isnan(float(root["gain"].sel(suspect="clock")))
        assert root.attrs["statement"] == found.statement


def test_figures_stand_beside_the_page(answer: Path) -> None:
    drawn = {path.stem for path in (answer / "figures").glob("*.svg")}
    assert {"raster", "phase_plane", "suspects", "fits", "parameters"} <= drawn
    assert {f"read_{r.name}" for r in recordings()} <= drawn
    assert not any("#0000" in path.read_text("utf-8") for path in (answer / "figures").glob("*.svg"))
