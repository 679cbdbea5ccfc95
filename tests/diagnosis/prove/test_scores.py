"""Scores on answers made by hand, and the chain that writes, hashes and resumes."""

from __future__ import annotations

import json
import math
import re
import time
from dataclasses import replace
from pathlib import Path

import pytest

from diagnosis.prove import report
from diagnosis.prove.answers import NOTHING, answer, sha256
from diagnosis.prove.figures import draw_confusion
from diagnosis.prove.scores import Scored, Share, base_covered, confusion, covered, score
from tests.diagnosis.prove.answered import CASES, FIRST, estimate, key, said


def test_every_figure_by_hand() -> None:
    found = score(CASES)
    counts = {name: (f["count"], f["of"]) for name, f in found.items() if isinstance(f, dict) and "of" in f}
    assert counts["false_alarm"] == (1, 2)
    assert counts["mismatch_alarm"] == (1, 1)
    assert counts["detected"] == (3, 4)
    assert counts["class_first"] == (2, 4)
    assert counts["class_first_detected"] == (2, 3)
    assert counts["class_first_strict"] == (1, 4)
    assert counts["class_first_weak"] == (0, 1)
    assert counts["rivals_cover"] == (3, 4)
    assert found["rivals_mean"] == pytest.approx((1 + 2 + 1) / 3)
    assert counts["pairs_both"] == (1, 2)
    assert counts["pairs_one"] == (2, 2)
    assert counts["interval_coverage"] == (1, 2)
    assert counts["base_coverage"] == (3, 3)
    assert counts["open_recall"] == (1, 2)
    assert counts["open_detected"] == (2, 2)
    assert counts["open_false"] == (1, 9 + 1)
    assert counts["open_precision"] == (1, 2)
    assert counts["share_of_achievable"] == (0, 0)  # none of these predicts a recording
    assert found["seconds_median"] == 1.0 and found["seconds_most"] == 9.0
    assert found["processor_seconds_median"] == 0.5 and found["processor_seconds_most"] == 4.5


def predicting(case: Scored, share: float | None) -> Scored:
    """The same with what the answer achieves on the recording held out."""
    return replace(case, answer={**case.answer, "fit": {"holdout": {"share_of_achievable": share}}})


def test_what_laws_outside_and_named_effects_achieve() -> None:
    law, single = key("open", "x"), key("single", "gain")
    cases = [
        predicting(Scored("1", said("not_in_library"), law), 0.9),
        predicting(Scored("2", said("missing", ["gain"]), law), 0.5),
        predicting(Scored("3", said("not_in_library"), law), 0.4),
        predicting(Scored("4", said("nothing_missing"), law), None),  # nothing is removed
        predicting(Scored("5", said("not_in_library"), law), None),  # there was nothing to remove
        Scored("6", {"verdict": "failed", "statement": "", **NOTHING}, law),
        predicting(Scored("7", said("missing", ["gain"]), single), 0.96),
        predicting(Scored("8", said("missing", ["gain"]), key("pair", "gain", "delay")), 0.8),
        predicting(Scored("9", said("missing", ["delay"]), single), 0.1),  # not the hidden one
        predicting(Scored("10", said("missing", ["gain"]), key("single", "gain", weak=True)), 0.1),
    ]
    found = report.summary(cases)
    share = found["intervals"]["share_of_achievable"]
    assert (share["count"], share["of"], found["share_of_achievable"]) == (2, 5, 0.4)
    assert [share["low95"], share["high95"]] == pytest.approx([0.0527, 0.8534], abs=1e-4)
    assert found["share_of_achievable_open_median"] == 0.4
    assert found["share_of_achievable_named_median"] == pytest.approx(0.88)
    assert found["open_precision"] == 1.0
    shown = report.table(found, "x")
    assert re.search(r"share_of_achievable +0\.400 +\[0\.053, 0\.853\] +2 of 5", shown)
    assert re.search(r"share_of_achievable_named_median +0\.88", shown) and "open_precision " in shown


def test_a_failed_case_is_a_wrong_answer() -> None:
    failed = {"verdict": "failed", "statement": "", **NOTHING, "seconds": 1.0}
    found = score([Scored("1", failed, key("single", FIRST)), Scored("2", failed, key("null"))])
    assert found["class_first"]["count"] == 0 and found["rivals_cover"]["count"] == 0
    assert found["false_alarm"]["count"] == 1


def test_share_is_exact_and_honest_at_the_ends() -> None:
    none = Share.of_flags([False] * 20)
    assert none.low95 == 0.0 and none.high95 == pytest.approx(1.0 - 0.025 ** (1 / 20))
    assert math.isnan(Share.of_flags([]).value) and Share.of_flags([]).high95 == 1.0


def test_over_peak_is_compared_in_radians() -> None:
    effect = {"name": "offset", "class": "offset", "parameters": {"offset_over_peak": 0.1}}
    hidden = {**key("single"), "effects": [effect]}
    own = {"offset_over_peak": estimate(0.04, 0.06)}
    answered = {"effects": [{"name": "offset", "parameters": own}], "reference_peak": 0.04}
    assert covered(Scored("1", answered, hidden)) == [True]
    assert base_covered(Scored("1", {"base": {"width": estimate(0.27, 0.3)}}, hidden)) == [False]


def test_confusion_counts_every_case_but_pairs_once() -> None:
    rows, columns, counts = confusion(CASES)
    assert counts.sum() == sum(case.kind != "pair" for case in CASES)
    assert counts[rows.index(FIRST), columns.index(FIRST)] == 1
    assert counts[rows.index("nothing_missing"), columns.index("nothing_missing")] == 1


def test_tables_lines_and_figures_hold_every_case(tmp_path: Path) -> None:
    figures = report.summary(CASES)
    json.dumps(figures, allow_nan=False)
    assert "class_first " in report.table(figures, "x")
    assert len(report.wrong(CASES).splitlines()) == 8
    assert draw_confusion(CASES, tmp_path / "confusion.png").stat().st_size > 1000


def test_answers_are_kept_and_failures_are_answers(tmp_path: Path) -> None:
    def broken(folder: Path) -> dict:
        raise ValueError("no solution here")

    first = answer(tmp_path, tmp_path / "a" / "1.json", broken)
    assert first["verdict"] == "failed" and "no solution here" in first["statement"]
    before = sha256(tmp_path / "a" / "1.json")
    again = answer(tmp_path, tmp_path / "a" / "1.json", lambda folder: {"verdict": "missing"})
    assert again == first and sha256(tmp_path / "a" / "1.json") == before


def test_waiting_costs_time_by_the_clock_alone(tmp_path: Path) -> None:
    def waiting(folder: Path) -> dict:
        time.sleep(0.3)
        return {"verdict": "missing"}

    found = answer(tmp_path, tmp_path / "1.json", waiting)
    assert found["seconds"] >= 0.3 and found["processor_seconds"] < 0.15
