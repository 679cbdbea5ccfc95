"""Signals at random moments: the driver, process workers, dask workers and the scheduler; an axis being extended."""

from __future__ import annotations

import random
import shutil
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from itertools import product
from pathlib import Path

import psutil

from benchmarks.faults.commands import Cluster, Command, cluster, run
from benchmarks.faults.row import Row
from benchmarks.faults.studies import MODELS, NAME, compare_blocks, compare_cubes, digests, plan_text
from study.store import BlockStore

SCHEDULERS = ("synchronous", "threads", "processes", "cluster")
SIZE = 5
"""Points of the second axis."""
Strike = Callable[[Command, random.Random], None]


def write_plan(work: Path, model: str, size: int, more: int = 0) -> Path:
    path = work / f"{model}_{size}_{more}.toml"
    path.write_text(plan_text(model, size, more=more))
    return path


def undisturbed(plan: Path, work: Path) -> Path:
    """The folder of the study, run once without any fault."""
    results = work / f"undisturbed_{plan.stem}"
    if not (results / NAME / "cube.nc").exists():
        code, said = run("run", plan, "--results", results, "--scheduler", "threads")
        if code:
            raise RuntimeError(f"the undisturbed run fails: {said}")
    return results / NAME


def kill_command(command: Command, draw: random.Random) -> None:
    """The driver alone, or with all its worker processes."""
    command.signal(signal.SIGKILL, group=draw.random() < 0.5)


def kill_process_worker(command: Command, draw: random.Random) -> None:
    """One of the processes that compute blocks."""
    workers = [
        child for child in psutil.Process(command.process.pid).children() if "spawn_main" in " ".join(child.cmdline())
    ]
    if workers:
        draw.choice(workers).kill()
        command.process.join(60)


def interrupt(command: Command, draw: random.Random) -> None:
    """Ctrl-C of a terminal goes to all."""
    command.signal(signal.SIGINT, group=True)
    command.process.join(60)


def terminate(command: Command, draw: random.Random) -> None:
    command.signal(signal.SIGTERM)
    command.process.join(60)


def stop_and_continue(command: Command, draw: random.Random) -> None:
    """Stopped for a moment, as by Ctrl-Z, then killed or left to go on."""
    command.signal(signal.SIGSTOP, group=True)
    time.sleep(draw.uniform(0.0, 0.3))
    command.signal(signal.SIGCONT, group=True)
    if draw.random() < 0.5:
        command.signal(signal.SIGKILL, group=True)
    command.process.join(60)


def count(folder: Path) -> int:
    return len(BlockStore(folder).finished())


def strike_at_random(
    plan: Path, reference: Path, results: Path, words: tuple[str, ...], strike: Strike, n: int, draw: random.Random,
    row: Row, extended: Path | None = None,
) -> None:  # fmt: skip
    """Run the study again and again and strike each run once, until ``n`` strikes hit; then finish and compare.

    ``extended``: the plan to go on with once a run of ``plan`` has come to its end.
    """
    folder = results / NAME
    hits = 0
    while hits < n:
        shutil.rmtree(folder, ignore_errors=True)
        now, known = plan, dict[str, str]()
        if extended is not None:
            row.finished(*run("run", plan, "--results", results, *words))
            now, known = extended, digests(folder, row)
        while hits < n:
            command = Command("run", now, "--results", results, *words)
            # the timed sample takes a while: wait for some new blocks, then strike
            wanted = count(folder) + draw.randint(0, 3)
            while command.running and count(folder) < wanted:
                time.sleep(0.001)
            time.sleep(draw.uniform(0.0, 0.15))
            alive = command.running
            if alive:
                strike(command, draw)
            code, said = command.end()
            row.heard(code, said)
            found = digests(folder, row)
            compare_blocks(known, found, row)
            known = found
            hits += alive
            if not alive or code == 0:
                break
        row.finished(*run("run", now, "--results", results, *words))
        compare_blocks(known, digests(folder, row), row)
        compare_cubes(reference, folder, row)
    row.injections += hits


