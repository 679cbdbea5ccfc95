"""The benchmark in small: a case through making, diagnosing and scoring, another one added, and laboratories."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks.diagnosis import weak_form
from benchmarks.diagnosis.bench import bench
from benchmarks.diagnosis.suite import place, suite
from diagnosis.prove.answers import Answering, diagnosed

SEED = 29
"""Its suite begins with a null and a hidden restitution, both at 1 % noise."""


@pytest.mark.parametrize("answering", [weak_form.answer, diagnosed], ids=["weak_form", "diagnosed"])
def test_cases_from_making_to_figures(answering: Answering, tmp_path: Path) -> None:
    first, second = suite(SEED)[:2]
    assert {first.kind, second.kind} == {"null", "single"} and first.noise == second.noise == 0.01

    def run(said: list[str], answering: Answering, cases: int) -> dict:
        return bench(
            "diagnosis",
            tmp_path,
            seed=SEED,
            cases=cases,
            minutes=10.0,
            jobs=1,
            run="a",
            say=said.append,
            answering=answering,
        )

    said: list[str] = []
    figures = run(said, answering, 1)
    assert figures["failed"] == []
    assert figures["by_kind"] == {first.kind: 1}
    assert figures["false_alarm" if first.kind == "null" else "class_first"] == float(first.kind != "null"), said
    assert json.loads((tmp_path / "diagnosis.json").read_text())["by_model"]["housner"]["cases"] == 1

    (answer,) = (place(tmp_path, SEED) / "a").glob("case_*.json")
    before = answer.stat().st_mtime_ns
    again: list[str] = []
    assert run(again, weak_form.answer, 2)["by_kind"] == {"null": 1, "single": 1}
    assert again[0] == "1 of 2 cases were answered before"
    assert answer.stat().st_mtime_ns == before and len([*answer.parent.glob("case_*.json")]) == 2


@pytest.mark.parametrize(("name", "key"), [("laboratory", "by_imperfection"), ("beginnings", "by_beginning")])
def test_benches_of_laboratories_from_making_to_figures(name: str, key: str, tmp_path: Path) -> None:
    figures = bench(
        name, tmp_path, seed=1_000, cases=2, minutes=10.0, jobs=1, run="a", say=lambda text: None,
        answering=weak_form.answer,
    )  # fmt: skip
    assert figures["cases"] == figures["asked"] == 2 and figures["failed"] == []
    written = json.loads((tmp_path / f"{name}.json").read_text())
    assert written[key] == figures[key] and sum(part["cases"] for part in written[key].values()) >= 1
