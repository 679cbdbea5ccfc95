"""Phase and side without a name: what counts as right."""

from __future__ import annotations

import pytest

from benchmarks.diagnosis.nameless import agreement
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
