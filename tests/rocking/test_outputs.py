"""What commands write: never over what they read, and nothing that another answer needs."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner, Result

from diagnosis.answer.calibration import Calibration
from diagnosis.fit.intervals import Estimate
from grids.law_table import law_text
from grids.specimen import read_specimen
from grids.write_specimen import specimen_text
from models.errors import InputError
from models.housner.model import MODEL
from models.mechanisms import acting_on
from models.tables import row
from rocking.commands import app
from rocking.commands.calibrate import samples_beside, write
from rocking.commands.outputs import keep_others

CUBE = Path(__file__).resolve().parents[2] / "results" / "example.nc"
STUDIES = Path(__file__).resolve().parents[2] / "studies"
EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "from_a_data_logger"


def rocking(*words: object) -> Result:
    return CliRunner().invoke(app, [str(word) for word in words])


@pytest.fixture(autouse=True)
def inputs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder with a specimen, two recordings, an answer, a table of outcomes and a study."""
    monkeypatch.chdir(tmp_path)
    for name in ("block.toml", "shake_1.csv", "shake_1.toml"):
        shutil.copy(EXAMPLE / name, name)
    Path("free.nc").write_text("a recording")
    for name in ("answer/extended.toml", "answer/posterior.nc", "study/cube.nc", "study/blocks/one.nc", "tests.csv"):
        Path(name).parent.mkdir(exist_ok=True)
        Path(name).write_text("kept")
    Path("answer/law.csv").write_text("kept")
    Path("answer/trial.toml").write_text('[mechanisms.table_force]\nfile = "law.csv"\n')
    Path("runs.toml").write_text('table = "tests.csv"')


@pytest.mark.parametrize(
    "words",
    [
        "calibrate block.toml shake_1.csv --out block.toml",
        "calibrate block.toml shake_1.csv --out shake_1.toml",
        "calibrate block.toml shake_1.csv --out answer/../block.toml",
        "simulate block.toml --motion free.nc --out free.nc",
        "motions free.nc --out free.nc",
        "predict-outcomes answer --outcomes runs.toml --out runs.toml",
        "predict-outcomes answer --outcomes runs.toml --out tests.csv",
        "predict-outcomes answer --outcomes runs.toml --out answer/extended.toml",
        "export study --out study/cube.nc",
        "export study --out study/blocks/one.nc",
        "export study/cube.nc --out study/cube.nc",
        "diagnose answer/extended.toml shake_1.csv --out answer",
        "diagnose answer/trial.toml shake_1.csv --out answer",
    ],
)
def test_an_output_over_an_input_is_refused_before_the_work(words: str) -> None:
    if words.startswith("motions"):
        from grids.motions import read_motion
        from grids.motions.write import write_motion

        write_motion(read_motion("ridgecrest_2019_clc"), Path("free.nc"))
    before = {path: path.read_bytes() for path in Path().rglob("*") if path.is_file()}
    refused = rocking(*words.split())
    assert refused.exit_code == 2 and "over an input of this command" in refused.stderr, refused.output
    assert refused.stderr.count("\n") == 1
    assert {path: path.read_bytes() for path in Path().rglob("*") if path.is_file()} == before


@pytest.mark.parametrize(
    "words",
    [
        "simulate block.toml --duration 0.1 --out",
        "motions ridgecrest_2019_clc --out",
        f"export {CUBE} --output status --out",
    ],
)
def test_a_recording_is_not_written_over_and_an_own_file_is(words: str) -> None:
    measured = xr.Dataset({"rotation_1": ("time", np.zeros(9))}, attrs={"comment": "for rocking-study 0.1.0"})
    measured.to_netcdf("measured.nc")
    before = Path("measured.nc").read_bytes()
    refused = rocking(*words.split(), "measured.nc")
    assert refused.exit_code == 2 and "error: measured.nc is there and was not written by" in refused.stderr
    assert Path("measured.nc").read_bytes() == before
    for _ in range(2):
        written = rocking(*words.split(), "own.nc")
        assert written.exit_code == 0, written.output


def test_specimens_and_described_tables_of_others_are_kept() -> None:
    for output in ("mine.toml", "MINE.TOML", "shake_2.csv", "tests.csv", "new.posterior.nc"):
        Path(output).write_text("kept")
    Path("shake_2.toml").write_text("[columns]\n")
    Path("tests.toml").write_text('table = "tests.csv"')
    for output, words in (
        ("shake_2.csv", f"export {CUBE} --out"),
        ("tests.csv", f"export {CUBE} --out"),
        ("mine.toml", "calibrate block.toml shake_1.csv --out"),
        ("MINE.TOML", "calibrate block.toml shake_1.csv --out"),
        ("shake_2.csv", "predict-outcomes answer --outcomes runs.toml --out"),
    ):
        refused = rocking(*words.split(), output)
        assert refused.exit_code == 2 and f"error: {output} is there and was not" in refused.stderr, refused.output
        assert Path(output).read_text() == "kept"
    refused = rocking("calibrate", "block.toml", "shake_1.csv", "--out", "new.toml")
    assert refused.exit_code == 2 and "error: new.posterior.nc is there and was not" in refused.stderr, refused.output
    keep_others(Path("new.nc"))
    Path("base.toml").write_text(specimen_text(read_specimen("block.toml")))
    keep_others(Path("base.toml"))
    Path("base.toml").write_text("# for rocking-study\n" + Path("block.toml").read_text())
    with pytest.raises(InputError, match="was not written by"):
        keep_others(Path("base.toml"))


