"""Overlap of said and true intervals, and instants, by hand."""

from __future__ import annotations

from typing import Any

import pytest

from diagnosis.prove.places import instants_right, merged, overlap
from diagnosis.prove.scores import Scored


def case(located: list[tuple[str, float, float]], stages: list[dict[str, Any]], **recordings: Any) -> Scored:
    said = [{"recording": name, "start": start, "end": end} for name, start, end in located]
    effects = [{"name": "gain", "class": "gain", "stages": stages}]
    key = {"kind": "single", "effects": [{"name": "gain", "class": "gain"}], "recordings": recordings}
    return Scored("1", {"verdict": "missing", "effects": effects, "rivals": [], "located": said}, key)


BEGINS = {"train_1": {"active": [], "duration": 10.0}, "train_2": {"active": [[4.0, 10.0]], "duration": 10.0}}


def test_intervals_are_merged() -> None:
    assert merged([(3.0, 4.0), (0.0, 1.0), (0.5, 2.0), (4.0, 5.0)]) == [(0.0, 2.0), (3.0, 5.0)]


def test_overlap_counts_all_recordings_learned_from() -> None:
    assert overlap(case([("train_2", 4.0, 10.0)], [], **BEGINS)) == 1.0
    assert overlap(case([("train_2", 7.0, 10.0)], [], **BEGINS)) == pytest.approx(0.5)
    assert overlap(case([("train_2", 4.0, 10.0), ("train_1", 0.0, 6.0)], [], **BEGINS)) == pytest.approx(0.5)
    assert overlap(case([], [], **BEGINS)) == 0.0
    assert overlap(case([], [], train_1={"active": [[0.0, 10.0]], "duration": 10.0})) is None
    assert overlap(case([], [], train_1={"strength": 3.0})) is None


def test_an_instant_is_right_within_a_cycle() -> None:
    def stage(begins: float, recording: str = "train_2") -> dict[str, Any]:
        return {"recording": recording, "begins": begins, "ends": float("inf")}

    cycles = {**BEGINS, "train_2": {**BEGINS["train_2"], "cycles": [0.6]}}
    assert instants_right(case([], [stage(4.5)], **cycles)) is True
    assert instants_right(case([], [stage(4.7)], **cycles)) is False
    assert instants_right(case([], [stage(4.5, "train_1")], **cycles)) is False
    assert instants_right(case([], [], **cycles)) is False
    whole = {"train_1": {"active": [], "duration": 10.0}, "train_2": {"active": [[0.0, 10.0]], "duration": 10.0}}
    assert instants_right(case([], [], **whole)) is None
