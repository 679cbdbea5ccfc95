"""The examples run as they are printed."""

from __future__ import annotations

import runpy
from pathlib import Path

import matplotlib
import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def test_first_map(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    matplotlib.use("agg")
    monkeypatch.chdir(tmp_path)
    found = runpy.run_path(str(EXAMPLES / "first_map.py"))
    assert "pga_overturned" in capsys.readouterr().out
    assert (tmp_path / "results" / "first_map" / "first_map.png").stat().st_size > 5000
    overturning = found["cube"].rocking.overturning_map(x="aspect_ratio", y="top_mass")
    # slender walls overturn, stocky ones do not, at this record's intensities
    assert overturning[:, 0].notnull().all() and overturning[:, -1].isnull().any()
