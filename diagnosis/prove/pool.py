"""Processes that answer cases: Ctrl-C ends them at once, and never as a case that is half answered."""

from __future__ import annotations

import multiprocessing
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager

from study.schedulers import start_worker


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
