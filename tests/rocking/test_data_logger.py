"""The example a user copies: from a data logger's CSV to a diagnosis, by its three commands."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
import xarray as xr
from typer.testing import CliRunner

from rocking.commands import app
from tests.diagnosis.report.schema import AnswerFile

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "from_a_data_logger"


@pytest.fixture(scope="module")
def commands() -> list[list[str]]:
    """The commands of the README, as lists of words."""
    text = (EXAMPLE / "README.md").read_text("utf-8")
    lines = text.partition("```sh\n")[2].partition("```")[0].splitlines()
    return [line.split()[1:] for line in lines]


@pytest.fixture(scope="module")
def said(tmp_path_factory: pytest.TempPathFactory, commands: list[list[str]]) -> tuple[Path, list[str]]:
    """A copy of the folder after all commands, and what each of them printed."""
    folder = tmp_path_factory.mktemp("example") / "copy"
    shutil.copytree(EXAMPLE, folder)
    printed = []
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        patch.setenv("COLUMNS", "100")
        for words in commands:
            ran = CliRunner().invoke(app, words)
            assert ran.exit_code == 0, ran.output
            printed.append(ran.stdout)
    return folder, printed


def test_there_are_three_commands(commands: list[list[str]]) -> None:
    assert [words[0] for words in commands] == ["calibrate", "diagnose", "simulate"]


def test_calibrate_shows_the_bound_that_gives_it_away(said: tuple[Path, list[str]]) -> None:
    table = said[1][0]
    assert "at its lower bound" in table and "correlation" in table
    assert "shake_1" in table and "shake_2" in table
    assert "held at" in table and "fall" in table


def test_diagnose_finds_the_worn_corners(said: tuple[Path, list[str]]) -> None:
    folder, printed = said
    answer = AnswerFile.model_validate(json.loads((folder / "answer" / "diagnosis.json").read_text("utf-8")))
    assert answer.verdict == "missing"
    assert [effect.effect_class for effect in answer.effects] == ["contact_geometry"]
    inset = answer.effects[0].parameters["inset_over_half_width"]
    assert inset.high95 is not None and inset.low95 < 0.05 < inset.high95
    assert answer.fit.holdout is not None and answer.fit.holdout.share_of_achievable is not None
    assert answer.fit.holdout.share_of_achievable > 0.8
    assert answer.statement in " ".join(printed[1].split())


def test_the_page_names_them(said: tuple[Path, list[str]]) -> None:
    page = (said[0] / "answer" / "report.html").read_text("utf-8")
    assert "Something is missing from the model: pivot inset" in page
    assert "shake_3" in page and len(page) < 700_000


def test_the_extended_block_is_simulated(said: tuple[Path, list[str]]) -> None:
    with xr.open_dataset(said[0] / "history.nc") as history:
        assert abs(history["rotation_1"]).max() > 0.01
