"""The one lock around every use of the netCDF library, from open to close.

The library under netCDF4 (HDF5) keeps global state and crashes when threads use it at once, even
on different files and even for reading; xarray's own lock does not cover opening and closing.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType


class NetcdfLock:
    """A re-entrant lock that pickles by name: every process unpickles its own ``NETCDF_LOCK``."""

    def __init__(self) -> None:
        self._lock = threading.RLock()

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        return self._lock.acquire(blocking, timeout)

    def release(self) -> None:
        self._lock.release()

    def __enter__(self) -> NetcdfLock:
        self._lock.acquire()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._lock.release()

    def __reduce__(self) -> str:
        return "NETCDF_LOCK"


NETCDF_LOCK = NetcdfLock()
"""``with NETCDF_LOCK, xarray.open_dataset(path) as data: data.load()``: nothing stays open outside."""
CACHE_BYTES = 1 << 23
"""Memory for chunks of each variable; the library's own 64 MB hold a cube of some million cells twice."""


@contextmanager
def bounded_cache() -> Iterator[None]:
    """Files opened inside, under the lock, keep at most `CACHE_BYTES` of each variable in memory.

    Cells that are written in their order, as blocks are, finish one chunk after the other and need no more.
    """
    import netCDF4

    before = netCDF4.get_chunk_cache()
    netCDF4.set_chunk_cache(CACHE_BYTES)
    try:
        yield
    finally:
        netCDF4.set_chunk_cache(*before)
