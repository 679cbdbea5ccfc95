"""A weak effect that makes recordings held out less likely is a suspect, not a name."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.answer import unconfirmed
from diagnosis.answer.by_score import SURE
from diagnosis.answer.heldout import likelier
from diagnosis.answer.judgement import FITTED, undecided
from diagnosis.answer.unconfirmed import unless_unconfirmed
from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.search.candidates import candidates
from diagnosis.search.null import Null
from diagnosis.search.refit import Explanation, extend
from tests.diagnosis.made import SPECIMEN, recording
from tests.diagnosis.search.made_up import A, B, fit, search

HELD: Any = SimpleNamespace()
NULL = Null(np.sort(np.random.default_rng(0).chisquare(1, 20_000)), 1.0)


@pytest.mark.parametrize(
    ("evidence", "held", "told"),
    [(25.0, -7.0, False), (25.0, 6.0, True), (SURE, -7.0, True), (SURE - 1.0, -0.1, False)],
)
def test_what_is_weak_needs_the_recordings_held_out(
    monkeypatch: pytest.MonkeyPatch, evidence: float, held: float, told: bool
) -> None:
    monkeypatch.setattr(unconfirmed, "evidence", lambda _: [evidence])
    monkeypatch.setattr(unconfirmed, "likelier", lambda *_: held)
    found = search(fit(loss=100.0), fit(A, loss=75.0))
    found.null = NULL
    before = replace(found)
    found.best, found.at_null = found.singles[0], before
    found.base = fit(loss=95.0)  # under errors estimated with the effect
    said = unless_unconfirmed(found, HELD)
    assert (said is found) is told
    if not told:
        assert said.best is None and said.base is before.base
        left_open = undecided(said, 1e-4)
        assert left_open is not None
        assert (left_open.name, left_open.gain, left_open.rests_on) == ("maxwell", evidence, FITTED)


def test_only_one_effect_that_always_acts_is_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unconfirmed, "evidence", lambda _: [25.0])
    monkeypatch.setattr(unconfirmed, "likelier", lambda *_: -7.0)
    found = search(fit(loss=100.0))
    found.null = NULL
    assert unless_unconfirmed(found, HELD) is found
    for best in (fit(A, B, loss=50.0), SimpleNamespace(candidates=(A,), in_spell=True)):
        found.best = best
        assert unless_unconfirmed(found, HELD) is found
    found.best = fit(A, loss=75.0)
    assert unless_unconfirmed(found, None) is found
    assert unless_unconfirmed(found, HELD).best is None


def test_a_diagnosis_asks_the_recordings_held_out(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []
    module = import_module("diagnosis.answer.diagnose")
    monkeypatch.setattr(module, "unless_unconfirmed", lambda found, held: asked.append(held) or found)
    answer = module.diagnose(SPECIMEN, [recording("a", 1)], [recording("b", 2)])
    assert answer.verdict == "nothing_missing"
    assert [r.name for held in asked for r in held.recordings] == ["b"]


@pytest.mark.parametrize(("held", "likely"), [({"gain": {"gain": 0.05}}, True), ({}, False)])
def test_what_acts_makes_recordings_held_out_likelier_and_what_does_not_less(
    held: dict[str, dict[str, float]], likely: bool
) -> None:
    measured = measure(SPECIMEN, [recording("a", 1, {"gain": {"gain": 0.05}})])
    fitted, errors = calibrated(SPECIMEN, measured)
    base = Explanation((), fitted)
    gain = next(one for one in candidates(measured, SPECIMEN) if one.name == "gain")
    best = extend(base, gain, np.array([0.05]), 20)
    other = measure(SPECIMEN, [recording("b", 2, held)], measured.reference_peak)
    found = likelier(base, best, other, errors)
    assert base.loss - best.loss > 10.0
    assert (found > 0.0) is likely and abs(found) > 5.0
    assert likelier(base, base, other, errors) == 0.0
