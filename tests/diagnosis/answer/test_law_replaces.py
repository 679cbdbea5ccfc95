"""A law in a table in the place of what was named: from the answer to the files, and a simulation with them."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from diagnosis import diagnose
from diagnosis.answer.assembly import assemble
from diagnosis.answer.statement import statement
from diagnosis.answer.task import Task
from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.progress import Stages, silent
from diagnosis.report import extend as extended
from diagnosis.report import write_answer
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation, extend
from grids.specimen import read_specimen
from models.tables import KNOTS, row
from tests.diagnosis.made import SPECIMEN, recording

SUPPORT = {"table_force": {"oscillator_motion": 0.25, "oscillator_frequency": 3.4, "oscillator_damping": 0.05}}
RATE = 0.6
"""s-1, of a dashpot that works for rotations above zero only."""


def test_a_law_takes_the_place_of_a_dashpot() -> None:
    """A dashpot on both sides was named for one that works on one side: judged without its search."""
    hidden = {"table_force": {row("damping", "above", k): -RATE for k in range(KNOTS)}}
    training = [recording(f"train_{seed}", seed, hidden) for seed in (1, 2)]
    measured = measure(SPECIMEN, training)
    fitted, errors = calibrated(SPECIMEN, measured)
    dashpot = next(one for one in candidates(measured, SPECIMEN) if one.name == "viscous_damping")
    base = Explanation((), fitted)
    named = extend(base, dashpot, dashpot.null + 1.0)
    found = Search(base, (dashpot,), errors, singles=[named], tried=[named], best=named)
    answer = assemble(Task(SPECIMEN, None, 0, silent, 0, True, Stages()), found, None)
    assert answer.verdict == "not_in_library" and answer.missing_force is not None
    assert not answer.effects and not answer.rivals
    answer = replace(answer, statement=statement(answer, measured.model))
    assert "With what was found" not in answer.statement
    law = extended(SPECIMEN, answer).mechanisms["table_force"]
    above, below = ([law[row("damping", side, k)] for k in range(KNOTS)] for side in ("above", "below"))
    np.testing.assert_allclose(above, -RATE, rtol=0.02)
    np.testing.assert_allclose(below, 0.0, atol=0.05 * RATE)


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
