"""Slips that are possible values: named with value and what is usual, and never where nothing is unusual."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from grids.motions import Motion
from grids.plan import parse_plan
from grids.plausibility import (
    suspicions_of_outcomes,
    suspicions_of_plan,
    suspicions_of_recordings,
    suspicions_of_specimen,
    suspicions_of_stages,
)
from grids.recordings.base import Recording
from grids.recordings.outcomes import Outcomes
from grids.specimen import parse_specimen

PLAN = """
[study]
name = "a"
model = "housner"
[motion]
files = ["ridgecrest_2019_clc"]
[parameters]
height = "1.8 m"
width = "40 cm"
mass = "800 kg"
[axes]
pga = { linspace = [0.1, 1.0, 4], unit = "g" }
"""
SPECIMEN = """
title = "wall"
model = "housner"
[parameters]
height = "1.8 m"
width = "40 cm"
mass = "800 kg"
[tolerance]
width = 0.005
[initial]
rotation_1 = "4 deg"
[channels.gauge]
quantity = "displacement"
position_x = "0.8 m"
position_z = "1.75 m"
"""
STUDIES = sorted((Path(__file__).resolve().parents[2] / "studies").glob("*.toml"))


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("1.8 m", "1500 m", ("height = 1500 m", "unusually large")),
        ("40 cm", "25 mm", ("width = 0.025 m", "unusually small")),
        ("[0.1, 1.0, 4]", "[0.1, 6.0, 4]", ("pga = 58.8", "unusually large")),
        (', unit = "g"', "", ("pga goes to 1 m s-2 (0.1 g)", "was g meant")),
    ],
)
def test_a_plan(old: str, new: str, words: tuple[str, ...]) -> None:
    assert suspicions_of_plan(parse_plan(PLAN, Path())) == ()
    assert old in PLAN
    (said,) = suspicions_of_plan(parse_plan(PLAN.replace(old, new), Path()))
    assert all(word in said for word in words), said


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("0.005", "0.5", ("[tolerance] width = 50 %", "0.005 for 0.5 %")),
        ("4 deg", "400 deg", ("rotation_1 = 400 deg", "lies on its side")),
        ("1.8 m", "1800 m", ("height = 1800 m", "unusually large")),
        ("0.8 m", "-20 m", ("channel gauge lies 20", "longest side is 1.8 m", "'-200 mm'")),
        ("1.75 m", "40 m", ("channel gauge lies 40", "longest side is 1.8 m", "'-200 mm'")),
    ],
)
def test_a_specimen(old: str, new: str, words: tuple[str, ...]) -> None:
    assert suspicions_of_specimen(parse_specimen(SPECIMEN)) == ()
    (said,) = suspicions_of_specimen(parse_specimen(SPECIMEN.replace(old, new)))
    assert all(word in said for word in words), said


def test_sides_that_are_calibrated_are_sides() -> None:
    """With a gauge on top of the block only the upper end of its height tells that it is not far away."""
    text = SPECIMEN.replace('height = "1.8 m"\n', "").replace("[tolerance]\nwidth = 0.005\n", "").split("[initial]")
    high, low = ("[calibrate]\nheight = " + ends + "\n[initial]" for ends in ("[1.7, 1.8]", "[0.7, 0.8]"))
    assert suspicions_of_specimen(parse_specimen(high.join(text))) == ()
    (said,) = suspicions_of_specimen(parse_specimen(low.join(text)))
    assert "longest side is 0.8 m" in said


def test_a_stated_unit_is_no_slip() -> None:
    small = PLAN.replace("[0.1, 1.0, 4]", "[0.1, 0.2, 4]")
    assert suspicions_of_plan(parse_plan(small.replace('unit = "g"', 'unit = "m/s^2"'), Path())) == ()


@pytest.mark.parametrize("path", STUDIES, ids=lambda path: path.name)
def test_nothing_is_suspected_of_the_studies_at_hand(path: Path) -> None:
    """Of a set of artificial motions the first: they are made to peak alike."""
    text = re.sub(r"(artificial = .*seed = \[\d+).*\]", r"\1]", path.read_text("utf-8"))
    assert suspicions_of_plan(parse_plan(text, path.parent)) == ()


def test_a_motion_that_peaks_beyond_any_earthquake(tmp_path: Path) -> None:
    """A file in m/s2 that says g."""
    samples = " ".join(["9.0", "-20.0"] * 10)
    (tmp_path / "m.AT2").write_text(
        f"PEER\nX, 1/1/2000, Y, 90\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS=  20, DT= .0100 SEC\n{samples}\n"
    )
    named = PLAN.replace('files = ["ridgecrest_2019_clc"]', 'files = ["m.AT2"]')
    (said,) = suspicions_of_plan(parse_plan(named, tmp_path))
    assert "peaks at 20 g" in said and "are its unit and its scale right?" in said


def test_a_factor_that_takes_a_motion_beyond_any_earthquake() -> None:
    scaled = re.sub(r"pga = .*", "motion_scale = { values = [1, 1000] }", PLAN)
    (said,) = suspicions_of_plan(parse_plan(scaled, Path()))
    assert "times motion_scale 1000 peaks at" in said


def test_time_stretched_beyond_sense() -> None:
    (said,) = suspicions_of_plan(parse_plan(PLAN.replace("[axes]", "[axes]\ntime_scale = { values = [1000] }"), Path()))
    assert "time_scale = 1000 is unusually large" in said


@pytest.mark.parametrize(("peak", "count"), [(4.9, 0), (5.54, 1)])
def test_unusual_motions_of_tests_are_named(peak: float, count: int) -> None:
    """Of a table of outcomes once, however many of its runs are beyond the usual: their unit is the same."""
    shaken = np.array([0.0, peak * 9.80665, 0.0])
    motions = (Motion("a", 0.01, shaken), Motion("b", 0.01, 0.99 * shaken))
    said = suspicions_of_outcomes(Outcomes("table", ("1", "2"), motions, ("1", "2"), None))
    assert len(said) == count and all("run '1' peaks at 5.54 g" in one for one in said)
    recorded = Recording("shaken", 0.01, 0.01 * np.arange(3), {"base_acceleration_x": -shaken})
    said = suspicions_of_recordings([recorded])
    assert len(said) == count and all("recording shaken peaks at 5.54 g" in one for one in said)


def staged(*recordings: str, begins: str = "1.5") -> str:
    stages = "".join(
        f'[[mechanisms.pivot_inset.stages]]\nrecording = "{name}"\nbegins = {begins}\n' for name in recordings
    )
    return f"{SPECIMEN}[mechanisms.pivot_inset]\ninset_over_half_width = 0.05\n{stages}"


@pytest.mark.parametrize(
    ("text", "alone", "words"),
    [
        (staged("shake1"), False, ("[[mechanisms.pivot_inset.stages]] 1", "'shake1'", "did you mean 'shake_1'?")),
        (staged("shake1"), True, ("'shake1'", "did you mean 'shake_1'?")),
        (staged("shake_1", begins="4210"), False, ("begins = 4210 s", "recording shake_1 (8 s)", "unit")),
        (staged("shake_1", begins="1\nends = 4210"), True, ("ends = 4210 s", "recording shake_1 (8 s)", "unit")),
    ],
)
def test_a_stage_that_fits_no_recording(text: str, alone: bool, words: tuple[str, ...]) -> None:
    (said,) = suspicions_of_stages(parse_specimen(text), {"shake_1": 8.0}, alone)
    assert all(word in said for word in words), said


def test_stages_that_fit() -> None:
    assert suspicions_of_stages(parse_specimen(staged("shake_1")), {"shake_1": 8.0}) == ()
    for alone in (True, False):
        assert suspicions_of_stages(parse_specimen(staged("shake_1", "shake_2")), {"shake_1": 8.0}, alone) == ()
    assert suspicions_of_stages(parse_specimen(staged("train_1")), {"train_3": 8.0}) == ()
    assert suspicions_of_stages(parse_specimen(SPECIMEN), {"shake_1": 8.0}) == ()
