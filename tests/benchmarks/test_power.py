"""What estimating the errors costs: bounded below by nothing at all, and small on white noise."""

from __future__ import annotations

import json
from pathlib import Path

from benchmarks.diagnosis.power import power


def test_white_noise_is_seen_for_what_it_is(tmp_path: Path) -> None:
    said: list[str] = []
    figures = power(tmp_path, seed=29, cases=1, jobs=1, say=said.append)
    assert figures["cases"] == 1 and said[0].startswith("all: ")
    assert len(figures["by_mechanism"]) > 15
    low, median, _, high = figures["all"]
    assert low > 0.9 and 0.95 < median < 1.5 and high < 3.0
    assert json.loads((tmp_path / "power.json").read_text())["all"] == figures["all"]
