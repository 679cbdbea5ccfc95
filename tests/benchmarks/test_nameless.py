"""Phase and side without a name: what counts as right, and one case from making to its row."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks.diagnosis.nameless import agreement, nameless
from diagnosis.data.measured import identification_of
from models import get

BLOCK = identification_of(get("housner"))


@pytest.mark.parametrize(
    ("kind", "true", "said", "phase", "side"),
    [
        ("force", {"between_impacts"}, {"between_impacts"}, True, True),
        ("force", {"between_impacts", "right"}, {"between_impacts"}, True, False),
        ("force", {"impact"}, {"between_impacts"}, False, True),
        ("force", {"impact"}, {"everywhere"}, False, True),
        ("error", {"everywhere"}, {"everywhere"}, True, True),
        ("error", {"everywhere"}, {"impact", "left"}, False, False),
        ("base", {"between_impacts"}, {"everywhere"}, True, True),
        ("base", {"between_impacts"}, {"impact"}, False, True),
        ("force", {"impact"}, set(), False, False),
    ],
)
def test_what_counts_as_right(kind: str, true: set[str], said: set[str], phase: bool, side: bool) -> None:
    assert agreement(BLOCK, kind, true, said) == {"phase": phase, "side": side}


def test_a_single_effect_from_making_to_its_row(tmp_path: Path) -> None:
    figures = nameless(tmp_path, seed=1_000, cases=3, jobs=1, say=lambda text: None)
    assert figures["both"]["of"] == len(figures["rows"]) >= 1
    assert json.loads((tmp_path / "places.json").read_text())["phase"] == figures["phase"]
    assert all(row["true"] for row in figures["rows"])
