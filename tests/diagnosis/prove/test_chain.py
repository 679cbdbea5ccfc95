"""A folder of concealed cases: answered, hashed, only then scored, and resumed."""

from __future__ import annotations

import hashlib
import json
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from diagnosis.prove.answers import NOTHING
from diagnosis.prove.cases import FILES
from diagnosis.prove.chain import cases_in, prove
from models.errors import InputError
from rocking.commands import app
from rocking.commands.prove import default_folder


def answer_by_title(folder: Path) -> dict[str, Any]:
    """Says what stands in the specimen's title."""
    text = (folder / "specimen.toml").read_text()
    name = text.partition("title = ")[2].partition("\n")[0].strip('"')
    effects = [{"name": name, "class": name, "parameters": {}, "evidence": 80.0}] if name else []
    fit = {"holdout": {"share_of_achievable": 0.9 if name else None}}
    located = [{"recording": "train_1", "start": 2.0, "end": 6.0}, {"recording": "train_1", "start": 5.0, "end": 8.0}]
    return {
        "verdict": "missing" if name else "nothing_missing", "effects": effects, "rivals": [], "constancy": [],
        "located": located if name else [], "base": {}, "fit": fit,
    }  # fmt: skip


def entry(kind: str, *names: str, **of_train_1: Any) -> dict[str, Any]:
    effects = [{"name": name, "class": name, "parameters": {}} for name in names]
    return {"kind": kind, "model": "housner", "effects": effects, "recordings": {"train_1": of_train_1}}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two cases right, one wrong, and a wall."""
    place = tmp_path / "concealed"
    cases = {
        "case_01": ("", "housner", entry("null")),
        "case_02": ("tilt", "housner", entry("single", "tilt", strength=9.0, duration=10.0, active=[[4.0, 10.0]])),
        "case_03": ("gain", "housner", entry("single", "delay", strength=12.0)),
        "case_05": ("", "interface", entry("null")),
    }
    for name, (title, model, _) in cases.items():
        (place / name).mkdir(parents=True)
        for recording in FILES[1:]:
            (place / name / recording).touch()
        (place / name / "specimen.toml").write_text(f'title = "{title}"\nmodel = "{model}"\n')
    (place / "answers.json").write_text(json.dumps({"cases": {name: key for name, (_, _, key) in cases.items()}}))
    return place


@pytest.fixture
def in_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """A new process imports for longer than it answers."""
    monkeypatch.setattr("diagnosis.prove.chain.processes", ThreadPoolExecutor)


def test_answers_are_hashed_then_scored_and_kept(folder: Path, tmp_path: Path) -> None:
    out, lines = tmp_path / "out", []
    figures = prove(folder, out, model="housner", jobs=2, say=lines.append, answering=answer_by_title)
    assert figures["cases"] == 3 and figures["class_first"] == 0.5 and figures["false_alarm"] == 0.0
    written = json.loads((out / "prove.json").read_text())
    assert written["share_of_achievable_named_median"] == 0.9 and written["intervals"]["open_precision"]["of"] == 0
    assert figures["overlap_mean"] == pytest.approx(4.0 / 8.0)  # 2 to 8 s said, 4 to 10 s true
    hashes = json.loads((out / "sha256.json").read_text())
    answer = out / "answers" / "case_02.json"
    assert hashes["case_02"] == hashlib.sha256(answer.read_bytes()).hexdigest() == figures["answers_sha256"]["case_02"]
    assert "case_03 single: delay" in (out / "wrong.txt").read_text()
    for name in ("confusion.png", "evidence.png", "located.png"):
        assert (out / name).stat().st_size > 1000
    answered = answer.stat().st_mtime_ns
    (out / "prove.json").unlink()
    again: list[str] = []
    prove(folder, out, model="housner", jobs=2, say=again.append, answering=answer_by_title)
    assert again[0] == "3 of 3 cases were answered before" and answer.stat().st_mtime_ns == answered
    assert json.loads((out / "prove.json").read_text()) == written  # scored anew


@pytest.mark.usefixtures("in_this_process")
def test_nothing_is_scored_while_cases_are_left(folder: Path, tmp_path: Path) -> None:
    lines: list[str] = []
    assert prove(folder, tmp_path / "out", minutes=0.0, say=lines.append, answering=answer_by_title) == {}
    assert lines[-1].startswith("4 cases are left") and not (tmp_path / "out" / "prove.json").exists()


def test_halves_and_models_part_the_cases(folder: Path) -> None:
    assert [p.name for p in cases_in(folder, "odd")] == ["case_01", "case_03", "case_05"]
    assert [p.name for p in cases_in(folder, "even")] == ["case_02"]
    assert [p.name for p in cases_in(folder, model="interface")] == ["case_05"]
    with pytest.raises(InputError, match="take one of all, odd, even"):
        cases_in(folder, "first")
    with pytest.raises(InputError, match="no case of"):
        cases_in(folder, "even", "interface")


def test_the_command_says_what_a_folder_needs(tmp_path: Path) -> None:
    found = CliRunner().invoke(app, ["prove", str(tmp_path), "--out", str(tmp_path / "out")])
    assert found.exit_code == 2 and "no concealed cases" in found.output and "answers.json" in found.output


@pytest.mark.usefixtures("in_this_process")
def test_answers_to_other_cases_are_not_scored(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    prove(folder, out, model="housner", jobs=1, say=print, answering=answer_by_title)
    scored = (out / "prove.json").read_bytes()
    (folder / "case_02" / "README.md").write_text("the second wall\n")  # beside it, none of its own
    prove(folder, out, model="housner", jobs=1, say=print, answering=answer_by_title)
    assert (out / "prove.json").read_bytes() == scored
    changed = folder / "case_02" / "specimen.toml"
    changed.write_text(changed.read_text() + "# another wall\n")
    with pytest.raises(InputError, match=r"case_02\.json is the answer to another specimen\.toml.*--out"):
        prove(folder, out, model="housner", jobs=1, say=print, answering=answer_by_title)
    assert (out / "prove.json").read_bytes() == scored


@pytest.mark.usefixtures("in_this_process")
def test_an_answer_that_does_not_say_to_which_files_is_not_scored(folder: Path, tmp_path: Path) -> None:
    answers = tmp_path / "out" / "answers"
    answers.mkdir(parents=True)
    (answers / "case_01.json").write_text(json.dumps({"verdict": "nothing_missing", **NOTHING, "seconds": 1.0}))
    with pytest.raises(InputError, match=r"case_01\.json does not say to which files.*--out"):
        prove(folder, tmp_path / "out", jobs=1, say=print, answering=answer_by_title)


def test_folders_of_one_name_have_their_own_answers() -> None:
    assert default_folder(Path("/a/first/cases"), "all", None) == Path("results/prove/first_cases")
    assert default_folder(Path("/a/second/cases"), "odd", "housner") == Path("results/prove/second_cases_odd_housner")


def without_memory(folder: Path) -> dict[str, Any]:
    if folder.name == "case_02":
        raise MemoryError
    return answer_by_title(folder)


def without_solution(folder: Path) -> dict[str, Any]:
    if folder.name == "case_02":
        raise ArithmeticError("no solution")
    return answer_by_title(folder)


@pytest.mark.usefixtures("in_this_process")
def test_what_the_machine_refused_is_tried_again(folder: Path, tmp_path: Path) -> None:
    lines: list[str] = []
    out = tmp_path / "out"
    assert prove(folder, out, model="housner", say=lines.append, answering=without_memory) == {}
    assert lines[-1] == "1 cases are left: start again to go on"
    assert prove(folder, out, model="housner", say=lines.append, answering=answer_by_title)["class_first"] == 0.5


@pytest.mark.usefixtures("in_this_process")
def test_failures_and_answers_of_other_versions_are_said(folder: Path, tmp_path: Path) -> None:
    lines: list[str] = []
    out = tmp_path / "out"
    found = prove(folder, out, model="housner", say=lines.append, answering=without_solution)
    assert found["detected"] == 0.5 and any(line.startswith("failed, counted as wrong: case_02") for line in lines)
    kept = out / "answers" / "case_01.json"
    kept.write_text(json.dumps({**json.loads(kept.read_text()), "sources": "earlier"}))
    prove(folder, out, model="housner", say=lines.append, answering=without_solution)
    assert any(line.startswith("1 of 3 answers are those of another version") for line in lines)


def without_a_file(folder: Path) -> dict[str, Any]:
    raise FileNotFoundError(2, "no such file", "law.csv")


@pytest.mark.usefixtures("in_this_process")
def test_a_file_that_is_missing_is_a_failure_with_its_reason(folder: Path, tmp_path: Path) -> None:
    lines: list[str] = []
    found = prove(folder, tmp_path / "out", model="housner", say=lines.append, answering=without_a_file)
    assert found["failed"] == ["case_01", "case_02", "case_03"]
    assert any("case_02: failed (FileNotFoundError: [Errno 2] no such file: 'law.csv')" in line for line in lines)
