"""A weak effect alone counts as its score does: chance brings that as rarely as stated."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.answer import by_score, judgement, unconfirmed
from diagnosis.answer.by_score import SURE, as_scored
from diagnosis.answer.judgement import REFIT, undecided
from diagnosis.answer.unconfirmed import unless_unconfirmed
from diagnosis.errors.adequacy import Inadequacy
from diagnosis.errors.model import calibrated
from diagnosis.fit.linearisation import linearise_about
from diagnosis.fit.setup import measure
from diagnosis.search.candidates import candidates, firsts
from diagnosis.search.found import Search
from diagnosis.search.null import Null, null_distribution
from diagnosis.search.refit import Explanation, extend
from diagnosis.search.screen import Score, score
from tests.diagnosis.made import SPECIMEN, recording
from tests.diagnosis.search.made_up import A, B, fit, search
from tests.diagnosis.walls import WALL, recorded

NULL = Null(np.sort(np.random.default_rng(0).chisquare(1, 20_000)), 1.0)
SMALL = Inadequacy((0.0,), 0.0, 0.0, True)


def scored(statistic: float, slope: bool = True, of: Any = A) -> Any:
    return Score(of, statistic, (), np.zeros((1, 1)), slope)


def weak(*scores: Any, gain: float = 25.0) -> Any:
    """A search that took one effect."""
    found = search(fit(loss=100.0), fit(A, loss=100.0 - gain))
    found.scores, found.null = list(scores), NULL
    found.best = found.singles[0]
    return found


@pytest.fixture(params=[True, False])
def white(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> bool:
    monkeypatch.setattr(by_score, "passes_for_white", lambda *_: request.param)
    return bool(request.param)


def test_a_gain_is_no_larger_than_the_score(white: bool) -> None:
    found = weak(scored(9.0, of=B), scored(4.0))
    assert as_scored(found, A, 25.0) == (4.0 if white else 25.0)
    assert as_scored(found, A, 3.0) == 3.0 and as_scored(found, A, SURE) == SURE
    assert as_scored(weak(scored(4.0, slope=False)), A, 25.0) == 25.0 == as_scored(weak(scored(4.0, of=B)), A, 25.0)


def test_the_errors_of_the_base_model_say_whether_they_may_hold_it(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []
    monkeypatch.setattr(by_score, "passes_for_white", lambda base, errors: asked.append((base, errors)) or True)
    found, before = weak(scored(11.0)), weak(scored(4.0))
    found.at_null = before
    assert as_scored(found, A, 25.0) == 4.0 and asked == [(before.base, before.errors)]


def test_what_chance_brings_is_no_name(white: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unconfirmed, "evidence", lambda found: [found.base.loss - found.best.loss])
    found = weak(scored(2.0))
    said = unless_unconfirmed(found, None)
    assert (said is found) is not white
    if white:
        left_open = undecided(said, 0.2)
        assert said.best is None and left_open is not None
        assert (left_open.name, left_open.gain, left_open.rests_on) == ("maxwell", 25.0, REFIT)
    for found in (weak(scored(12.0)), weak(scored(2.0), gain=SURE)):
        assert unless_unconfirmed(found, None) is found


def test_p_values_of_what_is_weak_and_alone_are_those_of_the_score(white: bool) -> None:
    found = weak(scored(4.0), scored(4.0, of=B))
    counted = NULL.p_value(4.0 if white else 25.0)
    assert judgement.p_of_effects(found, [25.0], (A,)) == [max(counted, 1e-6)]
    assert judgement.p_of_effects(found, [18.0, 17.0], (A, B)) == [NULL.p_value(18.0), NULL.p_value(17.0)]
    found.best = None
    assert judgement.p_of_missing(found, [], SMALL, (), (), True) == max(counted, 1e-6)


def test_the_score_of_a_weak_effect_is_about_its_gain() -> None:
    """Of a sensor that reads 3 % too much, and of one that does not."""
    found = {}
    for size in (0.0, 0.03):
        measured = measure(SPECIMEN, [recording("a", 1, {"gain": {"gain": size}} if size else {})])
        fitted, errors = calibrated(SPECIMEN, measured)
        base, opened = Explanation((), fitted), linearise_about(fitted)
        some = candidates(measured, SPECIMEN)
        scores = score(opened, firsts(some), {}, True)
        made = Search(base, some, errors, scores=scores, null=null_distribution(opened, scores))
        gain = next(one for one in some if one.name == "gain")
        made.singles = [extend(base, gain, gain.null)]
        found[size] = SimpleNamespace(
            gain=made.gain(made.singles[0]), scored=as_scored(made, gain, made.gain(made.singles[0])),
            p=judgement.p_of_missing(made, [], SMALL, (), (), True),
        )  # fmt: skip
    assert SURE > found[0.03].gain > 10.0
    assert 0.8 * found[0.03].gain < found[0.03].scored < found[0.03].gain  # it counts as its score does
    assert found[0.03].p < 0.05 < found[0.0].p


@pytest.mark.proof
@pytest.mark.parametrize(
    "law",
    [
        {"maxwell.arm_stiffness_ratio_base": 0.043, "maxwell.relaxation_time_base": 0.1},
        {"maxwell.arm_stiffness_ratio_top": 0.32, "maxwell.relaxation_time_top": 0.1},
        {"viscous_damping.couple_damping": 700.0},
        {"coulomb_damping.over_m_g_b": 0.0075},
        {"tilt.tilt": 0.0016},
    ],
    ids=lambda law: next(iter(law)),
)
def test_the_score_of_what_acts_weakly_on_a_wall_is_beyond_chance(law: dict[str, float]) -> None:
    """The effect gains 15 to 40 from its true values."""
    measured = measure(WALL, [recorded(seed, tuple(law.items())) for seed in (1, 2)])
    base = Explanation((), calibrated(WALL, measured)[0])
    some, opened = candidates(measured, WALL), linearise_about(base.fitted)
    scores = score(opened, firsts(some), {}, True)
    entry = next(one for one in scores if {x.name for x in one.candidate.unknowns} == law.keys())
    true = np.array([x.coordinate(law[x.name]) for x in entry.candidate.unknowns])
    gain = base.loss - extend(base, entry.candidate, true).loss
    assert 15.0 < gain < SURE
    assert null_distribution(opened, scores).p_value(entry.statistic) < judgement.CHANCE
