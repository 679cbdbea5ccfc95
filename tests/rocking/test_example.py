"""The examples run as they are printed."""

from __future__ import annotations

import importlib
import runpy
from pathlib import Path

import matplotlib
import numpy as np
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


def test_paper_walls(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One motion of the ten: below its onset a rigid wall stands still, on rubber it opens all the same."""
    matplotlib.use("agg")
    monkeypatch.syspath_prepend(EXAMPLES / "paper_walls")
    compare, drawing, walls = (importlib.import_module(name) for name in ("compare", "drawing", "walls"))
    found = walls.outcomes((3,))
    for name, wall in walls.WALLS.items():
        assert not any(said[0].overturns for said in found[name].values())
        for label, specimen in walls.specimens(wall).items():
            (said,) = found[name][label]
            if specimen.model in ("housner", "stacked"):
                rocks = wall.pga > walls.derived(specimen)["onset_acceleration"]
                assert np.isfinite(said.lifts) == (said.peak > 0.0) == rocks
            else:
                assert said.lifts < 10.0 and 5.0 < said.peak < 100.0
    assert walls.derived(walls.specimens(walls.WALLS["short"])["Housner"])["onset_acceleration"] == pytest.approx(0.2)
    assert "| Short wall, with rubber, 0.171 g | 0 of 1 | 0 of 1 | 0 of 1 | 1 of 1" in compare.over_motions(
        found, compare.rocks
    )
    assert "| stacked | 2 | 2.0 | 6 | 3.0 |" in compare.costs({"Housner": (0.001, 2.0), "stacked": (0.002, 6.0)})
    wall, motion = walls.WALLS["short"], walls.shaking(walls.WALLS["short"], 3)
    history = walls.histories(wall, motion)
    for name, draw in (
        ("wall", lambda: drawing.draw_wall(wall, motion, history)),
        ("peaks", lambda: drawing.draw_peaks(found)),
        ("motions", lambda: drawing.draw_motions([motion])),
    ):
        compare.save(draw, tmp_path / f"{name}.png")
        assert 10_000 < (tmp_path / f"{name}.png").stat().st_size < 150_000
