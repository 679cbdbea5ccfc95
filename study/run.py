"""Run a study: start it, or continue where it stopped.

One task a block, the tasks in flight a few more than the workers. A run that is killed leaves only
whole blocks; the next run computes the others and writes the cube.
"""

from __future__ import annotations

import fcntl
import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, CancelledError
from contextlib import contextmanager
from dataclasses import dataclass
from os.path import isfile, realpath
from pathlib import Path

from grids.changes import describe
from grids.files import path_of
from grids.grid import Rectangle
from grids.netcdf_file import check_name
from grids.plan import Plan, read_plan
from grids.plausibility import suspicions_of_plan
from models.errors import InputError
from study.capacity import check_axes, check_capacity
from study.computing import compute
from study.cube import write_cube
from study.keys import Setting
from study.manifest import Manifest
from study.provenance import now
from study.recovery import blocks_on_disk, damaged_blocks, sound_manifest
from study.refined import Refined, cells_of_a_block, refine
from study.schedulers import check_scheduler, count_workers, open_pool
from study.store import BlockStore, write_text
from study.tally import tally, tally_line
from study.task import Outcome, Task, make_task
from study.timing import cells_per_block, time_sample
from study.workers import MARK, Needs


@dataclass(frozen=True)
class Progress:
    """How far a run is; ``reused`` of the ``cells`` done were finished before it began."""

    cells: int
    cells_done: int
    cells_reused: int
    blocks: int
    blocks_done: int
    failures: int
    seconds: float

    @property
    def rate(self) -> float:
        """Cells per second of this run."""
        return (self.cells_done - self.cells_reused) / self.seconds if self.seconds > 0.0 else 0.0

    @property
    def seconds_left(self) -> float | None:
        """Time left at this rate; None before the first block."""
        return (self.cells - self.cells_done) / self.rate if self.rate > 0.0 else None


@dataclass(frozen=True)
class Report:
    """What a run did. ``cube`` is the file; ``failed`` counts blocks whose cells are flagged; ``tally`` all cells
    by what became of them; ``repaired`` says what in the folder was damaged and made anew; ``refined`` what was
    inferred, of a plan with [refine]; ``suspicions`` which values of the plan are unusual (`grids.plausibility`)."""

    folder: Path
    cube: Path
    cells: int
    blocks: int
    computed: int
    reused: int
    failed: int
    seconds: float
    compute_seconds: float
    store_seconds: float
    tally: Mapping[str, int]
    repaired: tuple[str, ...] = ()
    refined: Refined | None = None
    suspicions: tuple[str, ...] = ()

    def __str__(self) -> str:
        text = (
            f"{self.cube}: {self.cells} cells in {self.blocks} blocks "
            f"({self.computed} computed, {self.reused} reused) in {self.seconds:.1f} s"
        )
        text += f"; {self.failed} blocks failed, see {self.folder / 'failed'}" if self.failed else ""
        lines = [f"warning: {said}" for said in self.suspicions]
        lines += [*self.repaired, text, tally_line(self.tally)]
        return "\n".join(lines if self.refined is None else [*lines, str(self.refined)])


