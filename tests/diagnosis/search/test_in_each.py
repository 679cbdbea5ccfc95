"""Effects that come and go in every test, at instants of its own in each: found with them, and never for less."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnosis.answer.result import EffectStage
from diagnosis.answer.when import LASTS, may_change_again, stages_of, when_text
from diagnosis.search import beginnings, in_each
from diagnosis.search.asked import asked_for
from diagnosis.search.budget import ENDED
from diagnosis.search.found import MISSING, Search, adjusted
from diagnosis.search.in_each import asks_for_instants, in_own_runs, without_idle, without_shape
from diagnosis.search.refit import Explanation, extend
from diagnosis.search.runs import runs_of
from diagnosis.search.spells import ALWAYS, NEVER, InEach, Spell, holds, interval_of
from grids.recordings.base import Recording
from tests.diagnosis.search.changing import made, opened, screened, searched

WHEN = {1: (5.2, 8.0), 6: (5.0, 8.5)}
"""s, by the seed of a recording."""


def engaged(name: str, seed: int, effect: str, value: float, null: float) -> Recording:
    begins, ends = WHEN[seed]
    return made(name, seed, [(begins, {effect: value}), (ends, {effect: null})])


@pytest.fixture(scope="module")
def dashpot() -> tuple[Search, list[Search]]:
    recordings = [engaged(name, seed, "viscous_damping.rate", 0.6, 0.0) for name, seed in (("a", 1), ("b", 6))]
    return searched(recordings, among=("viscous_damping", "tilt"))


def test_a_dashpot_that_engages_in_every_test_is_named_with_its_instants(dashpot: tuple[Search, list[Search]]) -> None:
    best = dashpot[1][-1].best
    assert best is not None and best.names == ("viscous_damping",)
    [candidate] = best.candidates
    assert isinstance(candidate.spell, InEach)
    stages = stages_of(best, candidate)
    for stage, seed in zip(stages, (1, 6), strict=True):
        for found, low, high, true in zip(
            (stage.begins, stage.ends), (stage.begins_low95, stage.ends_low95),
            (stage.begins_high95, stage.ends_high95), WHEN[seed], strict=True,
        ):  # fmt: skip
            assert found == pytest.approx(true, abs=0.7)
            assert low is not None and high is not None and low - 0.15 <= true <= high + 0.15
    assert best.fitted.values["viscous_damping.rate"] == pytest.approx(0.6, rel=0.1)
    assert when_text(stages).startswith("in each recording for a while: from ") and " and from " in when_text(stages)
    assert may_change_again(candidate.spell, 2)


def test_each_recordings_interval_has_the_price_of_a_spell(dashpot: tuple[Search, list[Search]]) -> None:
    best = dashpot[1][-1].best
    assert best is not None
    [candidate] = best.candidates
    assert candidate.price > 0.0
    for one in dashpot[1][-1].tried:
        spell = one.candidates[0].spell
        if isinstance(spell, Spell):
            assert one.candidates[0].price == pytest.approx(candidate.price / 2)
            assert adjusted(one) - adjusted(best) >= MISSING


def test_what_acts_for_a_moment_in_every_test_is_a_blow() -> None:
    recordings = [engaged(name, seed, "viscous_damping.rate", 0.6, 0.0) for name, seed in (("a", 1), ("b", 6))]
    found, yielded = searched(recordings, shortest=5.0)
    assert yielded == [] and found.best is None and found.blow is not None
    assert found.blow.stronger.endswith(" of b") and " of a and from " in found.blow.stronger


def test_recordings_that_ask_for_their_instants_keep_them(dashpot: tuple[Search, list[Search]]) -> None:
    best = dashpot[1][-1].best
    assert best is not None
    kept = without_idle(best, best.candidates[0].price / 2)
    assert kept.candidates[0].spell == best.candidates[0].spell and adjusted(kept) <= adjusted(best) + 1e-6


@pytest.mark.parametrize(
    ("gains", "fits_in_it", "asks"),
    [
        ([60.0, 25.0, 1.0], False, True),
        ([60.0, 5.0, 1.0], False, False),
        ([60.0, 5.0, 1.0], True, True),
        ([9.0, 3.0, 1.0], True, False),
    ],
)
def test_one_window_asks_only_where_it_fits_with_the_instants_and_badly_without(
    gains: list[float], fits_in_it: bool, asks: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    single: Any = SimpleNamespace(loss=0.0)
    simpler: Any = SimpleNamespace(loss=sum(gains))
    monkeypatch.setattr(in_each, "gain_by_window", lambda *_: np.array(gains))
    monkeypatch.setattr(in_each, "adjusted", lambda e: e.loss)
    monkeypatch.setattr(in_each, "settles", lambda *_: fits_in_it)
    assert asks_for_instants(single, simpler) is asks


def test_instants_that_hardly_count_are_taken_off(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is left is a spell then, which is sought apart."""
    staged: Any = replace(screened()[0].candidate, spell=InEach(((2.0, 4.0), (0.0, 8.0))), price=12.0)
    measured: Any = SimpleNamespace(recordings=[0, 1])
    single = Explanation((staged,), SimpleNamespace(measured=measured, loss=0.0))  # type: ignore[arg-type]
    losses = {((2.0, 4.0), ALWAYS): 5.0, ((2.0, 4.0), NEVER): 40.0}

    def refitted(one: Explanation, spell: InEach) -> Explanation:
        fitted: Any = SimpleNamespace(measured=measured, loss=losses.get(spell.intervals, 300.0))
        return replace(one, candidates=(replace(one.candidates[0], spell=spell),), fitted=fitted)

    monkeypatch.setattr(in_each, "refitted_in", refitted)
    monkeypatch.setattr(in_each, "again", lambda one: one)
    monkeypatch.setattr(in_each, "asks_for_instants", lambda one, other: other.loss - one.loss > 15.0)
    left = without_idle(single, 6.0).candidates[0]
    assert isinstance(left.spell, InEach) and left.spell.intervals == ((2.0, 4.0), ALWAYS)
    assert left.spell.is_spell and left.price == 6.0


