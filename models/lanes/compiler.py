"""Numba with the settings of every lane kernel, and a cache that cannot go stale."""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar, cast

import numba

F = TypeVar("F", bound=Callable[..., object])
_MODELS = Path(__file__).resolve().parent.parent


def _source_hash() -> str:
    digest = hashlib.sha256(numba.__version__.encode())
    for path in sorted(_MODELS.rglob("*.py")):
        digest.update(path.relative_to(_MODELS).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _cache_folder() -> str:
    """A folder per state of the sources: numba looks only at the file of the outermost function."""
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "rocking-study"
    folder = base / _source_hash()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not os.access(folder, os.W_OK):
            raise PermissionError(folder)
    except OSError:
        folder = Path(tempfile.gettempdir()) / f"rocking-study-{os.getuid()}" / _source_hash()
        folder.mkdir(parents=True, exist_ok=True)
    return str(folder)


if not os.environ.get("NUMBA_CACHE_DIR"):
    numba.config.CACHE_DIR = _cache_folder()

# Only contraction to multiply-add is allowed: reordering would make results depend on the vector width.
_SETTINGS = {"nogil": True, "fastmath": {"contract"}, "error_model": "numpy", "cache": True}


def compiled(function: F) -> F:
    """Compile an outermost kernel; the machine code is kept between processes."""
    return cast(F, numba.njit(**_SETTINGS)(function))


def inlined(function: F) -> F:
    """Compile a piece that is always inlined into the kernel that calls it."""
    return cast(F, numba.njit(**{**_SETTINGS, "cache": False}, forceinline=True)(function))


def called(function: F) -> F:
    """Compile a piece that is called on rare events."""
    return cast(F, numba.njit(**{**_SETTINGS, "cache": False})(function))
