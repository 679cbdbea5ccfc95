"""Specimens with sensor mechanisms: simulate writes what instruments write, studies show the wall."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import rocking
from diagnosis.report import extend
from grids.motions import Motion
from grids.write_specimen import specimen_text
from models.errors import InputError
from models.shaking import Shaking
from rocking.commands import app
from study.history import simulate_specimen
from tests.diagnosis.report.example import diagnosis, specimen

BLOCK = """
title = "block"
model = "housner"
[parameters]
width = 0.25
height = 1.1
mass = 120.0
"""
PULSE = {"pulse": {"shape": "sine", "amplitude": "0.26 g", "frequency": "1.2 Hz", "cycles": 2}}


def block(folder: Path, mechanisms: str = "") -> Path:
    path = folder / "block.toml"
    path.write_text(BLOCK + mechanisms)
    return path


@pytest.fixture
def motion() -> Motion:
    return rocking.read_motion(PULSE)


def test_gain_and_offset_act_on_rotations_only(tmp_path: Path, motion: Motion) -> None:
    true = rocking.simulate(block(tmp_path), motion, duration=4.0)
    read = rocking.simulate(
        block(tmp_path, "[mechanisms.gain]\ngain = 0.05\n[mechanisms.offset]\noffset_over_peak = 0.1\n"),
        motion,
        duration=4.0,
    )
    theta = true["rotation_1"].values
    assert 0.01 < np.max(np.abs(theta)) < 0.2
    gained = 1.05 * theta
    np.testing.assert_allclose(read["rotation_1"].values, gained + 0.1 * np.max(np.abs(gained)), rtol=1e-12)
    np.testing.assert_array_equal(read["base_acceleration_x"].values, true["base_acceleration_x"].values)
    np.testing.assert_array_equal(read["contact_1"].values, true["contact_1"].values)


PLACED = """
[channels.inclino]
quantity = "rotation"
[channels.string]
quantity = "displacement"
position_z = 1.0
[channels.gauge]
quantity = "uplift"
position_x = 0.1
"""


@pytest.mark.parametrize(
    "sensor",
    [
        "gain]\ngain = 0.05", "offset]\noffset_over_peak = 0.1", "drift]\nrate = 0.001",
        "saturation]\nlevel_over_peak = 0.5", "cross_axis]\nrotation_per_acceleration = 0.001",
    ],
)  # fmt: skip
def test_a_rotation_by_its_place_is_read_as_one_by_its_name(sensor: str, tmp_path: Path, motion: Motion) -> None:
    true = rocking.simulate(block(tmp_path, PLACED), motion, duration=4.0)
    read = rocking.simulate(block(tmp_path, f"{PLACED}[mechanisms.{sensor}\n"), motion, duration=4.0)
    assert np.max(np.abs(read["inclino"] - true["inclino"])) > 1e-4
    np.testing.assert_array_equal(read["inclino"], read["rotation_1"])
    for other in ("string", "gauge"):
        np.testing.assert_array_equal(read[other], true[other])


def test_a_displacement_that_an_instrument_reads_at_its_place_is_not_integrated(tmp_path: Path, motion: Motion) -> None:
    integrated = "[mechanisms.integrated_displacement]\nhigh_pass_hz = 0.3\n"
    places = PLACED.replace("position_z = 1.0", "position_z = 0.55")  # the centre of the block
    true = rocking.simulate(block(tmp_path, places), motion, duration=4.0)
    read = rocking.simulate(block(tmp_path, places + integrated), motion, duration=4.0)
    np.testing.assert_allclose(true["string"], true["displacement_1_x"], atol=1e-12)
    assert np.max(np.abs(read["displacement_1_x"] - true["displacement_1_x"])) > 1e-3
    for other in ("string", "inclino", "gauge"):
        np.testing.assert_array_equal(read[other], true[other])


def test_a_level_is_over_the_reference_peak_of_the_specimen(tmp_path: Path, motion: Motion) -> None:
    true = rocking.simulate(block(tmp_path), motion, duration=4.0)["rotation_1"].values
    level = "[instruments]\nreference_peak = 0.02\n[mechanisms.saturation]\nlevel_over_peak = 0.5\n"
    read = rocking.simulate(block(tmp_path, level), motion, duration=4.0)["rotation_1"].values
    np.testing.assert_allclose(read, np.clip(true, -0.01, 0.01), atol=1e-15)
    specimen = rocking.read_specimen(block(tmp_path, level))
    (tmp_path / "again.toml").write_text(specimen_text(specimen), encoding="utf-8")
    assert rocking.read_specimen(tmp_path / "again.toml") == specimen
    with pytest.raises(InputError, match=r"reference_peak = -1 rad: give a rotation above 0"):
        rocking.read_specimen(block(tmp_path, level.replace("0.02", "-1")))


def test_base_gain_moves_the_base_more_than_is_written(tmp_path: Path, motion: Motion) -> None:
    louder = rocking.simulate(block(tmp_path), motion, duration=4.0, scale=1.1)
    read = rocking.simulate(block(tmp_path, "[mechanisms.base_gain]\ngain = 0.1\n"), motion, duration=4.0)
    np.testing.assert_allclose(read["rotation_1"].values, louder["rotation_1"].values, atol=1e-12)
    said, moved = (history["base_acceleration_x"].values for history in (read, louder))
    np.testing.assert_allclose(1.1 * said, moved, rtol=1e-12)


def test_delay_shifts_the_responses(tmp_path: Path, motion: Motion) -> None:
    true = rocking.simulate(block(tmp_path), motion, duration=4.0)
    step = motion.time_step
    read = rocking.simulate(block(tmp_path, f"[mechanisms.delay]\ndelay = {5 * step}\n"), motion, duration=4.0)
    np.testing.assert_allclose(read["rotation_1"].values[5:], true["rotation_1"].values[:-5], atol=1e-9)


def test_cross_talk_is_of_the_base_as_it_moves(tmp_path: Path, motion: Motion) -> None:
    louder = "[mechanisms.base_gain]\ngain = 0.1\n"
    leaks = louder + "[mechanisms.cross_axis]\nrotation_per_acceleration = 0.001\n"
    true, read = (rocking.simulate(block(tmp_path, mechanisms), motion, duration=4.0) for mechanisms in (louder, leaks))
    leak = read["rotation_1"].values - true["rotation_1"].values
    np.testing.assert_allclose(leak, 0.001 * 1.1 * read["base_acceleration_x"].values, atol=1e-12)


def test_the_wall_keeps_its_own_mechanisms(tmp_path: Path, motion: Motion) -> None:
    inset = "[mechanisms.pivot_inset]\ninset_over_half_width = 0.1\n"
    true = rocking.simulate(block(tmp_path, inset), motion, duration=4.0)
    read = rocking.simulate(block(tmp_path, inset + "[mechanisms.gain]\ngain = 0.05\n"), motion, duration=4.0)
    np.testing.assert_allclose(read["rotation_1"].values, 1.05 * true["rotation_1"].values, rtol=1e-12)
    assert "gain" in read.attrs["instruments"] and "instruments" not in true.attrs


def test_instruments_leave_the_vertical_motion_to_its_mechanism(tmp_path: Path) -> None:
    time = np.arange(800) * 0.005
    shaking = Shaking(0.005, 3.0 * np.sin(8.0 * time), 4.0 * np.sin(11.0 * time), vertical_acts=False)
    half = "[mechanisms.vertical_acceleration]\nkappa = 0.5\n"
    true, read = (
        simulate_specimen(rocking.read_specimen(block(tmp_path, mechanisms)), shaking, duration=4.0)
        for mechanisms in (half, half + "[mechanisms.gain]\ngain = 0.05\n")
    )
    np.testing.assert_allclose(read["rotation_1"].values, 1.05 * true["rotation_1"].values, rtol=1e-12)


def test_an_unknown_mechanism_is_named_with_the_nearest(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="offset"):
        rocking.read_specimen(block(tmp_path, "[mechanisms.offfset]\noffset_over_peak = 0.1\n"))


def test_study_over_an_extended_specimen(tmp_path: Path) -> None:
    extended = extend(specimen(), diagnosis())
    (tmp_path / "extended.toml").write_text(specimen_text(extended), encoding="utf-8")
    with (tmp_path / "extended.toml").open("a") as file:
        file.write("[mechanisms.gain]\ngain = 0.05\n")
    plan = tmp_path / "plan.toml"
    plan.write_text(
        """
[study]
name = "interval"
specimen = "extended.toml"
[motion]
pulse = { shape = "sine", amplitude = "0.3 g", frequency = "2.5 Hz", cycles = 1 }
[axes]
"pivot_inset.inset_over_half_width" = { linspace = [0.1161, 0.1247, 3] }
[outputs]
names = ["peak_rotation"]
"""
    )
    report = rocking.run(plan, results=tmp_path / "results", scheduler="synchronous")
    peaks = rocking.open_study(report.folder)["peak_rotation"].values
    assert peaks.shape == (3,) and np.all(np.diff(peaks) != 0.0) and np.all(peaks < 0.2)
    found = CliRunner().invoke(app, ["check", str(report.folder), "--cells", "3"])
    assert found.exit_code == 0, found.output
