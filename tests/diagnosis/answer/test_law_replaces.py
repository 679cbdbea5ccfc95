"""A law in a table in the place of what was named: from the answer to the files, and a simulation with them."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

import pytest

from diagnosis import diagnose
from diagnosis.report import write_answer
from grids.specimen import read_specimen
from tests.diagnosis.made import SPECIMEN, recording

SUPPORT = {"table_force": {"oscillator_motion": 0.25, "oscillator_frequency": 3.4, "oscillator_damping": 0.05}}


def test_a_support_that_moves_takes_the_place_of_what_was_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    monkeypatch.setattr(import_module("diagnosis.answer.verdict"), "contradicted", lambda found, held: (0.04, 0.07))
    training = [recording("train_1", 1, SUPPORT), recording("train_2", 2, SUPPORT)]
    held = [recording("test_1", 3, SUPPORT)]
    found = diagnose(SPECIMEN, training, held)
    assert found.verdict == "not_in_library" and found.missing_force is not None
    assert not found.effects and not found.rivals
    oscillator = found.missing_force["oscillator"]
    assert oscillator["frequency"]["estimate"] == pytest.approx(3.4, rel=0.02)
    assert oscillator["motion"]["estimate"] == pytest.approx(0.25, rel=0.2)
    assert "has a frequency of its own" in found.statement and "With what was found" not in found.statement
    assert found.holdout is not None and (found.holdout.share_of_achievable or 0.0) > 0.8
    write_answer(found, SPECIMEN, training, held, tmp_path)
    assert "has a frequency of its own" in (tmp_path / "report.html").read_text(encoding="utf-8")
    extended = read_specimen(tmp_path / "extended.toml")
    law = extended.mechanisms["table_force"]
    assert law["oscillator_frequency"] == pytest.approx(oscillator["frequency"]["estimate"])


def test_a_rival_that_cannot_be_cut_at_an_instant_ends_no_answer() -> None:
    """An effect in a spell and a table that pitches are near here: no further recording can be laid out for both."""
    training = [recording("train_1", 1, SUPPORT), recording("train_2", 2, SUPPORT)]
    found = diagnose(SPECIMEN, training)
    assert found.finished and found.verdict != "nothing_missing"
