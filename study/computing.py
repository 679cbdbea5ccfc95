"""Blocks of a run in flight: given out, awaited, taken back from workers that do not answer."""

from __future__ import annotations

import time
import traceback
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Future, wait
from dataclasses import dataclass, field
from itertools import islice

from study.schedulers import Pool
from study.store import BlockStore
from study.task import Outcome, Task, run_task
from study.workers import UnfitWorker

AHEAD = 2
"""Tasks in flight per worker: one runs, one waits."""
PATIENCE = 20.0
"""How many times the longest block so far a block may take before its worker counts as hung."""
LEAST_PATIENCE = 600.0
"""s that any block may take: a worker that is new compiles first."""
LOOKS = 20
"""How often within that time the blocks in flight are looked at."""


@dataclass
class Flight:
    """A block on its way: how often it was lost with its workers, the monotonic time since which it may be waiting."""

    task: Task
    losses: int = 0
    since: float = field(default_factory=time.monotonic)


def compute(
    tasks: Iterable[Task], pool: Pool, store: BlockStore, block_seconds: float, tell: Callable[[Outcome], None]
) -> None:
    """Run every task and tell its outcome.

    A worker of a cluster that gives no answer for `PATIENCE` times the longest block (``block_seconds`` at the
    least) is taken away and its blocks go to others; a block that is lost twice, so or with workers that die, has
    failed. Raises BrokenExecutor where there is no worker left.
    """
    queue: Iterator[Task] = iter(tasks)
    running: dict[Future[Outcome], Flight] = {}
    longest, places = block_seconds, pool.places()
    while True:
        before, places = places, pool.places()
        if places < before:  # what waited for many workers waits for few
            _begin_anew(running)
        # where all workers have gone one block waits for the next to come
        for task in islice(queue, max(0 if running else 1, AHEAD * places - len(running))):
            running[pool.submit(run_task, task)] = Flight(task)
        if not running:
            return
        limit = max(LEAST_PATIENCE, PATIENCE * longest)
        done, _ = wait(running, timeout=limit / LOOKS, return_when=FIRST_COMPLETED)
        for future in done:
            flight = running.pop(future)
            if pool.lost(future) and not flight.losses:
                running[pool.submit(run_task, flight.task)] = Flight(flight.task, losses=1)
                continue
            outcome = _outcome(future, flight.task, store, pool)
            longest = max(longest, outcome.seconds)
            tell(outcome)
        # before it begins, a block waits for those that were given out with it
        late = [f for f, flight in running.items() if time.monotonic() - flight.since > AHEAD * limit]
        if late:
            for failed in _without_answer(late, running, pool, store, limit):
                tell(failed)
            _begin_anew(running)


def _begin_anew(running: dict[Future[Outcome], Flight]) -> None:
    """Whatever is in flight may have waited from now on only."""
    for flight in running.values():
        flight.since = time.monotonic()


def _without_answer(
    late: Sequence[Future[Outcome]], running: dict[Future[Outcome], Flight], pool: Pool, store: BlockStore, limit: float
) -> Iterator[Outcome]:
    """Take the workers of late blocks away; the outcomes of those that are late for the second time."""
    dropped = pool.drop(late)
    if not dropped and pool.places() == 0:
        raise BrokenExecutor("no worker is left")
    for future in dropped:
        flight = running[future]
        flight.losses += 1
        if flight.losses == 2:
            del running[future]
            future.cancel()
            sentence = f"lost with its workers twice, at last for want of an answer within {limit:.0f} s"
            store.fail(flight.task.key, sentence + "\n")
            yield Outcome(flight.task.key, flight.task.grid.size, 0.0, 0.0, sentence)


def _outcome(future: Future[Outcome], task: Task, store: BlockStore, pool: Pool) -> Outcome:
    """What a future holds; a worker that dies without an answer fails its block only where that is known."""
    try:
        return future.result()
    except (BrokenExecutor, CancelledError, UnfitWorker, OSError):
        raise
    except Exception as error:
        if (unfit := pool.unfit(error)) is not None:
            raise unfit from None
        store.fail(task.key, traceback.format_exc())
        return Outcome(task.key, task.grid.size, 0.0, 0.0, f"{type(error).__name__}: {error}")
