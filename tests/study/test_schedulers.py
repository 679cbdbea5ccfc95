"""Processes and a dask cluster, and kills: the runs are processes of their own, as a user starts them."""

from __future__ import annotations

import json
import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import netCDF4
import pytest
import xarray as xr
from dask.local import SynchronousExecutor

import models
from benchmarks.faults import kills
from benchmarks.faults.commands import Cluster, Command
from benchmarks.faults.commands import cluster as dask_cluster
from benchmarks.faults.commands import run as command
from benchmarks.faults.row import Row
from benchmarks.faults.studies import MODELS, NAME, compare_cubes, plan_text
from grids.plan import parse_plan
from models.errors import InputError
from study.cluster import ClusterPool
from study.computing import compute
from study.keys import Setting
from study.manifest import Manifest
from study.open import open_study
from study.run import Progress, WorkerLost, run
from study.schedulers import Pool
from study.seal import seal
from study.store import BlockStore
from study.task import Outcome, Task, make_task
from study.workers import MARK, Needs, UnfitWorker
from tests.study.cubes import assert_identical
from tests.study.plans import small_plan


class Silent(Pool):
    """Answers at once, but never for one block."""

    def __init__(self, key: str) -> None:
        super().__init__(SynchronousExecutor(), 1)
        self.key, self.dropped = key, 0

    def submit(self, work: Callable[[Any], Any], given: Any) -> Future[Any]:
        return Future() if given.key == self.key else super().submit(work, given)

    def drop(self, futures: Sequence[Future[Any]]) -> Sequence[Future[Any]]:
        self.dropped += len(futures)
        return futures


class Crowded(Pool):
    """One of two workers hangs with several blocks; all of them go to the other once it is taken away."""

    def __init__(self, keys: Collection[str]) -> None:
        super().__init__(SynchronousExecutor(), 2)
        self.keys, self.drops = set(keys), 0
        self.held: dict[Future[Any], tuple[Callable[[Any], Any], Any]] = {}

    def submit(self, work: Callable[[Any], Any], given: Any) -> Future[Any]:
        if given.key not in self.keys:
            return super().submit(work, given)
        future: Future[Any] = Future()
        self.held[future] = work, given
        return future

    def drop(self, futures: Sequence[Future[Any]]) -> Sequence[Future[Any]]:
        self.drops += 1
        for future in futures:
            work, given = self.held.pop(future)
            future.set_result(work(given))
        return futures


class Deadly(Pool):
    """Its workers die of one block, some times."""

    def __init__(self, key: str, deaths: int) -> None:
        super().__init__(SynchronousExecutor(), 1)
        self.key, self.deaths = key, deaths

    def submit(self, work: Callable[[Any], Any], given: Any) -> Future[Any]:
        if given.key != self.key or not self.deaths:
            return super().submit(work, given)
        self.deaths -= 1
        future: Future[Any] = Future()
        future.set_exception(MemoryError("killed"))
        return future

    def lost(self, future: Future[Any]) -> bool:
        return isinstance(future.exception(), MemoryError)


class Leaving(Pool):
    """Its workers have gone after a first look, and come back for every block."""

    def __init__(self) -> None:
        super().__init__(SynchronousExecutor(), 1)
        self.looks = 0

    def places(self) -> int:
        self.looks += 1
        return int(self.looks < 2)


