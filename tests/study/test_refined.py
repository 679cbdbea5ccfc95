"""A refined study: the whole study's numbers where it computes, resumed after a stop, open about what it infers."""

from __future__ import annotations

from pathlib import Path
from typing import cast

import matplotlib.pyplot
import numpy as np
import pytest
import xarray as xr

import models
import study.run
import study.task
from grids.plan import Plan, parse_plan
from grids.refinement import Estimate
from models.errors import InputError
from study.check import check
from study.figures.output import plot_output_map
from study.open import open_study
from study.refined import Refined, cells_of_a_block
from study.run import run
from study.state import state
from study.status import FAILED, OVERTURNED, ROCKING
from tests.study.plans import plan_text


def plan(name: str, refine: str = "[refine]\nbudget = 0.5\nguard = 60") -> Plan:
    text = plan_text(
        name=name,
        aspect="linspace = [0.1, 0.4, 40]",
        pga="linspace = [0.1, 0.8, 40], unit = 'g'",
        motion='pulse = { shape = "sine", amplitude = "1 g", frequency = "1 Hz", time_step = "0.01 s" }',
    )
    return parse_plan(text.replace("values = [0, 1, 3]", "values = [0]") + refine, Path.cwd())


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("refined")


@pytest.fixture(scope="module")
def whole(home: Path) -> xr.Dataset:
    return open_study(run(plan("whole", ""), results=home, scheduler="synchronous").folder)


def test_it_is_the_whole_study_where_it_computes(home: Path, whole: xr.Dataset) -> None:
    report = run(plan("refined"), results=home, scheduler="synchronous")
    cube = open_study(report.folder)
    there = cube["computed"].values == 1
    assert report.refined is not None and there.mean() == report.refined.estimate.computed_share <= 0.5
    for name in whole.data_vars:
        np.testing.assert_array_equal(cube[name].values[there], whole[name].values[there])
    assert np.isnan(cube["peak_rotation"].values[~there]).all()
    np.testing.assert_array_equal(cube["overturned"] == 1, cube["status"] == OVERTURNED)
    wrong = float((cube["status"] != whole["status"]).mean())
    estimate = report.refined.estimate
    assert estimate.low <= wrong <= estimate.high and f"{estimate.wrong_share:.3%}" in str(report)
    assert '"audited"' in cube.attrs["refinement"]
    np.testing.assert_array_equal(
        cube.rocking.overturning_map(x="aspect_ratio", y="pga").isnull().values, np.zeros((40, 40), dtype=bool)
    )
    assert check(report.folder, cells=50, seed=1).differing == ()
    assert "refined study" in str(state(report.folder))
    map_of_peaks = plot_output_map(cube, "peak_rotation", "aspect_ratio", "pga")
    assert "no value: not computed" in [text.get_text() for text in map_of_peaks.get_legend().get_texts()]
    matplotlib.pyplot.close(map_of_peaks.figure)
    (report.folder / "failed").mkdir(exist_ok=True)
    (report.folder / "failed" / "abc.txt").write_text("Traceback\nMemoryError: a block of 7 cells\n")
    assert "failed/abc.txt: MemoryError: a block of 7 cells" in str(state(report.folder))
    (report.folder / "failed" / "abc.txt").unlink()
    with pytest.raises(InputError, match="without \\[refine\\]"):
        run(plan("whole"), results=home)


def test_a_stopped_run_goes_on_and_changes_nothing(
    home: Path, whole: xr.Dataset, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever was stopped is asked for again; what was finished is read."""
    if not (home / "refined").exists():
        run(plan("refined"), results=home, scheduler="synchronous")
    monkeypatch.setattr(study.run, "cells_of_a_block", lambda folder, measured: cells_of_a_block(folder, lambda: 50))
    real, left = study.task.evaluate, [6]

    def stopping(*given: object) -> object:
        left[0] -= 1
        if left[0] < 0:
            raise KeyboardInterrupt
        return real(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(study.task, "evaluate", stopping)
    with pytest.raises(KeyboardInterrupt):
        run(plan("stopped"), results=home, scheduler="synchronous")
    monkeypatch.setattr(study.task, "evaluate", real)
    report = run(plan("stopped"), results=home, scheduler="synchronous")
    assert report.reused == 6 and report.computed > 0
    once, twice = open_study(home / "refined"), open_study(report.folder)
    for name in once.data_vars:
        np.testing.assert_array_equal(once[name], twice[name])


def test_cells_of_a_failed_block_hold_the_fill_value() -> None:
    """Whole numbers cannot hold nan."""
    status = np.array([ROCKING, FAILED, OVERTURNED], np.int8)
    refined = Refined(np.arange(3), {"impacts": np.array([4.0, np.nan, 7.0])}, status, cast(Estimate, None))
    impacts = next(q for q in models.get("housner").outputs if q.name == "impacts")
    assert refined.values(impacts, -1, np.dtype(np.int32)).tolist() == [4, -1, 7]


@pytest.mark.parametrize("kept", ['{"cells_per', '{"cells_per_block": 0}', "[]", '{"cells_per_block": null}'])
def test_a_damaged_size_of_blocks_is_measured_anew(tmp_path: Path, kept: str) -> None:
    (tmp_path / "refinement.json").write_text(kept)
    assert cells_of_a_block(tmp_path, lambda: 7) == 7
    assert cells_of_a_block(tmp_path, lambda: 9) == 7
