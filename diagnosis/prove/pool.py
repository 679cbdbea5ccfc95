"""Processes that answer cases: Ctrl-C ends them at once, and never as a case that is half answered."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from contextlib import contextmanager
from typing import TypeVar

from study.schedulers import start_worker

Case = TypeVar("Case")
Found = TypeVar("Found")


@contextmanager
def processes(jobs: int) -> Iterator[ProcessPoolExecutor]:
    """A pool of ``jobs`` processes that leave Ctrl-C to this one.

    An interrupt ends them with the cases they are at, which may take an hour more; what is written stays.
    """
    others = set(multiprocessing.active_children())
    # Spawned, for a fork of a process with threads may hang.
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, mp_context=context, initializer=start_worker) as pool:
        try:
            yield pool
        except KeyboardInterrupt:
            for worker in set(multiprocessing.active_children()) - others:
                worker.terminate()
            raise


def in_turn(
    submit: Callable[[Case], Future[Found]], cases: Iterable[Case], jobs: int, minutes: float
) -> Iterator[tuple[Case, Future[Found]]]:
    """Yields the cases as they are done, ``jobs`` at a time in their order; none is begun after ``minutes``."""
    end = time.monotonic() + 60.0 * minutes
    waiting, running = list(cases), dict[Future[Found], Case]()
    while waiting or running:
        while waiting and len(running) < jobs and time.monotonic() < end:
            case = waiting.pop(0)
            running[submit(case)] = case
        if not running:
            return
        for done in wait(running, return_when=FIRST_COMPLETED).done:
            yield running.pop(done), done
