"""A study from plan to cube: the same bits however it is cut, scheduled, interrupted or extended."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import study.run
import study.task
from models.errors import InputError
from study.check import check
from study.open import open_study
from study.run import Progress, run
from study.schedulers import check_scheduler
from study.seal import seal
from study.state import state
from study.status import FAILED, REST
from tests.study.cubes import assert_identical
from tests.study.plans import small_plan

Size = Callable[[int], None]


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> xr.Dataset:
    """The small study in one block."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(study.run, "cells_per_block", lambda plan, sample, workers: 10**6)
        report = run(small_plan(), results=tmp_path_factory.mktemp("reference"), scheduler="synchronous")
    assert (report.blocks, report.computed, report.failed) == (1, 1, 0)
    return open_study(report.folder)


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[int]]:
    """Cells of every evaluation that a task made."""
    sizes: list[int] = []
    real = study.task.evaluate

    def counting(setting: Any, motions: Any, cells: Any) -> Any:
        sizes.append(len(next(iter(cells.values()))))
        return real(setting, motions, cells)

    monkeypatch.setattr(study.task, "evaluate", counting)
    yield sizes


@pytest.mark.parametrize(
    ("cells", "scheduler", "workers"),
    [
        (1, "threads", 3),
        (5, "threads", 2),
        (24, "synchronous", None),
        (24, "threads", 1),
        (100, "synchronous", None),
        (100, "threads", 3),
    ],
)
def test_blocks_and_schedulers_leave_no_trace(
    reference: xr.Dataset, tmp_path: Path, block_size: Size, cells: int, scheduler: str, workers: int | None
) -> None:
    block_size(cells)
    report = run(small_plan(), results=tmp_path, scheduler=scheduler, workers=workers)
    assert report.computed == report.blocks >= 168 / cells
    assert_identical(open_study(report.folder), reference)


def test_a_finished_study_computes_nothing_again(tmp_path: Path, block_size: Size, counted: list[int]) -> None:
    block_size(50)
    first = run(small_plan(), results=tmp_path)
    before = open_study(first.folder)
    block_size(7)  # the partition is the manifest's, whatever the size would be now
    again = run(small_plan(), results=tmp_path)
    assert sum(counted) == 168
    assert (again.computed, again.reused, again.blocks) == (0, first.blocks, first.blocks)
    after = open_study(first.folder)
    assert_identical(after, before)
    assert len(after.attrs["history"].splitlines()) == 2


def test_missing_blocks_are_all_that_is_computed(
    reference: xr.Dataset, tmp_path: Path, block_size: Size, counted: list[int]
) -> None:
    block_size(24)
    report = run(small_plan(), results=tmp_path, scheduler="synchronous")
    lost = sorted((report.folder / "blocks").glob("*.nc"))[::2]
    for path in lost:
        path.unlink()
    counted.clear()
    again = run(small_plan(), results=tmp_path, scheduler="synchronous")
    assert again.computed == len(lost) == len(counted)
    assert_identical(open_study(report.folder), reference)


@pytest.mark.parametrize(
    "longer",
    [
        {"pga": "linspace = [0.1, 1.0, 10], unit = 'g'"},
        {"pga": "linspace = [0.1, 0.8, 15], unit = 'g'"},
        {"aspect": "linspace = [0.05, 0.45, 9]"},
        {"aspect": "linspace = [0.05, 0.45, 9]", "pga": "linspace = [0.05, 0.85, 17], unit = 'g'"},
    ],
)
def test_an_extended_axis_reuses_its_blocks(
    tmp_path: Path, block_size: Size, counted: list[int], longer: dict[str, str]
) -> None:
    """Values added at the ends or in between: only new cells are computed, and the cube is that of a fresh run."""
    block_size(20)
    first = run(small_plan(), results=tmp_path / "grown")
    counted.clear()
    plan = small_plan(**longer)
    grown = run(plan, results=tmp_path / "grown")
    assert sum(counted) == plan.grid.size - 168
    assert grown.reused == first.blocks
    fresh = run(plan, results=tmp_path / "fresh")
    assert_identical(open_study(grown.folder), open_study(fresh.folder))


