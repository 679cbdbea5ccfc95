"""The command that verifies: it counts digits rightly, and the oracles hold here."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

import models
from rocking.commands import app
from study.verify import fingerprint, line_of, one_block, rubber, two_blocks
from study.verify.base import Line, agreeing_digits


@pytest.mark.parametrize(
    ("found", "expected", "digits"),
    [
        (1.0, 1.0, 15.9),
        (1.001, 1.0, 3.0),
        (2.0, 1.0, 0.0),
        (1e-7, 0.0, 7.0),
        (math.nan, 1.0, 0.0),
        (math.nan, math.nan, 15.9),
    ],
)
def test_digits_that_agree(found: float, expected: float, digits: float) -> None:
    assert agreeing_digits(found, expected) == pytest.approx(digits, abs=0.01)


def test_oracles_hold_and_fail_for_another_number() -> None:
    """Those that need the kernel of one block, or none."""
    found = [*one_block.oracles()[:4], *two_blocks.oracles()[:6], *rubber.oracles()[:16]]
    for oracle in found:
        assert line_of(oracle).passed, oracle
        wrong = oracle.expected * (1.0 + 3.0 * 10.0**-oracle.digits)
        assert not line_of(replace(oracle, expected=wrong)).passed, oracle


def test_what_raises_fails_its_line() -> None:
    def nothing() -> float:
        raise ArithmeticError("no threshold")

    line = line_of(replace(one_block.oracles()[0], find=nothing))
    assert not line.passed and "no threshold" in str(line)


def test_every_model_has_a_fingerprint_of_its_version() -> None:
    stored = json.loads(fingerprint.FILE.read_text("utf-8"))
    assert {name: one["version"] for name, one in stored.items()} == {
        name: models.get(name).version for name in models.MODELS
    }


def test_the_fingerprint_of_the_block_agrees_and_notices_a_change(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert all(line.passed for line in fingerprint.lines("housner"))
    values, factors, outputs = fingerprint.CELLS["housner"]
    other = {**values, "height": values["height"] * (1.0 + 1e-5)}
    monkeypatch.setitem(fingerprint.CELLS, "housner", (other, factors, outputs))
    assert not all(line.passed for line in fingerprint.lines("housner"))
    monkeypatch.setattr(models.get("housner"), "version", "0")
    (line,) = fingerprint.lines("housner")
    assert not line.passed and "version 0" in str(line)


def test_the_exit_code_says_whether_all_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    good, bad = Line("m", "w", "s", 5.0, 4.0), Line("m", "w", "s", 3.0, 4.0)
    for lines, code in (([good], 0), ([good, bad], 1)):
        monkeypatch.setattr("study.verify._lines", lambda model, lines=lines: lines)
        result = CliRunner().invoke(app, ["verify"])
        assert result.exit_code == code and ("fail" in result.output) == (code == 1)
