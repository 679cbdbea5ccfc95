"""The commands diagnose and calibrate: exit codes, mistakes, a stop, several recordings."""

from __future__ import annotations

import errno
import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

import rocking.commands.diagnose as command
from diagnosis.report.svg import Picture
from grids.recordings import read_recording
from rocking.commands import app
from rocking.commands.recordings import read_recordings
from tests.diagnosis.report.example import diagnosis

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "from_a_data_logger"
BLOCK, FIRST, SECOND = (str(EXAMPLE / name) for name in ("block.toml", "shake_1.csv", "shake_2.csv"))


def run(*words: str) -> tuple[int, str, str]:
    ran = CliRunner().invoke(app, words)
    return ran.exit_code, " ".join(ran.stdout.split()), " ".join(ran.stderr.split())


@pytest.fixture
def blank(monkeypatch: pytest.MonkeyPatch) -> None:
    """The figures are blank."""
    monkeypatch.setattr("diagnosis.report.pictures.picture", lambda *_: Picture("<svg ></svg>", "<svg ></svg>"))


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch, blank: None) -> None:
    """The engine answers at once."""
    monkeypatch.setattr("diagnosis.answer.diagnose.diagnose", lambda *_, **__: diagnosis("nothing_missing"))


@pytest.mark.usefixtures("quick")
def test_the_statement_goes_to_stdout_and_nothing_else(tmp_path: Path) -> None:
    code, out, err = run("diagnose", BLOCK, FIRST, "--out", str(tmp_path / "deep" / "answer"))
    assert code == 0 and out == diagnosis("nothing_missing").statement
    written = {path.name for path in (tmp_path / "deep" / "answer").iterdir()}
    assert written == {"diagnosis.json", "extended.toml", "report.html", "fit.nc", "figures"}
    assert "report.html" in err


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["no_block.toml", FIRST], "no_block.toml"),
        ([BLOCK, str(EXAMPLE / "shake_9.csv")], "did you mean 'shake"),
        ([BLOCK, FIRST, FIRST], "given twice; give it once"),
        ([BLOCK, FIRST, "--holdout", FIRST], "a recording held out cannot be fitted too"),
        ([BLOCK, BLOCK], "block"),
    ],
)
def test_a_mistake_is_one_sentence_and_exit_code_2(words: list[str], sentence: str, tmp_path: Path) -> None:
    code, out, err = run("diagnose", *words, "--out", str(tmp_path / "answer"))
    assert code == 2 and out == "" and sentence in err and err.count("error:") == 1
    assert not (tmp_path / "answer" / "report.html").exists()


def test_two_recordings_of_one_name_are_refused(tmp_path: Path) -> None:
    for name in ("shake_1.csv", "shake_1.toml"):
        (tmp_path / name).write_bytes((EXAMPLE / name).read_bytes())
    code, _, err = run("calibrate", BLOCK, FIRST, str(tmp_path / "shake_1.csv"))
    assert code == 2 and "share the name shake_1; rename one" in err


def test_a_file_in_place_of_the_folder_is_said_before_the_work(tmp_path: Path) -> None:
    (tmp_path / "answer").write_text("")
    code, _, err = run("diagnose", BLOCK, FIRST, "--out", str(tmp_path / "answer"))
    assert code == 2 and "is a file" in err


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="needs a folder that nobody can write to")
def test_a_folder_that_cannot_be_made_is_said_before_the_work() -> None:
    code, _, err = run("diagnose", BLOCK, FIRST, "--out", "/proc/answer")
    assert code == 2 and err.count("error:") == 1 and "--out /proc/answer cannot be made" in err


@pytest.mark.usefixtures("quick")
def test_a_full_disk_is_a_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", str(tmp_path / "fit.nc"))

    monkeypatch.setattr("diagnosis.report.write_answer", full)
    code, out, err = run("diagnose", BLOCK, FIRST, "--out", str(tmp_path))
    assert code == 2 and "fit.nc: no space left on device" in err
    assert out == diagnosis("nothing_missing").statement  # which took the time


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="needs a folder that nobody can write to")
def test_a_folder_that_cannot_be_written_to_is_said_before_the_work() -> None:
    code, out, err = run("diagnose", BLOCK, FIRST, "--out", "/proc")
    assert code == 2 and out == "" and "--out /proc cannot be written to" in err


@pytest.mark.usefixtures("quick")
def test_tables_of_an_earlier_answer_go_and_others_stay(tmp_path: Path) -> None:
    written = {"extended.toml": 'file = "law.csv"', "diagnosis.json": "{}", "runs.csv": "run,group,overturned,pga"}
    mine = {"runs.csv": "number,pga", "law.csv": "mine"}
    for folder, texts in (("answer", {"law.csv": "old", **written}), ("mine", mine)):
        (tmp_path / folder).mkdir()
        for name, text in texts.items():
            (tmp_path / folder / name).write_text(text)
        assert run("diagnose", BLOCK, FIRST, "--out", str(tmp_path / folder))[0] == 0
        left = {path.name for path in (tmp_path / folder).glob("*.csv")}
        assert left == (set() if folder == "answer" else {"runs.csv", "law.csv"})