def test_a_table_named_like_its_plan_is_written_anew() -> None:
    Path("first_map.toml").write_text('[model]\nname = "housner"\n')
    for _ in range(2):
        written = rocking("export", CUBE, "--output", "status", "--out", "first_map.csv")
        assert written.exit_code == 0, written.output


def test_a_table_named_like_the_description_of_another_is_written_anew() -> None:
    described = """table = "tests.csv"\n\n[columns]\nmotion = "name"\n"""
    Path("runs.toml").write_text(described)
    Path("runs.csv").write_text("motion,chance\n")
    keep_others(Path("runs.csv"))
    Path("tests.toml").write_text(described)
    with pytest.raises(InputError, match=r"tests\.csv is there"):
        keep_others(Path("tests.csv"))


def test_a_calibrated_specimen_is_written_as_toml() -> None:
    refused = rocking("calibrate", "block.toml", "shake_1.csv", "--out", "free.nc")
    assert refused.exit_code == 2 and "--out free.nc" in refused.stderr and "end the name in .toml" in refused.stderr
    assert Path("free.nc").read_text() == "a recording"


def test_samples_of_a_calibration_are_named_after_its_specimen() -> None:
    """Those of the diagnosis in the same folder are what its studies take."""
    estimate = Estimate(0.25, 0.24, 0.26, "m", "")
    found = Calibration(
        {"width": estimate}, np.eye(1), 0.1, 0.1, 1.0, 3, posterior={"width": np.linspace(0.24, 0.26, 5)}
    )
    wall = read_specimen("block.toml")
    write(wall, found, Path("answer/base.toml"), None)
    keep_others(samples_beside(Path("answer/base.toml")))
    assert Path("answer/posterior.nc").read_text() == "kept"
    with xr.open_dataset("answer/base.posterior.nc") as samples:
        assert samples["width"].size == 5
    write(wall, replace(found, posterior={}), Path("answer/base.toml"), None)
    assert not Path("answer/base.posterior.nc").exists() and Path("answer/posterior.nc").exists()


@pytest.mark.parametrize("taken", ["report.html", "figures"])
def test_what_an_answer_cannot_write_over_is_said_before_the_work(taken: str) -> None:
    path = Path("new") / taken
    path.parent.mkdir()
    if taken == "figures":
        path.write_text("kept")
    else:
        path.mkdir()
    refused = rocking("diagnose", "block.toml", "shake_1.csv", "--out", "new")
    assert refused.exit_code == 2 and f"error: {path} is a f" in refused.stderr
    assert sorted(Path("new").iterdir()) == [path]


def test_few_draws_of_a_bootstrap_are_refused() -> None:
    refused = rocking("diagnose", "block.toml", "shake_1.csv", "--out", "new", "--bootstrap", "3")
    assert refused.exit_code == 2 and "19 or more" in refused.stderr


def test_a_law_of_a_calibrated_specimen_lies_beside_it(tmp_path: Path) -> None:
    law = {row("rotation", "above", 3): -0.1, "reach_rotation": 0.2}
    tables = acting_on("housner")["table_force"].tabulated
    assert tables is not None
    Path("old.csv").write_text(law_text({**MODEL.mechanisms["table_force"].nulls, **law}, tables))
    text = Path("block.toml").read_text() + '\n[mechanisms.table_force]\nfile = "old.csv"\n'
    Path("lawful.toml").write_text(text)
    wall, width = read_specimen("lawful.toml"), Estimate(0.25, 0.24, 0.26, "m", "")
    write(wall, Calibration({"width": width}, np.eye(1), 0.1, 0.1, 1.0, 3), Path("answer/base.toml"), None)
    assert read_specimen("answer/base.toml").mechanisms == wall.mechanisms
    keep_others(Path("answer/base.law.csv"), named_in=Path("answer/base.toml"))
    Path("other.law.csv").write_text("kept")
    refused = rocking("calibrate", "lawful.toml", "shake_1.csv", "--out", "other.toml")
    assert refused.exit_code == 2 and "error: other.law.csv is there and was not" in refused.stderr, refused.output
    assert Path("answer/law.csv").read_text() == "kept"


def test_a_cube_that_is_a_link_to_itself_is_not_there() -> None:
    cube = Path("study/cube.nc")
    cube.unlink()
    cube.symlink_to(cube.absolute())
    found = rocking("export", "study", "--out", "cells.csv")
    assert found.exit_code == 2 and "cube.nc does not exist" in found.output, found.output


def test_a_folder_that_is_a_link_to_itself_is_refused_in_a_sentence() -> None:
    loop = Path("loop")
    loop.symlink_to(loop.absolute())
    shutil.copy(STUDIES / "one_block.toml", "plan.toml")
    found = rocking("run", "plan.toml", "--results", "loop")
    assert found.exit_code == 2 and "too many levels of symbolic links" in found.output.lower(), found.output
    found = rocking("prove", "loop")
    assert found.exit_code == 2 and "no concealed cases in loop" in found.output, found.output
