"""The benchmarks in small: cases made once, diagnosed and scored, and what else is told of the same cases."""

from __future__ import annotations

import json
import pickle
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from benchmarks.diagnosis import runner, weak_form
from benchmarks.diagnosis.bench import bench
from benchmarks.diagnosis.nameless import nameless
from benchmarks.diagnosis.power import power
from benchmarks.diagnosis.suite import place, suite
from diagnosis.prove.answers import Answering, diagnosed
from tests.diagnosis.prove.answered import CASES

SEED = 29
"""Its suite begins with a null and a single effect, both at 1 % noise."""
OF_LABORATORIES = 1_000
"""The seed of suites that begin with a null and a single effect, and with an effect that begins."""


class InThisProcess(ThreadPoolExecutor):
    """Takes what another process could take; that one would import and compile for longer than it works."""

    def submit(self, function: Any, /, *args: Any, **words: Any) -> Future[Any]:
        return super().submit(*pickle.loads(pickle.dumps((function, *args))), **words)


@pytest.fixture(autouse=True)
def in_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("runner", "power", "nameless"):
        monkeypatch.setattr(f"benchmarks.diagnosis.{name}.processes", InThisProcess)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Holds the cases: making one takes longer than most of what is asked of it."""
    return tmp_path_factory.mktemp("benches")


@pytest.mark.parametrize("answering", [weak_form.answer, diagnosed], ids=["weak_form", "diagnosed"])
def test_cases_from_making_to_figures(answering: Answering, folder: Path, request: pytest.FixtureRequest) -> None:
    first, second = suite(SEED)[:2]
    assert {first.kind, second.kind} == {"null", "single"} and first.noise == second.noise == 0.01

    name = request.node.callspec.id

    def run(said: list[str], answering: Answering, cases: int) -> dict:
        return bench(
            "diagnosis",
            folder,
            seed=SEED,
            cases=cases,
            minutes=10.0,
            jobs=1,
            run=name,
            say=said.append,
            answering=answering,
        )

    said: list[str] = []
    figures = run(said, answering, 1)
    assert figures["failed"] == []
    assert figures["by_kind"] == {first.kind: 1}
    assert figures["false_alarm" if first.kind == "null" else "class_first"] == float(first.kind != "null"), said
    assert json.loads((folder / "diagnosis.json").read_text())["by_model"]["housner"]["cases"] == 1

    (answer,) = (place(folder, SEED) / name).glob("case_*.json")
    before = answer.stat().st_mtime_ns
    again: list[str] = []
    assert run(again, weak_form.answer, 2)["by_kind"] == {"null": 1, "single": 1}
    assert again[0] == "1 of 2 cases were answered before"
    assert answer.stat().st_mtime_ns == before and len([*answer.parent.glob("case_*.json")]) == 2


def test_white_noise_is_seen_for_what_it_is(folder: Path) -> None:
    """What estimating the errors costs: bounded below by nothing at all, and small on white noise."""
    said: list[str] = []
    figures = power(folder, seed=SEED, cases=1, jobs=1, say=said.append)
    assert figures["cases"] == 1 and said[0].startswith("all: ")
    assert len(figures["by_mechanism"]) > 15
    low, median, _, high = figures["all"]
    assert low > 0.9 and 0.95 < median < 1.5 and high < 3.0
    assert json.loads((folder / "power.json").read_text())["all"] == figures["all"]


@pytest.mark.parametrize(
    ("name", "key", "cases"), [("laboratory", "by_imperfection", 2), ("beginnings", "by_beginning", 1)]
)
def test_benches_of_laboratories_from_making_to_figures(name: str, key: str, cases: int, folder: Path) -> None:
    figures = bench(
        name, folder, seed=OF_LABORATORIES, cases=cases, minutes=10.0, jobs=1, run="a", say=lambda text: None,
        answering=weak_form.answer,
    )  # fmt: skip
    assert figures["cases"] == figures["asked"] == cases and figures["failed"] == []
    written = json.loads((folder / f"{name}.json").read_text())
    assert written[key] == figures[key] and sum(part["cases"] for part in written[key].values()) >= 1


@pytest.mark.parametrize(
    ("name", "under"), [("walls", "interface"), ("stacks", "stacked"), ("laboratory", ""), ("bases", "")]
)
def test_figures_of_walls_and_stacks_are_written_under_their_model(
    name: str, under: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cases = [replace(case, key={**case.key, "group": "stack as block"}) for case in CASES]
    monkeypatch.setattr(runner, "run_all", lambda *given, **words: None)
    monkeypatch.setattr(runner, "answered", lambda *given: [(None, case) for case in cases])
    figures = bench(
        name, tmp_path, seed=SEED, cases=3, minutes=0.0, jobs=1, run="a", say=lambda text: None,
        answering=weak_form.answer,
    )  # fmt: skip
    assert figures["class_first"] == 0.5 and figures["asked"] == 3
    whole = json.loads((tmp_path / f"{name}.json").read_text())
    assert whole == ({under: figures} if under else figures)
    (beside,) = (tmp_path / name).glob("*/a.json")
    assert json.loads(beside.read_text()) == whole


def test_cases_of_one_kind_are_those_of_the_whole_seed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[list[Any]] = []
    monkeypatch.setattr(runner, "run_all", lambda designs, *given, **words: asked.append(list(designs)))
    for kind in (None, "pair"):
        bench(
            "walls", tmp_path, seed=SEED, cases=None, kind=kind, minutes=0.0, jobs=1, run="a", say=lambda text: None,
            answering=weak_form.answer,
        )  # fmt: skip
    assert asked[1] == [design for design in asked[0] if design.kind == "pair"] and len(asked[1]) >= 20


def test_a_single_effect_from_making_to_where_it_acts(folder: Path) -> None:
    """Phase and side without a name, of a case with a laboratory's errors."""
    figures = nameless(folder, seed=OF_LABORATORIES, cases=3, jobs=1, say=lambda text: None)
    assert figures["both"]["of"] == len(figures["rows"]) >= 1
    assert json.loads((folder / "places.json").read_text())["phase"] == figures["phase"]
    assert all(row["true"] for row in figures["rows"])
