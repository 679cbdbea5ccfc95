"""Numba's files of machine code with a checksum: what is damaged or another's is compiled anew, never executed.

Of several processes that want the same kernel one compiles it, the others wait and load what it has written.
"""

from __future__ import annotations

import fcntl
import hashlib
import logging
import os
import pickle
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from numba.core.caching import IndexDataCacheFile

_LOG = logging.getLogger(__name__)
_SIZE = hashlib.sha256().digest_size


class SealedFiles(IndexDataCacheFile):  # type: ignore[misc]
    """Index and code of one kernel; every pickle is followed by its SHA-256, which pickle itself passes over.

    Code is kept with the kernel and the types that it is for: files that are exchanged, or that two processes
    numbered alike at the same time, are found too.
    """

    def save(self, key: Any, data: Any) -> None:
        try:
            super().save(key, (self._index_name, key, data))
        except OSError as error:
            _LOG.warning("%s: %s; this kernel is compiled again next time", self._cache_path, error.strerror)

    def load(self, key: Any) -> Any:
        found = super().load(key)
        if found is None or found[:2] == (self._index_name, key):
            return None if found is None else found[2]
        _LOG.warning("%s names code of another kernel: compiled anew", self._index_path)
        return None

    def _dump(self, obj: Any) -> bytes:
        data: bytes = super()._dump(obj)
        return data + hashlib.sha256(data).digest()

    def _load_index(self) -> Any:
        path = Path(self._index_path)
        try:
            data = path.read_bytes()
        except OSError:
            return {}
        version = pickle.dumps(self._version, protocol=-1)  # stands first, so that another numba reads no further
        if data.startswith(version) and _intact(data[len(version) :]):
            return super()._load_index()
        _LOG.warning("%s is damaged: compiled anew", path)
        return {}

    def _load_data(self, name: str) -> Any:
        path = Path(self._data_path(name))
        data = path.read_bytes()
        if not _intact(data):
            _LOG.warning("%s is damaged: compiled anew", path)
            raise OSError  # as if the file were gone
        return pickle.loads(data)


def seal_cache(dispatcher: Any) -> None:
    """Let a compiled function that keeps its machine code keep it in sealed files."""
    cache = dispatcher._cache
    stamp = cache._impl.locator.get_source_stamp()
    cache._cache_file = SealedFiles(cache._cache_path, cache._impl.filename_base, stamp)


@contextmanager
def _locked(path: Path) -> Iterator[None]:
    """Alone with ``path`` among all processes; not alone where no file can be made there."""
    try:
        lock = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o600)
    except OSError:
        yield
        return
    try:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield
    finally:
        os.close(lock)


def compile_once(dispatcher: Any) -> None:
    """Let a process that wants a kernel wait for another that compiles it at this moment."""
    compile_here = dispatcher.compile

    def compile_or_wait(signature: Any) -> Any:
        wanted = hashlib.sha256(str(signature).encode()).hexdigest()[:16]
        with _locked(Path(dispatcher._cache._cache_path) / f"{wanted}.lock"):
            return compile_here(signature)

    dispatcher.compile = compile_or_wait


def _intact(data: bytes) -> bool:
    return len(data) > _SIZE and hashlib.sha256(data[:-_SIZE]).digest() == data[-_SIZE:]
