"""The workers of a dask.distributed cluster: looked at before they get blocks, and taken away when they hang."""

from __future__ import annotations

import logging
import uuid
from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Future, wait
from contextlib import contextmanager
from typing import Any
from weakref import WeakKeyDictionary

from models.errors import InputError
from study.schedulers import Pool, R, T
from study.workers import Needs, UnfitWorker

CONNECT_SECONDS = 10
SPOKEN = ("distributed", "tornado", "asyncio")
"""Loggers of dask and of what carries its messages: callbacks that find the scheduler gone end there."""
ANSWER_SECONDS = 10
"""s that idle workers take at most to say what they have."""


class ClusterPool(Pool):
    """The workers behind a dask scheduler; some may come and go."""

    def __init__(self, client: Any) -> None:
        # retries stay 0: a block that fails is noted and tried by the next run
        self._client, self._blocks = client, client.get_executor(pure=False)
        super().__init__(self._blocks, 0)
        self._keys: WeakKeyDictionary[Future[Any], str] = WeakKeyDictionary()

    def places(self) -> int:
        return sum(self._client.nthreads().values())

    def submit(self, work: Callable[[T], R], given: T) -> Future[R]:
        key = f"block-{uuid.uuid4().hex}"
        future: Future[R] = self._blocks.submit(work, given, key=key)
        self._keys[future] = key
        return future

    def check(self, needs: Needs) -> None:
        """Ask every worker at once; one that is busy, and one that comes later, is asked by its first block."""
        asked = {self._blocks.submit(needs.check, workers=[name]): name for name in self._client.nthreads()}
        answered, silent = wait(asked, timeout=ANSWER_SECONDS)
        for future in silent:
            future.cancel()
        for future in answered:
            error = None if future.cancelled() else future.exception()
            if isinstance(error, UnfitWorker):
                raise error
            if error is not None and not self.lost(future):
                raise _cannot_run(f"the worker at {asked[future]}", error)

    def unfit(self, error: Exception) -> UnfitWorker | None:
        # a block's own errors come as its outcome: what it cannot be unpickled for is missing on the worker
        return _cannot_run("a worker", error) if isinstance(error, ImportError | AttributeError) else None

    def lost(self, future: Future[Any]) -> bool:
        from distributed import KilledWorker

        return not future.cancelled() and isinstance(future.exception(), KilledWorker)

    def drop(self, futures: Sequence[Future[Any]]) -> Collection[Future[Any]]:
        # all looked up before any is taken away: what it held goes to a worker that is well
        held = {key: address for address, keys in self._client.processing().items() for key in keys}
        dropped = [future for future in futures if self._keys[future] in held]
        holders = {held[self._keys[future]] for future in dropped}

        async def remove(dask_scheduler: Any = None) -> None:  # not by name: the scheduler may lack this package
            for address in holders:
                await dask_scheduler.remove_worker(address=address, stimulus_id="no-answer")

        self._client.run_on_scheduler(remove)
        return dropped

    def close(self) -> None:
        """Take back what has not begun; what has goes on where it is, and its block is kept."""
        self._blocks.shutdown(wait=False)


def _cannot_run(which: str, error: BaseException) -> UnfitWorker:
    return UnfitWorker(
        f"{which} cannot run this program ({type(error).__name__}: {error}): install the same rocking-study and Python "
        "on every machine of the cluster as here, and start it anew"
    )


@contextmanager
def open_cluster(address: str, needs: Needs) -> Iterator[ClusterPool]:
    """The pool of a cluster, whose workers of now all have what they need.

    Raises InputError where no cluster answers or has workers, UnfitWorker where one of them lacks something.
    """
    from distributed import Client

    try:
        client: Any = Client(address, timeout=CONNECT_SECONDS, set_as_default=False)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as error:
        raise InputError(
            f"no dask cluster answers at '{address}' ({type(error).__name__}): start it, or correct the address"
        ) from None
    with _quiet(), client:
        if not client.nthreads():
            raise InputError(f"the dask cluster at '{address}' has no workers: start some with 'dask worker'")
        pool = ClusterPool(client)
        try:
            pool.check(needs)
            yield pool
        except Exception:
            if client.status != "running":
                raise BrokenExecutor(f"the dask scheduler at {address} is gone") from None
            raise
        finally:
            pool.close()


@contextmanager
def _quiet() -> Iterator[None]:
    """Without the tracebacks that are logged when dask's scheduler goes: the run says in a sentence what happened."""
    known = [name for name in logging.root.manager.loggerDict if name.startswith(SPOKEN)]
    loggers = [logging.getLogger(name) for name in (*known, *SPOKEN)]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.setLevel(level)