def run(
    plan: Plan | str | Path,
    *,
    results: str | Path = "results",
    scheduler: str = "threads",
    workers: int | None = None,
    progress: Callable[[Progress], None] | None = None,
) -> Report:
    """Run a plan, or continue it, in ``results/<name>`` and write its cube there.

    ``scheduler``: "synchronous", "threads", "processes" or the address of a dask cluster
    ("tcp://host:port", whose workers must see the same folder); ``workers`` for threads and processes,
    default one a core. ``progress`` is called after every block. A failed block is noted in
    ``failed`` and its cells are flagged; the rest goes on.

    Raises InputError for a plan that differs from the folder's in more than added axis values.
    """
    check_scheduler(scheduler, workers)
    plan_folder = "" if isinstance(plan, Plan) else str(Path(realpath(path_of(plan, "plan"))).parent)
    plan = plan if isinstance(plan, Plan) else read_plan(plan)
    # realpath: resolve raises RuntimeError for a link to itself
    folder = Path(realpath(path_of(results, "results", "give the name of the folder of all results"))) / plan.name
    check_name(folder)
    if any(isfile(above) for above in folder.parents):
        raise InputError(f"results {results} is a file, or lies in one: name the folder of all results")
    check_axes(plan)
    setting = Setting.of(plan)
    with _alone(folder):
        started, clock = now(), time.perf_counter()
        store = BlockStore(folder)
        store.sweep()
        repaired: list[str] = []
        refined = None
        if plan.refine is None:
            manifest = _manifest(plan, setting, store, plan_folder, count_workers(scheduler, workers), repaired)
            damaged = damaged_blocks(manifest, store)
            if damaged:
                repaired.append(f"blocks not as they had been written, computed anew: {len(damaged)}")
            finished = store.finished().difference(damaged)
            missing = {key: block for key, block in manifest.blocks.items() if key not in finished}
            counter = _Counter(manifest.blocks, missing, progress)
            if missing:
                needs = Needs.of_run(folder)
                tasks = (make_task(plan, setting, needs, key, block) for key, block in missing.items())
                with _losses_named():
                    _compute(tasks, plan, store, needs, (scheduler, workers), counter)
        else:
            manifest = _refined_manifest(plan, setting, folder, plan_folder)
            counter = _Counter({}, {}, progress)
            counter.cells = int(plan.refine.budget * plan.grid.size)
            with _losses_named():
                refined = _refine(plan, setting, store, (scheduler, workers), counter)
        cube = write_cube(plan, setting, manifest, store, started=started, scheduler=scheduler, refined=refined)
    return Report(
        folder=folder,
        cube=cube,
        cells=plan.grid.size,
        blocks=counter.blocks,
        computed=counter.computed,
        reused=counter.blocks - counter.computed - counter.failures,
        failed=counter.failures,
        seconds=time.perf_counter() - clock,
        compute_seconds=counter.compute_seconds,
        store_seconds=counter.store_seconds,
        tally=tally(cube),
        repaired=tuple(repaired),
        refined=refined,
        suspicions=suspicions_of_plan(plan),
    )


def _manifest(
    plan: Plan, setting: Setting, store: BlockStore, plan_folder: str, workers: int, repaired: list[str]
) -> Manifest:
    """The manifest that covers the plan, saved with the frozen plan before any block is computed."""
    folder = store.folder
    old = sound_manifest(plan, setting, folder)
    if old is not None and plan.grid.size == old.cells:
        _freeze(plan, folder)
        return old
    kept = blocks_on_disk(plan, setting, store) if old is None else {}
    if kept:
        repaired.append(f"manifest.json was lost or damaged and is made anew; finished blocks kept: {len(kept)}")
    try:
        sample = time_sample(plan, setting)
    except InputError:
        raise
    except Exception:
        sample = None  # the blocks will say what fails
    most_cells = cells_per_block(plan, sample, workers)
    if sample is not None:
        check_capacity(plan, folder, sample, most_cells)
    new = Manifest.start(plan, most_cells, plan_folder, kept) if old is None else old.extended(plan, most_cells)
    _freeze(plan, folder)
    new.save(folder)
    return new


def _freeze(plan: Plan, folder: Path) -> None:
    """Keep the plan's text as ``study.toml``, anew where it was lost or is another."""
    path = folder / "study.toml"
    if not path.is_file() or path.read_bytes() != plan.text.encode():
        write_text(path, plan.text)


