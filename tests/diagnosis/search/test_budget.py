"""A search whose budget of work ends gives its best answer so far and says what it did not try."""

from __future__ import annotations

from importlib import import_module

import numpy as np
import pytest

import models
from diagnosis import diagnose
from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.progress import silent
from diagnosis.search import beginnings
from diagnosis.search.budget import ENDED, Budget
from diagnosis.search.candidates import candidates
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation
from models.housner.lanes.run import BENDING, substeps
from models.runs import DONE
from tests.diagnosis.made import SPECIMEN, TIME_STEP, TRUE, motion, recording, searched
from tests.models.interface.walls import SHORT

chain = import_module("diagnosis.answer.diagnose")
TRIED = ("viscous_damping", "restitution")


def test_what_a_spent_budget_leaves_out_is_said() -> None:
    measured = measure(SPECIMEN, [recording(f"train_{k}", k, {"viscous_damping": {"rate": 0.15}}) for k in (1, 2)])
    before = DONE.steps
    fitted, errors = calibrated(SPECIMEN, measured)
    assert DONE.steps - before > 10 * measured.mask.sum()
    tried = tuple(c for c in candidates(measured, SPECIMEN) if c.name in TRIED)
    ended = searched(Search(Explanation((), fitted), tried, errors, budget=Budget(0.0)))
    assert ended.best is None and ended.not_tried == dict.fromkeys(TRIED, ENDED)
    whole = searched(Search(Explanation((), fitted), tried, errors))
    assert whole.best is not None and whole.best.names == ("viscous_damping",)
    assert ENDED not in whole.not_tried.values()


def test_work_of_its_own_is_no_more_than_what_all_searches_have_together() -> None:
    measured = measure(SPECIMEN, [recording(f"train_{k}", k, {"viscous_damping": {"rate": 0.15}}) for k in (1, 2)])
    fitted, errors = calibrated(SPECIMEN, measured)
    tried = tuple(c for c in candidates(measured, SPECIMEN) if c.name in TRIED)
    search = Search(Explanation((), fitted), tried, errors, budget=Budget(np.inf), whole=Budget(-1.0))
    with search.work_of_its_own(np.inf):
        assert not search.affordable("tilt")
    assert search.not_tried == {"tilt": ENDED}


def test_stages_are_left_out_once_the_work_of_an_answer_is_done(monkeypatch: pytest.MonkeyPatch) -> None:
    measured = measure(SPECIMEN, [recording(f"train_{k}", k, {"viscous_damping": {"rate": 0.15}}) for k in (1, 2)])
    fitted, errors = calibrated(SPECIMEN, measured)
    tried = tuple(c for c in candidates(measured, SPECIMEN) if c.name in TRIED)
    found = searched(Search(Explanation((), fitted), tried, errors))
    found.whole = Budget(-1.0)
    monkeypatch.setattr(beginnings, "_settled", lambda _: False)
    monkeypatch.setattr(beginnings, "seconds", lambda *_: pytest.fail("a screen"))
    assert not list(beginnings.beside(found, silent))
    assert found.not_tried["effects that begin or end"] == ENDED


def test_an_answer_is_given_however_little_work_it_may_take(monkeypatch: pytest.MonkeyPatch) -> None:
    """And the law that it may lack in the first of several ways."""
    monkeypatch.setattr(chain, "SEARCH", 0.0)
    monkeypatch.setattr(import_module("diagnosis.answer.with_law"), "ANSWER", 0.0)
    answer = diagnose(SPECIMEN, [recording(f"train_{k}", k, {"viscous_damping": {"rate": 0.15}}) for k in (1, 2)])
    assert answer.finished and answer.verdict == "not_in_library" and not answer.effects
    assert answer.missing_force is not None
    assert answer.not_tried["viscous_damping"] == answer.not_tried["other laws in a table"] == ENDED
    assert "had tried" in answer.statement


def test_what_a_lane_step_of_a_wall_takes_is_counted_by_what_acts() -> None:
    model, shaking = models.get("interface"), motion(1, duration=1.0)
    steps, seconds = DONE.steps, DONE.seconds
    model.evaluate(SHORT, shaking, np.ones(3), outputs=["status"], tail=0.0)
    counted = (DONE.seconds - seconds - model.call_time) / (DONE.steps - steps)

    def step(**more: float) -> float:
        return model.step_time(model.build({**SHORT, **more}))

    plain, damped = step(), step(**{"viscous_damping.couple_damping": 2e4})
    hard = step(**{"hardening.beta2": 20.0})
    assert counted == pytest.approx(plain)
    assert damped > 2.0 * plain and hard > 2.0 * plain
    assert step(**{"viscous_damping.couple_damping": 2e4, "hardening.beta2": 20.0}) > 1.5 * max(damped, hard)


def test_a_step_of_a_bending_wall_counts_as_several() -> None:
    model, base = models.get("housner"), motion(1, duration=2.0)

    def work(frequency: float) -> int:
        before = DONE.steps
        values = {**TRUE, "wall_flexibility.first_frequency": frequency}
        model.simulate(values, base, duration=base.duration)
        return DONE.steps - before

    bending = model.build({**TRUE, "wall_flexibility.first_frequency": 20.0})
    steps = int(substeps(bending, TIME_STEP)[0]) * (base.horizontal.size - 1)
    assert work(20.0) >= BENDING * steps > 2 * steps
