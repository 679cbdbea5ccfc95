"""A further element of a kind is tried beside the first, never alone, and the first is not taken out from under it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from diagnosis.errors.model import calibrated
from diagnosis.fit.setup import measure
from diagnosis.search import beside, exchange
from diagnosis.search.beside import seconds, split
from diagnosis.search.candidates import Candidate, candidates, firsts
from diagnosis.search.found import Search
from diagnosis.search.refit import Explanation
from diagnosis.search.screen import Score
from tests.diagnosis.buildings import SPECIMEN, made

FIRST = {"bouc_wen.post_yield_ratio": 0.25, "bouc_wen.yield_compression": 0.008, "bouc_wen.exponent": 1.0}


@cache
def beside_the_first() -> tuple[Search, Explanation, Candidate]:
    """Two runs of a body with one hysteretic element, explained by it, and a candidate of a further one."""
    measured = measure(SPECIMEN, [made("small", 1.0, 1, **FIRST), made("large", 2.5, 2, **FIRST)])
    fitted, errors = calibrated(SPECIMEN, measured)
    every = candidates(measured, SPECIMEN)
    first, second = (next(c for c in every if c.name == name) for name in ("bouc_wen", "bouc_wen_2"))
    found = Search(Explanation((), fitted), every, errors)
    values = {"bouc_wen.post_yield_ratio": 0.25, "bouc_wen.yield_compression": 0.008}
    start = np.array([x.coordinate(values[x.name]) for x in first.unknowns])
    misfit = replace(
        fitted.misfit,
        unknowns=(*fitted.misfit.unknowns, *first.unknowns),
        fixed={**fitted.misfit.fixed, **first.held},
    )
    explained = Explanation((first,), replace(fitted, misfit=misfit, u=np.concatenate([fitted.u, start])))
    return found, explained, second


def test_the_first_effect_is_no_further_element() -> None:
    found, _, _ = beside_the_first()
    names = {c.name for c in found.candidates}
    assert {"bouc_wen_2", "maxwell_2"} == names - {c.name for c in firsts(found.candidates)}


def test_beside_the_first_of_a_kind_the_second_is_tried() -> None:
    found, explained, _ = beside_the_first()
    tried = {score.candidate.name for score in seconds(found, explained)}
    assert "bouc_wen_2" in tried and "maxwell" in tried and not {"bouc_wen", "maxwell_2"} & tried


def test_split_in_two_the_element_is_where_it_was_before_the_shapes_move_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    """Half of the yielding each, at a third and at three times the compression."""
    _, explained, second = beside_the_first()
    monkeypatch.setattr(beside, "extend", lambda *asked: asked[:3])
    apart, candidate, start = split(explained, second)  # type: ignore[misc]
    values = {x.name: x.value(c) for x, c in zip(apart.fitted.misfit.unknowns, apart.fitted.u, strict=True)}
    new = [x.value(c) for x, c in zip(candidate.unknowns, start, strict=True)]
    assert values["bouc_wen.post_yield_ratio"] == pytest.approx(0.625) == new[0]
    assert values["bouc_wen.yield_compression"] == pytest.approx(0.008 / 3.0) and new[1] == pytest.approx(0.024)


@pytest.mark.parametrize(("widely", "statistic", "times"), [(True, 0.1, 1), (True, 950.0, 1), (False, 0.1, 0)])
def test_where_more_than_noise_is_left_no_score_keeps_the_element_from_being_split_once(
    widely: bool, statistic: float, times: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both share what one did: the second has no score until the first has moved."""
    found, explained, second = beside_the_first()
    others = [c for c in found.candidates if c.name in ("mullins", "payne", "gain")]
    column, asked = np.zeros((1, 1)), []
    scores = [Score(c, 900.0 - k, (c.null,), column) for k, c in enumerate(others)]
    scores = sorted([*scores, Score(second, statistic, (second.null,), column)], key=lambda s: -s.statistic)

    def tried(_: Explanation, candidate: Candidate, __: float) -> Explanation:
        asked.append(candidate.name)
        return explained

    monkeypatch.setattr(beside, "extend", lambda apart, *_: apart)
    monkeypatch.setattr(beside, "split", tried)
    monkeypatch.setattr(beside, "again", lambda one: one)
    monkeypatch.setattr(beside, "explains_all", lambda _: False)
    assert beside.extended(found, explained, scores, widely)
    assert asked == times * ["bouc_wen_2"]
    beside.extended(found, explained, scores, widely, but=second)
    assert asked == times * ["bouc_wen_2"]


def test_the_first_stays_while_a_further_one_stands_beside_it() -> None:
    _, explained, second = beside_the_first()
    both = replace(explained, candidates=(*explained.candidates, second))
    assert both.removable == (second,) and explained.removable == explained.candidates


def test_what_is_dropped_to_see_whether_it_is_needed_is_never_the_first(monkeypatch: pytest.MonkeyPatch) -> None:
    found, explained, second = beside_the_first()
    asked: list[str] = []

    def left_out(explanation: Explanation, candidate: Candidate) -> Explanation:
        asked.append(candidate.name)
        return replace(explanation, fitted=replace(explanation.fitted, loss=explanation.loss + 1e6))

    monkeypatch.setattr(exchange, "without", left_out)
    exchange.drop(replace(found, best=replace(explained, candidates=(*explained.candidates, second))))
    assert asked == ["bouc_wen_2"]