def test_what_the_budget_does_not_reach_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(beginnings, "RESERVED", 0.0)
    found, yielded = searched([made("a", 13, []), made("b", 6, [(6.0, {})], 0.06)])
    assert yielded == [] and found.best is None
    assert found.not_tried["effects that come and go in every recording"] == ENDED
    assert found.not_tried["offset from or to an instant"] == ENDED


def test_the_recordings_ask_for_the_true_intervals_from_wrong_ones(dashpot: tuple[Search, list[Search]]) -> None:
    best = dashpot[1][-1].best
    assert best is not None
    [candidate] = best.candidates
    wrong = replace(candidate, spell=InEach(((0.0, 5.0), ALWAYS)))
    spell = asked_for(replace(best, candidates=(wrong,)))
    assert isinstance(spell, InEach)
    for (begins, ends), seed in zip(spell.intervals, (1, 6), strict=True):
        assert begins == pytest.approx(WHEN[seed][0], abs=1.0) and ends == pytest.approx(WHEN[seed][1], abs=1.0)


def test_the_screen_finds_the_best_of_all_pairs_of_runs() -> None:
    """Held against every pair; the statistic of a pair is that of the mechanism acting in these windows alone."""
    measured, screen = opened()
    recording_of = measured.recording_of
    runs: Sequence[np.ndarray[tuple[int, int], np.dtype[np.int64]]] = [runs_of(recording_of, r) for r in (0, 1)]
    for one in in_own_runs(screen, screened(), measured):
        acting = np.array([holds(measured, one.spell, k) for k in range(recording_of.size)])
        column = np.where(acting[:, None], one.score.column, 0.0)

        def statistic(column: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> float:
            weighted = screen.weights[:, None] * column
            path = np.einsum("wmi,wm->i", screen.by_unknown, weighted)
            free = float(np.sum(weighted * column)) - path @ screen.inverse @ path
            amount = float(np.sum(weighted * screen.residual)) - path @ screen.inverse @ screen.gradient
            return float(amount**2 / free)

        assert one.statistic == pytest.approx(statistic(column), rel=1e-6)
        largest = 0.0
        for low, high in product(*runs):
            window = np.arange(recording_of.size)
            both = ((low[0] <= window) & (window <= low[1])) | ((high[0] <= window) & (window <= high[1]))
            largest = max(largest, statistic(np.where(both[:, None], one.score.column, 0.0)))
        if one.score.side == 0:
            assert one.statistic >= 0.98 * largest


def test_an_interval_of_windows_holds_these() -> None:
    measured, _ = opened()
    own = np.flatnonzero(measured.recording_of == 1)
    interval = interval_of(measured, int(own[2]), int(own[4]))
    held = [holds(measured, InEach((NEVER, interval)), k) for k in range(len(measured.windows))]
    assert np.flatnonzero(held).tolist() == own[2:5].tolist()
    assert interval_of(measured, int(own[0]), int(own[-1])) == ALWAYS


@pytest.mark.parametrize(
    ("intervals", "is_spell", "instants"),
    [
        ((ALWAYS, (0.0, 3.0)), True, 1),
        (((2.0, LASTS), NEVER), True, 1),
        (((2.0, LASTS), (0.0, 3.0)), False, 2),
        (((2.0, 4.0), (1.0, 3.0)), False, 4),
    ],
)
def test_intervals_in_fewer_than_two_recordings_are_a_spell(
    intervals: tuple[tuple[float, float], ...], is_spell: bool, instants: int
) -> None:
    spell = InEach(intervals)
    assert spell.is_spell is is_spell and spell.instants == instants
    assert [one.recording for one in spell.stages(("a", "b"))] == ["a", "b"]
    assert len(spell.parts) == sum(ends > begins for begins, ends in intervals)


def test_a_shape_that_stands_for_an_interval_is_taken_off() -> None:
    measured, _ = opened()
    from diagnosis.fit.setup import base_fit
    from diagnosis.search.candidates import candidates
    from tests.diagnosis.made import SPECIMEN

    [spring] = [c for c in candidates(measured, SPECIMEN) if c.name == "added_stiffness"]
    assert len(spring.unknowns) == 2
    fitted = extend(Explanation((), base_fit(SPECIMEN, measured)), spring, spring.null + np.array([0.1, 0.02]), 0)
    plain = without_shape(fitted)
    assert plain.part(spring)[1] == spring.null[1] and plain.part(spring)[0] == fitted.part(spring)[0]


def test_one_interval_after_another_is_not_interrupted() -> None:
    stages = (EffectStage("a", 4.0, LASTS), EffectStage("b", 0.0, 3.0))
    assert when_text(stages) == "from 4.0 s of a to 3.0 s of b"
    apart = (EffectStage("a", 4.0, LASTS), EffectStage("b", 1.0, 3.0))
    assert when_text(apart) == "in each recording for a while: from 4.0 s to the end of a and from 1.0 s to 3.0 s of b"
