"""Two runs over the same cases are held against each other."""

from __future__ import annotations

from copy import deepcopy

import pytest

from benchmarks.diagnosis.same import TOLERANCE, differences

ANSWER = {
    "verdict": "missing",
    "effects": [{"name": "tilt", "evidence": 80.0,
                 "parameters": {"tilt": {"estimate": 0.01, "low95": 0.008, "high95": 0.012}}}],
    "rivals": [{"name": "eccentricity", "evidence_gap": 3.0}],
    "constancy": [],
    "located": [],
    "base": {"width": {"estimate": 0.25, "low95": 0.24, "high95": 0.26}},
}  # fmt: skip


def test_the_same_answer_differs_in_nothing() -> None:
    words, sizes = differences(ANSWER, deepcopy(ANSWER))
    assert words == [] and len(sizes) == 8 and all(size == 0.0 for _, size in sizes)


@pytest.mark.parametrize(("key", "value"), [("verdict", "not_in_library"), ("rivals", []), ("effects", [])])
def test_other_words_are_said(key: str, value: object) -> None:
    words, _ = differences(ANSWER, {**ANSWER, key: value})
    assert len(words) == 1 and words[0].startswith(key)


def test_a_number_that_moves_is_said_with_its_size() -> None:
    other = deepcopy(ANSWER)
    other["base"]["width"]["estimate"] = 0.2525  # type: ignore[index,call-overload]
    _, sizes = differences(ANSWER, other)
    moved = [(name, size) for name, size in sizes if size > TOLERANCE]
    assert [name for name, _ in moved] == ["estimate of base.width"] and moved[0][1] == pytest.approx(0.0025 / 0.2525)