def test_a_changed_plan_stops_with_the_list_of_differences(tmp_path: Path, block_size: Size) -> None:
    block_size(100)
    report = run(small_plan(), results=tmp_path)
    assert report.suspicions == () and "warning" not in str(report)
    files = {path: path.read_bytes() for path in report.folder.rglob("*") if path.is_file()}
    changed = small_plan(mass="900 kg", tail="3 s", pga="linspace = [0.2, 0.8, 7], unit = 'g'")
    with pytest.raises(InputError) as caught:
        run(changed, results=tmp_path)
    for part in ("mass: 800.0 before, 900.0 now", "tail: 2 s before, 3 s now", "axis pga lost"):
        assert part in str(caught.value)
    assert files == {path: path.read_bytes() for path in report.folder.rglob("*") if path.is_file()}


def test_a_failing_block_is_a_file_and_the_rest_goes_on(
    reference: xr.Dataset, tmp_path: Path, block_size: Size, monkeypatch: pytest.MonkeyPatch
) -> None:
    block_size(24)
    real = study.task.evaluate

    def failing(setting: Any, motions: Any, cells: Any) -> Any:
        if 0.1 in cells["aspect_ratio"]:
            raise FloatingPointError("no such wall")
        return real(setting, motions, cells)

    monkeypatch.setattr(study.task, "evaluate", failing)
    report = run(small_plan(), results=tmp_path)
    assert report.failed == 1 and report.computed == report.blocks - 1
    (text,) = (report.folder / "failed").glob("*.txt")
    assert "FloatingPointError: no such wall" in text.read_text()
    cube = open_study(report.folder)
    assert np.all(cube["status"].sel(aspect_ratio=0.1) == FAILED)
    assert bool(cube["peak_rotation"].sel(aspect_ratio=0.1).isnull().all())
    rest = {"aspect_ratio": slice(1, None)}
    assert_identical(cube.isel(rest), reference.isel(rest))
    assert "no such wall" in str(state(report.folder))

    monkeypatch.setattr(study.task, "evaluate", real)
    again = run(small_plan(), results=tmp_path)
    assert (again.computed, again.failed) == (1, 0)
    assert not list((report.folder / "failed").iterdir())
    assert_identical(open_study(report.folder), reference)


def test_a_failing_lane_is_a_flag(tmp_path: Path, block_size: Size, monkeypatch: pytest.MonkeyPatch) -> None:
    block_size(100)
    real = study.task.evaluate

    def flagged(setting: Any, motions: Any, cells: Any) -> Any:
        outputs = real(setting, motions, cells)
        outputs["status"][0] = FAILED
        return outputs

    monkeypatch.setattr(study.task, "evaluate", flagged)
    report = run(small_plan(), results=tmp_path, scheduler="synchronous")
    assert report.failed == 0
    assert int((open_study(report.folder)["status"] == FAILED).sum()) == report.blocks


def test_progress_ends_with_everything_done(tmp_path: Path, block_size: Size) -> None:
    block_size(24)
    seen: list[Progress] = []
    run(small_plan(), results=tmp_path, progress=seen.append)
    assert [p.blocks_done for p in seen] == list(range(len(seen)))
    assert seen[-1].cells_done == seen[-1].cells == 168
    assert seen[-1].seconds_left == 0.0 and seen[0].seconds_left is None


def test_a_stopped_run_keeps_its_blocks(reference: xr.Dataset, tmp_path: Path, block_size: Size) -> None:
    block_size(24)

    def stop(progress: Progress) -> None:
        if progress.blocks_done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(small_plan(), results=tmp_path, scheduler="threads", workers=2, progress=stop)
    done = state(tmp_path / "small").blocks_done
    assert 3 <= done < 7
    again = run(small_plan(), results=tmp_path)
    assert again.reused == done
    assert_identical(open_study(again.folder), reference)


