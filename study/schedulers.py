"""Where blocks run: one executor each for this thread, threads, processes and a dask cluster.

All four are `concurrent.futures` executors (dask's own for the first and the last), so a study is
submitted, awaited and stopped by the same code on a notebook's machine and on a cluster.
"""

from __future__ import annotations

import logging
import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor, Executor, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from multiprocessing.connection import wait
from typing import Any

from models.errors import InputError, nearest

SCHEDULERS = ("synchronous", "threads", "processes")
CONNECT_SECONDS = 10


def check_scheduler(scheduler: str, workers: int | None) -> None:
    """Raise InputError unless ``scheduler`` is a known word or a cluster's address."""
    if "://" not in scheduler and scheduler not in SCHEDULERS:
        raise InputError(
            f"scheduler '{scheduler}' is not known: {nearest(scheduler, SCHEDULERS)} "
            "(or the address of a dask cluster, tcp://host:port)"
        )
    if workers is not None and workers < 1:
        raise InputError(f"workers is {workers}: give 1 or more")


def count_workers(scheduler: str, workers: int | None) -> int:
    """How many blocks run at once on this machine."""
    return 1 if scheduler == "synchronous" else workers or _cores()


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def open_executor(scheduler: str, workers: int | None) -> Iterator[tuple[Executor, int]]:
    """The executor of a scheduler and the number of blocks it runs at once.

    At the end, or when the run is interrupted, blocks not yet begun are dropped, begun ones finish.
    """
    if "://" in scheduler:
        with _cluster(scheduler) as (executor, n):
            yield executor, n
        return
    n = count_workers(scheduler, workers)
    executor = _local(scheduler, n)
    try:
        yield executor, n
    finally:
        executor.shutdown(wait=True, cancel_futures=True)


def _local(scheduler: str, workers: int) -> Executor:
    if scheduler == "threads":
        return ThreadPoolExecutor(workers, thread_name_prefix="block")
    if scheduler == "processes":
        # Spawned, for a fork of a process with threads may hang.
        context = multiprocessing.get_context("spawn")
        return ProcessPoolExecutor(workers, mp_context=context, initializer=_start_worker)
    from dask.local import SynchronousExecutor

    return SynchronousExecutor()


def _start_worker() -> None:
    """Leave Ctrl-C to the parent, and end with it: a killed parent cannot stop its workers."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent.sentinel,), daemon=True).start()


def _end_with(sentinel: int) -> None:
    wait([sentinel])
    os._exit(1)


@contextmanager
def _quiet() -> Iterator[None]:
    """Without the tracebacks that dask logs when its scheduler goes: the run says in a sentence what happened."""
    loggers = [logging.getLogger(name) for name in logging.root.manager.loggerDict if name.startswith("distributed")]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.setLevel(level)


@contextmanager
def _cluster(address: str) -> Iterator[tuple[Executor, int]]:
    from distributed import Client

    try:
        client: Any = Client(address, timeout=CONNECT_SECONDS, set_as_default=False)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as error:
        raise InputError(
            f"no dask cluster answers at '{address}' ({type(error).__name__}): start it, or correct the address"
        ) from None
    with _quiet(), client:
        threads = sum(client.nthreads().values())
        if not threads:
            raise InputError(f"the dask cluster at '{address}' has no workers: start some with 'dask worker'")
        # retries stay 0: a block that fails is noted and tried by the next run
        executor = client.get_executor(pure=False)
        try:
            yield executor, threads
        except Exception:
            if client.status != "running":
                raise BrokenExecutor(f"the dask scheduler at {address} is gone") from None
            raise
        finally:
            executor.shutdown(wait=True)
