"""Damaged keys, answers and cases: one sentence before any case is answered; a worker that dies is said."""

from __future__ import annotations

import json
import os
import signal
from pathlib import Path
from typing import Any

import pytest

from diagnosis.prove.answers import NOTHING
from diagnosis.prove.cases import FILES
from diagnosis.prove.chain import prove
from models.errors import InputError

NULL = {"kind": "null", "effects": []}
SAID = {"verdict": "nothing_missing", "statement": "", **NOTHING, "seconds": 1.0}


def never(folder: Path) -> dict[str, Any]:
    raise AssertionError("no case is to be answered")


def killed(folder: Path) -> dict[str, Any]:
    os.kill(os.getpid(), signal.SIGKILL)
    return {}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    place = tmp_path / "concealed"
    (place / "case_01").mkdir(parents=True)
    for name in FILES:
        (place / "case_01" / name).touch()
    (place / "answers.json").write_text(json.dumps({"cases": {"case_01": NULL}}))
    return place


@pytest.mark.parametrize(
    ("key", "said"),
    [
        ('{"cases": {', r"answers\.json is not valid JSON .*line 1.*; restore the key"),
        ('{"cases": {"case_01": {"kind": "null", "effects": [], "weak": 1}}}', r"weak = 1"),
        ("[]", r"answers\.json is no JSON object"),
        ('{"case_01": {}}', r"answers\.json: cases is missing"),
        ('{"cases": []}', r"answers\.json: cases = \[\]"),
        ('{"cases": {}}', r"answers\.json has no entry for case_01"),
        ('{"cases": {"case_01": {"kind": "null"}}}', r"answers\.json: \[cases\] case_01 effects is missing"),
        ('{"cases": {"case_01": {"kind": "nul", "effects": []}}}', r"case_01 kind = 'nul'.*'null', 'mismatch'"),
        ('{"cases": {"case_01": {"kind": "single", "effects": [{"name": "tilt"}]}}}', r"effects 0 class is missing"),
        ('{"cases": {"case_01": {"kind": "null", "effects": [], "recordings": 1}}}', r"recordings = 1"),
        (
            '{"cases": {"case_01": {"kind": "null", "effects": [], "recordings": {"train_1": {"active": [[1]]}}}}}',
            r"train_1 active 0",
        ),
    ],
)
def test_a_damaged_key_is_said_first(folder: Path, tmp_path: Path, key: str, said: str) -> None:
    (folder / "answers.json").write_text(key)
    with pytest.raises(InputError, match=said):
        prove(folder, tmp_path / "out", jobs=1, say=print, answering=never)
    assert not list(tmp_path.glob("out/answers/*"))


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        ('{"verdict": "nothing', r"case_01\.json is not valid JSON .*; delete it"),
        ('{"verdict": "missing"}', r"case_01\.json: effects is missing"),
        (json.dumps({**SAID, "fit": {"holdout": {}}}), r"case_01\.json: \[fit\] .*share_of_achievable is missing"),
    ],
)
def test_a_damaged_answer_is_said_first(folder: Path, tmp_path: Path, answer: str, said: str) -> None:
    kept = tmp_path / "out" / "answers" / "case_01.json"
    kept.parent.mkdir(parents=True)
    kept.write_text(answer)
    with pytest.raises(InputError, match=said):
        prove(folder, tmp_path / "out", jobs=1, say=print, answering=never)
    assert kept.read_text() == answer


def test_a_missing_file_of_a_case_is_said_first(folder: Path, tmp_path: Path) -> None:
    (folder / "case_01" / "train_2.nc").unlink()
    with pytest.raises(InputError, match=r"case_01 has no train_2\.nc; a case needs specimen\.toml"):
        prove(folder, tmp_path / "out", jobs=1, say=print, answering=never)


def test_a_worker_that_is_killed_is_said(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"killed.*case_01.*--jobs"):
        prove(folder, tmp_path / "out", jobs=1, say=print, answering=killed)
    assert not list(tmp_path.glob("out/answers/*.json"))