class Foreign(Pool):
    """Its workers do not know what they are given."""

    unfit = ClusterPool.unfit  # type: ignore[assignment]

    def submit(self, work: Callable[[Any], Any], given: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_exception(ModuleNotFoundError("No module named 'study'"))
        return future


@pytest.fixture(scope="module", autouse=True)
def one_model() -> Iterator[None]:
    """The processes that are killed begin with the kernel of one model only."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("FAULTS_MODELS", "housner")
        yield


@contextmanager
def of_one_worker() -> Iterator[Cluster]:
    """Starting another takes seconds, and nothing here asks for it but a worker that hangs."""
    with TemporaryDirectory() as folder:
        found = Cluster(Path(folder), workers=1)
        try:
            yield found
        finally:
            found.stop()


@pytest.fixture(scope="module")
def cluster() -> Iterator[Cluster]:
    with of_one_worker() as found:
        yield found


@pytest.fixture(scope="module")
def work(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Holds undisturbed runs, for all tests."""
    return tmp_path_factory.mktemp("work")


@pytest.fixture(scope="module")
def plan(work: Path) -> Path:
    """A study of one or two seconds in many blocks."""
    return kills.write_plan(work, "housner", 3)


@pytest.fixture(scope="module")
def undisturbed(plan: Path, work: Path) -> Path:
    return kills.undisturbed(plan, work)


def test_a_cluster_leaves_no_trace(cluster: Cluster, tmp_path: Path) -> None:
    """A client in this process: no warning about anything left open."""
    here = open_study(run(small_plan(), results=tmp_path / "here").folder)
    there = run(small_plan(block_seconds=0.005), results=tmp_path / "there", scheduler=cluster.address)
    assert there.computed == there.blocks > 1
    assert_identical(open_study(there.folder), here)


def test_every_model_is_killed() -> None:
    assert set(MODELS) == set(models.MODELS)


@pytest.mark.parametrize("scheduler", ["threads", "processes", "cluster"])
def test_killed_runs_lose_no_finished_block(
    scheduler: str, plan: Path, undisturbed: Path, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    """One kill a scheduler here; hundreds with ``make faults``."""
    address = request.getfixturevalue("cluster").address if scheduler == "cluster" else scheduler
    row, words = Row(scheduler), ("--scheduler", address)
    draw = random.Random(scheduler)
    kills.strike_at_random(plan, undisturbed, tmp_path, words, kills.kill_command, 1, draw, row)
    assert row.injections == 1 and row.clean, row.notes


@pytest.mark.parametrize("model", [name for name in MODELS if name != "housner"])
def test_the_other_models_lose_nothing_either(model: str, tmp_path: Path) -> None:
    """Killed once on threads and finished: the bits of blocks of another size, one after the other."""
    plan, row = kills.write_plan(tmp_path, model, 6), Row("threads")
    whole = run(
        parse_plan(plan_text(model, 6, block_seconds=30.0), tmp_path), results=tmp_path, scheduler="synchronous"
    )
    draw = random.Random(model)
    kills.strike_at_random(plan, whole.folder, tmp_path / "struck", (), kills.kill_command, 1, draw, row)
    assert row.injections == 1 and row.clean, row.notes
    assert whole.blocks < len(list((tmp_path / "struck" / NAME / "blocks").glob("*.nc")))


def test_ctrl_c_stops_cleanly(plan: Path, undisturbed: Path, tmp_path: Path) -> None:
    """Signal 2 to the whole group, as a terminal sends it: exit code 130, then the run continues."""
    words = ("run", plan, "--results", tmp_path, "--scheduler", "processes", "--workers", "2")
    running = Command(*words)
    while running.running and not kills.count(tmp_path / NAME):
        time.sleep(0.01)
    running.signal(signal.SIGINT, group=True)
    code, said = running.end()
    assert code == 130, said
    assert "Traceback" not in said and "finished blocks are kept" in said
    assert not list((tmp_path / NAME / "blocks").glob(".*.tmp"))
    row = Row("Ctrl-C")
    row.finished(*command(*words))
    compare_cubes(undisturbed, tmp_path / NAME, row)
    assert row.clean, row.notes


def test_a_killed_worker_process_is_a_sentence(plan: Path, undisturbed: Path, tmp_path: Path) -> None:
    row, words = Row("worker"), ("--scheduler", "processes", "--workers", "2")
    kills.strike_at_random(plan, undisturbed, tmp_path, words, kills.kill_process_worker, 1, random.Random(2), row)
    assert row.injections == 1 and row.clean, row.notes


def test_a_killed_dask_scheduler_is_a_sentence(plan: Path, work: Path) -> None:
    row = Row("scheduler")
    kills.dask_scheduler(work, 1, random.Random(1), row, size=3)
    assert row.injections == 1 and row.clean, row.notes


def test_workers_with_other_code_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The run stops with a sentence; no block is noted as failed."""
    made = Needs.of_run
    monkeypatch.setattr("study.run.Needs.of_run", lambda folder: replace(made(folder), code="other"))
    with pytest.raises(UnfitWorker, match="another version of this program"):
        run(small_plan(), results=tmp_path)
    assert not list(tmp_path.rglob("blocks/*.nc")) and not list(tmp_path.rglob("failed/*.txt"))


def test_workers_that_do_not_see_the_folder_are_refused(
    cluster: Cluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another machine's folder of the same path: without the mark of this run, even if an old study lies there."""
    made = Needs.of_run
    monkeypatch.setattr("study.run.Needs.of_run", lambda folder: replace(made(folder), mark="0" * 32))
    with pytest.raises(UnfitWorker, match=r"does not see .*small.* choose by --results a folder that all machines"):
        run(small_plan(), results=tmp_path, scheduler=cluster.address)
    assert not list(tmp_path.rglob("blocks/*.nc")) and not list(tmp_path.rglob("failed/*.txt"))


def test_a_worker_that_hangs_costs_only_its_blocks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is stopped in the middle of the study, never to go on: the others take its blocks, none has failed."""
    here = run(small_plan(), results=tmp_path / "here")  # compiles: who does so for longer counts as hung
    monkeypatch.setattr("study.computing.LEAST_PATIENCE", 8.0)
    monkeypatch.setattr("study.computing.PATIENCE", 0.0)
    plan, begun = small_plan(block_seconds=0.005), []

    def stop(progress: Progress) -> None:
        if progress.blocks_done == 1 and not begun:
            begun.append(hanging.workers[0])
            hanging.workers[0].send_signal(signal.SIGSTOP)

    with dask_cluster() as hanging:
        there = run(plan, results=tmp_path / "there", scheduler=hanging.address, progress=stop)
    assert begun and there.failed == 0 and there.computed == there.blocks > 2
    assert_identical(open_study(there.folder), open_study(here.folder))


def test_what_a_hung_worker_held_does_not_take_the_next_one_along(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All late blocks are looked up before a worker is taken away: afterwards one that is well holds them."""
    monkeypatch.setattr("study.computing.LEAST_PATIENCE", 2.0)
    monkeypatch.setattr("study.computing.PATIENCE", 0.0)
    tasks, store = _tasks(tmp_path)
    pool = Crowded([task.key for task in tasks[:2]])
    compute(tasks, pool, store, 0.0, lambda outcome: None)
    assert pool.drops == 1 and not store.failures() and len(store.finished()) == len(tasks)


def test_a_block_without_an_answer_from_two_workers_has_failed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The only workers are stopped one after the other; the run goes on to its end with what others bring."""
    monkeypatch.setattr("study.computing.LEAST_PATIENCE", 0.2)
    monkeypatch.setattr("study.computing.PATIENCE", 0.0)
    tasks, store = _tasks(tmp_path)
    pool, told = Silent(tasks[0].key), []
    compute(tasks, pool, store, 0.0, told.append)
    assert pool.dropped == 2 and [o.key for o in told if o.failure] == [tasks[0].key]
    assert store.failures().keys() == {tasks[0].key}
    assert len(told) == len(tasks) > 1


@pytest.mark.parametrize(("deaths", "failed"), [(1, 0), (2, 1)])
def test_a_block_that_is_lost_with_its_workers_is_given_out_once_more(deaths: int, failed: int, tmp_path: Path) -> None:
    tasks, store = _tasks(tmp_path)
    pool, told = Deadly(tasks[0].key, deaths), []
    compute(tasks, pool, store, 0.0, told.append)
    assert sum(outcome.failure is not None for outcome in told) == failed
    assert len(told) == len(tasks) and pool.deaths == 0
    assert len(store.finished()) == len(tasks) - failed


def _tasks(tmp_path: Path) -> tuple[list[Task], BlockStore]:
    plan = small_plan()
    folder = tmp_path / plan.name
    folder.mkdir()
    (folder / MARK).touch()
    setting, needs = Setting.of(plan), Needs.of_run(folder)
    blocks = Manifest.start(plan, 20, "").blocks
    return [make_task(plan, setting, needs, key, block) for key, block in blocks.items()], BlockStore(folder)


def test_no_block_is_forgotten_while_all_workers_are_away(tmp_path: Path) -> None:
    tasks, store = _tasks(tmp_path)
    told: list[Outcome] = []
    compute(tasks, Leaving(), store, 0.0, told.append)
    assert len(told) == len(tasks) > 2
    assert len(store.finished()) == len(tasks)


def test_a_worker_that_lacks_the_program_ends_the_run_and_fails_no_block(tmp_path: Path) -> None:
    tasks, store = _tasks(tmp_path)
    with pytest.raises(UnfitWorker, match=r"cannot run this program .*No module named 'study'.*install the same"):
        compute(tasks, Foreign(SynchronousExecutor(), 1), store, 0.0, lambda outcome: None)
    assert not store.failures()


def test_without_any_worker_the_run_ends_with_a_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("study.computing.LEAST_PATIENCE", 4.0)
    monkeypatch.setattr("study.computing.PATIENCE", 0.0)

    def stop(progress: Progress) -> None:
        if progress.blocks_done == 1:
            for worker in lost.workers:
                worker.kill()

    with of_one_worker() as lost, pytest.raises(WorkerLost, match=r"no worker is left.*run again to continue"):
        run(small_plan(block_seconds=0.005), results=tmp_path, scheduler=lost.address, progress=stop)


def test_a_silent_address_is_one_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("study.cluster.CONNECT_SECONDS", 1)
    with pytest.raises(InputError, match=r"no dask cluster answers at 'tcp://127\.0\.0\.1:1'"):
        run(small_plan(), results=tmp_path, scheduler="tcp://127.0.0.1:1")


def test_plan_and_cube_are_read_without_numba_matplotlib_or_dask() -> None:
    code = "import sys, json, study.open, study.manifest, study.store; print(json.dumps(sorted(sys.modules)))"
    loaded = json.loads(subprocess.run([sys.executable, "-c", code], capture_output=True, check=True).stdout)
    assert not {"numba", "matplotlib", "distributed"} & set(loaded)


def test_identical_means_identical(undisturbed: Path) -> None:
    """The comparison that the other tests rest on sees one changed bit."""
    one = open_study(undisturbed)
    two: xr.Dataset = one.copy(deep=True)
    two["impacts"].values[0, 0, 0] += 1
    with pytest.raises(AssertionError):
        assert_identical(one, two)


def test_differing_means_counted(undisturbed: Path, tmp_path: Path) -> None:
    row, other = Row("one bit"), Path(shutil.copytree(undisturbed, tmp_path / "other"))
    with netCDF4.Dataset(other / "cube.nc", "a") as cube:
        cube["impacts"][0, 0, 0] = int(cube["impacts"][0, 0, 0]) + 1
    seal(other / "cube.nc", "cube.nc")
    compare_cubes(undisturbed, other, row)
    assert row.wrong_cells == 1
