"""Stages of a specimen: read, written, refused, and what acts when."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from grids.plan import read_plan
from grids.recordings import read_recording
from grids.specimen import Specimen, parse_specimen
from grids.stages import Stage, after_the_last, intervals, stretches
from grids.write_specimen import specimen_text
from models.errors import InputError
from rocking.simulation import simulate
from study.history import write_history

BLOCK = 'title = "block"\nmodel = "housner"\n[parameters]\nwidth = 0.3\nheight = 1.7\nmass = 500\n'
CRACKS = """[mechanisms.restitution]
factor_on_housner = 0.93
[[mechanisms.restitution.stages]]
recording = "shake_1"
ends = 0
[[mechanisms.restitution.stages]]
recording = "shake_2"
begins = "1.5 s"
[[mechanisms.restitution.stages]]
recording = "shake_3"
"""
KNOCKED = """[mechanisms.offset]
offset_over_peak = 0.1
[[mechanisms.offset.stages]]
recording = "shake_2"
begins = 17.0
ends = 19.0
"""


def specimen(tables: str) -> Specimen:
    return parse_specimen(BLOCK + tables)


def test_stages_say_when_a_mechanism_acts() -> None:
    found = specimen(CRACKS + KNOCKED)
    stages = found.stages["restitution"]
    assert stages[1] == Stage("shake_2", 1.5)
    assert intervals(stages, "shake_1") == () and intervals(stages, "shake_2") == ((1.5, float("inf")),)
    assert [(t, sorted(acting)) for t, acting in stretches(found, "shake_2")] == [
        (0.0, []), (1.5, ["restitution"]), (17.0, ["offset", "restitution"]), (19.0, ["restitution"]),
    ]  # fmt: skip
    assert [(t, sorted(acting)) for t, acting in stretches(found, "shake_1")] == [(0.0, [])]
    # anything else: as after the last stage, which for the offset has an end
    assert list(after_the_last(found).mechanisms) == ["restitution"] and not after_the_last(found).stages


def test_a_specimen_with_stages_reads_back_equal() -> None:
    found = specimen(CRACKS + KNOCKED)
    assert parse_specimen(specimen_text(found)) == found


@pytest.mark.parametrize(
    ("stages", "sentence"),
    [
        ('stages = "late"\n', "write [[mechanisms.restitution.stages]] tables"),
        ("stages = [{ begins = 2.0 }]\n", "[[mechanisms.restitution.stages]] 1: recording is missing"),
        ('stages = [{ recording = "a", begins = 3.0, ends = 2.0 }]\n', "ends (2 s) before it begins (3 s); swap"),
        ('stages = [{ recording = "a", begins = -1.0 }]\n', "give a time in the recording"),
        ('stages = [{ recording = "a", ends = 2.0 }, { recording = "a", begins = 1.0 }]\n', "without overlap"),
        ('stages = [{ recording = "a", begin = 2.0 }]\n', "begin"),
    ],
)
def test_stages_that_make_no_sense_are_refused(stages: str, sentence: str) -> None:
    with pytest.raises(InputError) as refused:
        specimen("[mechanisms.restitution]\nfactor_on_housner = 0.93\n" + stages)
    assert sentence in str(refused.value)


@pytest.fixture(scope="module")
def shakes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two recordings of one base motion, of the block alone."""
    folder = tmp_path_factory.mktemp("shakes")
    (folder / "block.toml").write_text(BLOCK)
    history = simulate(folder / "block.toml", "ridgecrest_2019_ccc.nc", component="north", scale=0.5)
    assert 0.002 < np.max(np.abs(history["rotation_1"])) < 0.2
    for name in ("shake_1", "shake_2"):
        write_history(history, folder / f"{name}.nc")
    return folder


def rotation(tables: str, recording: Path) -> np.ndarray:
    return simulate(specimen(tables), read_recording(recording))["rotation_1"].values


def test_simulate_acts_by_the_stages_of_the_recording(shakes: Path) -> None:
    plain, first, second = (
        rotation("", shakes / "shake_2.nc"),
        *(rotation(CRACKS.replace("1.5 s", "18 s"), shakes / f"shake_{k}.nc") for k in (1, 2)),
    )
    step = read_recording(shakes / "shake_2.nc").time_step
    before = round(18.0 / step)
    np.testing.assert_array_equal(first, plain)
    np.testing.assert_array_equal(second[: before + 1], plain[: before + 1])
    assert np.max(np.abs(second - plain)) > 1e-3 * np.max(np.abs(plain))


def test_instruments_act_by_the_stages_of_the_recording(shakes: Path) -> None:
    plain, knocked = rotation("", shakes / "shake_2.nc"), rotation(KNOCKED, shakes / "shake_2.nc")
    step = read_recording(shakes / "shake_2.nc").time_step
    inside = slice(round(17.0 / step), round(19.0 / step))
    shift = knocked - plain
    np.testing.assert_allclose(shift[inside], 0.1 * np.max(np.abs(plain)))
    shift[inside] = 0.0
    assert not shift.any()


def test_a_study_takes_the_state_after_the_last_stage(tmp_path: Path) -> None:
    (tmp_path / "block.toml").write_text(BLOCK + CRACKS + KNOCKED)
    text = '[study]\nname = "s"\nspecimen = "block.toml"\n[motion]\nfiles = ["ridgecrest_2019_ccc.nc"]\n'
    text += (
        'component = "north"\n[axes]\npga = { values = [0.3, 0.4], unit = "g" }\n[outputs]\nnames = ["overturned"]\n'
    )
    (tmp_path / "plan.toml").write_text(text)
    plan = read_plan(tmp_path / "plan.toml")
    assert plan.fixed["restitution.factor_on_housner"] == 0.93
    assert not any("offset" in note for note in plan.notes)