def test_a_channel_that_one_recording_lacks_is_said_for_those_compared_together(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    richer = with_rate(tmp_path / "richer.nc")
    read_recordings([richer, Path(FIRST)])
    assert "note: rotation_rate_1 is not compared, because shake_1 lacks it" in capsys.readouterr().err
    read_recordings([richer], [Path(FIRST)])
    said = capsys.readouterr().err
    assert "is not compared" not in said and "note: shake_1: sign turned as stated: rotation_1" in said


def with_rate(path: Path) -> Path:
    """The second recording with its rate, as a netCDF file."""
    read = read_recording(SECOND)
    channels = {"base_acceleration_x": "m s-2", "rotation_1": "rad"}
    held = {name: ("time", read.channels[name], {"units": unit}) for name, unit in channels.items()}
    rate = np.gradient(read.channels["rotation_1"], read.time_step)
    held["rotation_rate_1"] = ("time", rate, {"units": "rad s-1"})
    xr.Dataset(held, coords={"time": ("time", read.time, {"units": "s"})}).to_netcdf(path)
    return path


PRESSED = """
import os, signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
from rocking.command import main

class Press:
    def find_spec(self, name, *_):
        if name == wanted:
            os.kill(os.getpid(), signal.SIGINT)

*sys.argv[1:], wanted = sys.argv[1:]
sys.meta_path.insert(0, Press())
main()
"""


@pytest.mark.parametrize("wanted", ["rocking.commands", "typer", "grids.specimen", "grids.recordings.read"])
def test_ctrl_c_while_something_is_imported_is_one_word(wanted: str) -> None:
    words = [sys.executable, "-c", PRESSED, "calibrate", BLOCK, FIRST, wanted]
    ran = subprocess.run(words, capture_output=True, text=True, cwd=EXAMPLE.parents[1], timeout=60)
    assert (ran.returncode, ran.stdout, ran.stderr) == (130, "", "stopped\n")


@pytest.mark.usefixtures("quick")
def test_what_looks_wrong_is_said(tmp_path: Path) -> None:
    for name in ("shake_1.csv", "shake_1.toml"):
        (tmp_path / name).write_bytes((EXAMPLE / name).read_bytes())
    mapping = (tmp_path / "shake_1.toml").read_text("utf-8").replace("sign = -1", "sign = 1")
    (tmp_path / "shake_1.toml").write_text(mapping)
    code, _, err = run("diagnose", BLOCK, str(tmp_path / "shake_1.csv"), "--out", str(tmp_path / "answer"))
    assert code == 0 and "suspicion: shake_1: rotation_1 follows base_acceleration_x with the wrong sign" in err


STAGE = """
[mechanisms.pivot_inset]
inset_over_half_width = 0.05
[[mechanisms.pivot_inset.stages]]
recording = "shake1"
"""


@pytest.mark.usefixtures("quick")
def test_a_stage_of_no_recording_is_said_or_refused_if_strict(tmp_path: Path) -> None:
    block = tmp_path / "block.toml"
    block.write_text(Path(BLOCK).read_text("utf-8") + STAGE)
    out = ("--out", str(tmp_path / "answer"))
    code, _, err = run("diagnose", str(block), FIRST, *out)
    assert code == 0 and "warning: [[mechanisms.pivot_inset.stages]] 1: recording = 'shake1'" in err
    history = ("simulate", str(block), "--motion", FIRST, "--out", str(tmp_path / "h.nc"))
    for words in (("diagnose", str(block), FIRST, *out), ("calibrate", str(block), FIRST), history):
        code, _, err = run(*words, "--strict")
        assert code == 2 and "did you mean 'shake_1'?" in err and err.count("error:") == 1
    assert not (tmp_path / "h.nc").exists()


def stopping(at: float) -> Callable[[str], object]:
    """Stages in which Ctrl-C is pressed once, when ``at`` of the work is done."""
    pressed: list[str] = []

    @contextmanager
    def stages(interrupted: str) -> Iterator[Callable[[str, float], None]]:
        def report(text: str, share: float) -> None:
            if share >= at and not pressed:
                pressed.append(text)
                raise KeyboardInterrupt

        yield report

    return stages


@pytest.mark.usefixtures("blank")
def test_ctrl_c_in_the_search_leaves_what_was_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(command, "stages", stopping(0.2))
    code, out, _ = run("diagnose", BLOCK, FIRST, "--out", str(tmp_path))
    assert code == 0 and "stopped before its end" in out
    answer = json.loads((tmp_path / "diagnosis.json").read_text("utf-8"))
    assert answer["provenance"]["finished"] is False and answer["statement"] in out
    assert "stopped before its end" in (tmp_path / "report.html").read_text("utf-8")


def test_ctrl_c_elsewhere_ends_the_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("diagnosis.answer.diagnose.diagnose", interrupted)
    code, _, err = run("diagnose", BLOCK, FIRST, "--out", str(tmp_path))
    assert code == 130 and "nothing was written" in err
