"""Where blocks run: a pool each for this thread, threads, processes and a dask cluster.

All four give `concurrent.futures` (dask's own for the first and the last), so a study is submitted, awaited and
stopped by the same code on a notebook's machine and on a cluster (`study.cluster`).
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from multiprocessing.connection import wait
from numbers import Integral
from typing import Any, TypeVar

from models.errors import InputError, nearest
from study.workers import Needs

SCHEDULERS = ("synchronous", "threads", "processes")
T = TypeVar("T")
R = TypeVar("R")


def check_scheduler(scheduler: str, workers: int | None) -> None:
    """Raise InputError unless ``scheduler`` is a known word or a cluster's address."""
    if "://" not in scheduler and scheduler not in SCHEDULERS:
        raise InputError(
            f"scheduler '{scheduler}' is not known: {nearest(scheduler, SCHEDULERS)} "
            "(or the address of a dask cluster, tcp://host:port)"
        )
    if workers is not None and (isinstance(workers, bool) or not isinstance(workers, Integral) or workers < 1):
        raise InputError(f"workers is {workers!r}: give 1 or more, a whole number")


def count_workers(scheduler: str, workers: int | None) -> int:
    """How many blocks run at once on this machine."""
    return 1 if scheduler == "synchronous" else int(workers or _cores())


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Pool:
    """Where blocks run: an executor of this machine."""

    def __init__(self, executor: Executor, places: int) -> None:
        self._executor, self._places = executor, places

    def places(self) -> int:
        """How many blocks run at once now."""
        return self._places

    def submit(self, work: Callable[[T], R], given: T) -> Future[R]:
        return self._executor.submit(work, given)

    def lost(self, future: Future[Any]) -> bool:
        """Whether a block came to nothing because workers died that held it, perhaps for other reasons."""
        return False

    def drop(self, futures: Sequence[Future[Any]]) -> Collection[Future[Any]]:
        """Take away the workers that hold these blocks, so that others get them; the blocks that were held."""
        return ()

    def unfit(self, error: Exception) -> Exception | None:
        """What a block's error says of the worker it came from; None: nothing."""
        return None


@contextmanager
def open_pool(scheduler: str, workers: int | None, needs: Needs) -> Iterator[Pool]:
    """The pool of a scheduler, whose workers have what the run needs of them.

    At the end, or when the run is interrupted, blocks not yet begun are dropped, begun ones finish: awaited on this
    machine, left to it on a cluster.
    """
    if "://" in scheduler:
        from study.cluster import open_cluster

        with open_cluster(scheduler, needs) as cluster:
            yield cluster
        return
    n = count_workers(scheduler, workers)
    executor = _local(scheduler, n)
    try:
        yield Pool(executor, n)
    finally:
        executor.shutdown(wait=True, cancel_futures=True)


def _local(scheduler: str, workers: int) -> Executor:
    if scheduler == "threads":
        return ThreadPoolExecutor(workers, thread_name_prefix="block")
    if scheduler == "processes":
        # Spawned, for a fork of a process with threads may hang.
        context = multiprocessing.get_context("spawn")
        return ProcessPoolExecutor(workers, mp_context=context, initializer=start_worker)
    from dask.local import SynchronousExecutor

    return SynchronousExecutor()


def start_worker() -> None:
    """Leave Ctrl-C to the parent, and end with it: a killed parent cannot stop its workers."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent.sentinel,), daemon=True).start()


def _end_with(sentinel: int) -> None:
    wait([sentinel])
    os._exit(1)