def _refined_manifest(plan: Plan, setting: Setting, folder: Path, plan_folder: str) -> Manifest:
    """The manifest of a refined study, which lists no blocks: the policy asks for them anew."""
    old = sound_manifest(plan, setting, folder)
    if old is not None and old.blocks:
        raise InputError(f"{folder} holds a study without [refine]: give the plan a new name, or leave [refine] out")
    new = Manifest(describe(plan), {}, plan_folder)
    _freeze(plan, folder)
    new.save(folder)
    return new


def _refine(
    plan: Plan, setting: Setting, store: BlockStore, where: tuple[str, int | None], counter: _Counter
) -> Refined:
    needs = Needs.of_run(store.folder)

    def compute_missing(tasks: list[Task]) -> None:
        missing = [task for task in tasks if not store.is_intact(task.key)]
        counter.expect(tasks, missing)
        if missing:
            _compute(missing, plan, store, needs, where, counter)

    most = cells_of_a_block(
        store.folder, lambda: cells_per_block(plan, time_sample(plan, setting), count_workers(*where))
    )
    return refine(plan, setting, store, needs, most, compute_missing)


class WorkerLost(RuntimeError):
    """A worker process, or the scheduler of a cluster, was killed, by hand or because memory ran out."""


@contextmanager
def _losses_named() -> Iterator[None]:
    """Turn the loss of workers into a sentence."""
    try:
        yield
    except (BrokenExecutor, CancelledError) as error:
        raise WorkerLost(
            f"{str(error).rstrip('.') or 'the work was cancelled'} (killed, or out of memory?); "
            "finished blocks are kept, run again to continue"
        ) from None


class _Counter:
    """Adds up outcomes and reports progress."""

    def __init__(
        self,
        blocks: Mapping[str, Rectangle],
        missing: Mapping[str, Rectangle],
        report: Callable[[Progress], None] | None,
    ) -> None:
        self.cells = sum(block.size for block in blocks.values())
        self.blocks = len(blocks)
        self.reused = self.done = self.cells - sum(block.size for block in missing.values())
        self.blocks_done = len(blocks) - len(missing)
        self.computed = self.failures = 0
        self.compute_seconds = self.store_seconds = 0.0
        self.begun = time.perf_counter()
        self.report = report
        self._show()

    def expect(self, tasks: Sequence[Task], missing: Sequence[Task]) -> None:
        """Further tasks, of which all but the ``missing`` are finished."""
        finished = sum(task.grid.size for task in tasks) - sum(task.grid.size for task in missing)
        self.blocks += len(tasks)
        self.blocks_done += len(tasks) - len(missing)
        self.done += finished
        self.reused += finished
        self._show()

    def add(self, outcome: Outcome) -> None:
        self.done += outcome.cells
        self.blocks_done += 1
        self.computed += outcome.failure is None
        self.failures += outcome.failure is not None
        self.store_seconds += outcome.storing
        self.compute_seconds += outcome.seconds - outcome.storing
        self._show()

    def _show(self) -> None:
        if self.report is not None:
            seconds = time.perf_counter() - self.begun
            self.report(
                Progress(self.cells, self.done, self.reused, self.blocks, self.blocks_done, self.failures, seconds)
            )


def _compute(
    tasks: Iterable[Task], plan: Plan, store: BlockStore, needs: Needs, where: tuple[str, int | None], counter: _Counter
) -> None:
    with open_pool(*where, needs) as pool:
        compute(tasks, pool, store, plan.block_seconds, counter.add)


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Hold the study's lock; the system releases it when the process ends, however it ends."""
    folder.mkdir(parents=True, exist_ok=True)
    # a link in its place is refused: the file that it points to is none of ours
    with os.fdopen(os.open(folder / MARK, os.O_WRONLY | os.O_CREAT | os.O_NOFOLLOW, 0o644), "w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InputError(f"{folder} is being run by another process: wait for it or stop it") from None
        try:
            yield
        finally:
            if set(folder.iterdir()) == {folder / MARK}:  # refused before anything was kept
                (folder / MARK).unlink()
                folder.rmdir()