def test_two_runs_of_one_study_at_once_are_refused(tmp_path: Path, block_size: Size) -> None:
    block_size(24)

    def second(progress: Progress) -> None:
        with pytest.raises(InputError, match="being run by another process"):
            run(small_plan(), results=tmp_path)

    run(small_plan(), results=tmp_path, scheduler="synchronous", progress=second)


def test_the_check_finds_one_wrong_bit(tmp_path: Path, block_size: Size) -> None:
    import netCDF4

    block_size(100)
    report = run(small_plan(), results=tmp_path)
    with pytest.raises(InputError, match="something else"):
        # a plan without its folder's manifest cannot be confused with another
        (report.folder / "study.toml").write_text(small_plan(mass="900 kg").text)
        check(report.folder)
    (report.folder / "study.toml").write_text(small_plan().text)
    assert not check(report.folder, cells=168).differing
    with netCDF4.Dataset(report.folder / "cube.nc", "a") as dataset:
        old = float(dataset["peak_rotation"][6, 2, 7])
        dataset["peak_rotation"][6, 2, 7] = np.nextafter(old, 10.0)
    seal(report.folder / "cube.nc", "cube.nc")
    found = check(report.folder, cells=168)
    assert len(found.differing) == 1 and "peak_rotation" in found.differing[0]


def test_unknown_schedulers_and_workers_are_one_sentence(tmp_path: Path) -> None:
    for scheduler, workers, words in (
        ("thread", None, "did you mean 'threads'"),
        ("threads", 0, "give 1 or more"),
    ):
        with pytest.raises(InputError, match=words):
            run(small_plan(), results=tmp_path, scheduler=scheduler, workers=workers)
    assert not list(tmp_path.iterdir())


def test_a_study_below_every_threshold_is_at_rest(tmp_path: Path, block_size: Size) -> None:
    block_size(100)
    plan = small_plan(pga="values = [0.001, 0.002], unit = 'g'")
    cube = open_study(run(plan, results=tmp_path).folder)
    assert np.all(cube["status"] == REST) and np.all(cube["peak_rotation"] == 0.0)
    assert bool(cube.rocking.onset_map(x="aspect_ratio", y="top_mass").isnull().all())


def test_what_is_unusual_about_a_plan_stands_in_the_report(tmp_path: Path) -> None:
    plan = small_plan(mass="8 g", aspect="values = [0.2]", pga="values = [0.1], unit = 'g'")
    report = run(plan, results=tmp_path, scheduler="synchronous")
    (said,) = report.suspicions
    assert "mass = 0.008 kg is unusually small" in said and str(report).startswith(f"warning: {said}\n")


def test_odd_arguments_are_one_sentence(tmp_path: Path) -> None:
    check_scheduler("threads", np.int64(2))  # type: ignore[arg-type]
    for workers in (1.5, "2", True, 0):
        with pytest.raises(InputError, match=f"workers is {workers!r}: give 1 or more, a whole number"):
            run(small_plan(), results=tmp_path, workers=workers)  # type: ignore[arg-type]
    for call, said in (
        (lambda: run(5), "plan is of type int: give the name of its file"),  # type: ignore[arg-type]
        (lambda: run(small_plan(), results=5), "results is of type int: give the name of the folder"),  # type: ignore[arg-type]
        (lambda: open_study(1), "study is of type int: give the name of its folder"),  # type: ignore[arg-type]
    ):
        with pytest.raises(InputError, match=said):
            call()
    (tmp_path / "plan.toml").write_text("")
    for place in ("plan.toml", "plan.toml/below"):
        with pytest.raises(InputError, match="is a file, or lies in one: name the folder of all results"):
            run(small_plan(), results=tmp_path / place)