@contextmanager
def scheduler_words(scheduler: str) -> Iterator[tuple[tuple[str, ...], Cluster | None]]:
    if scheduler == "cluster":
        with cluster() as found:
            yield ("--scheduler", found.address), found
    else:
        yield ("--scheduler", scheduler, *(("--workers", "2") if scheduler != "synchronous" else ())), None


def struck(
    work: Path, n: int, draw: random.Random, row: Row, *, model: str, scheduler: str, strike: Strike, size: int = SIZE
) -> None:
    """One model on one scheduler, one kind of strike."""
    plan = write_plan(work, model, size)
    with scheduler_words(scheduler) as (words, _):
        strike_at_random(plan, undisturbed(plan, work), work / "struck", words, strike, n, draw, row)


def extending(work: Path, n: int, draw: random.Random, row: Row, size: int = SIZE) -> None:
    """Killed while the values that a plan adds to an axis are being computed."""
    plan, longer = (write_plan(work, "housner", size, more) for more in (0, 12))
    words = ("--scheduler", "threads", "--workers", "2")
    strike_at_random(
        plan, undisturbed(longer, work), work / "extended", words, kill_command, n, draw, row, extended=longer
    )


def dask_workers(work: Path, n: int, draw: random.Random, row: Row, size: int = SIZE) -> None:
    """Workers of a cluster killed under a run that goes on: the others take their blocks."""
    plan = write_plan(work, "housner", size)
    reference, results = undisturbed(plan, work), work / "dask"
    with cluster() as found:
        while row.injections < n:
            shutil.rmtree(results, ignore_errors=True)
            command = Command("run", plan, "--results", results, "--scheduler", found.address)
            while command.running and row.injections < n:
                wanted = count(results / NAME) + draw.randint(1, 3)
                while command.running and count(results / NAME) < wanted:
                    time.sleep(0.002)
                if command.running:
                    found.kill_worker(draw.randrange(2))
                    row.injections += 1
            code, said = command.end()
            row.heard(code, said)
            known = digests(results / NAME, row)
            row.finished(*run("run", plan, "--results", results, "--scheduler", found.address))
            compare_blocks(known, digests(results / NAME, row), row)
            compare_cubes(reference, results / NAME, row)


def dask_scheduler(work: Path, n: int, draw: random.Random, row: Row, size: int = SIZE) -> None:
    """The scheduler killed under a run: a sentence, finished blocks kept, and the next run goes on elsewhere."""
    plan = write_plan(work, "housner", size)
    reference, results = undisturbed(plan, work), work / "dask_scheduler"
    for _ in range(n):
        shutil.rmtree(results, ignore_errors=True)
        with cluster() as found:
            command = Command("run", plan, "--results", results, "--scheduler", found.address)
            wanted = draw.randint(0, 4)
            while command.running and count(results / NAME) < wanted:
                time.sleep(0.002)
            found.scheduler.kill()
            row.heard(*command.end())
        row.injections += 1
        known = digests(results / NAME, row)
        row.finished(*run("run", plan, "--results", results))
        compare_blocks(known, digests(results / NAME, row), row)
        compare_cubes(reference, results / NAME, row)


KINDS = {
    **{
        f"kill -9, {scheduler}, {model}": (20, partial(struck, model=model, scheduler=scheduler, strike=kill_command))
        for scheduler, model in product(SCHEDULERS, MODELS)
    },
    "kill -9, a process worker": (
        40,
        partial(struck, model="housner", scheduler="processes", strike=kill_process_worker),
    ),
    "kill -9, a dask worker": (40, dask_workers),
    "kill -9, the dask scheduler": (10, dask_scheduler),
    "kill -9 while an axis is extended": (30, extending),
    "Ctrl-C": (20, partial(struck, model="housner", scheduler="threads", strike=interrupt)),
    "Ctrl-C, processes": (20, partial(struck, model="housner", scheduler="processes", strike=interrupt)),
    "SIGTERM": (20, partial(struck, model="housner", scheduler="threads", strike=terminate)),
    "SIGSTOP and on": (20, partial(struck, model="housner", scheduler="threads", strike=stop_and_continue)),
}
"""Injections of a whole run, and what makes them."""
