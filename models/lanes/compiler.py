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
BUILT_ON = {"interface_linear": ("interface",)}
"""Models whose kernels take names from another model's."""


def _source_hash(model: str) -> str:
    """Of everything a kernel of this model can be made of: the model, the shared pieces, the compiler."""
    digest = hashlib.sha256(numba.__version__.encode())
    folders = {model, "lanes", *BUILT_ON.get(model, ())}
    for path in sorted(p for folder in folders for p in (_MODELS / folder).rglob("*.py")):
        digest.update(path.relative_to(_MODELS).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _cache_folder(model: str) -> str:
    """A folder per state of the sources: numba looks only at the file of the outermost function."""
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "rocking-study"
    folder = base / f"{model}-{_source_hash(model)}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not os.access(folder, os.W_OK):
            raise PermissionError(folder)
    except OSError:
        folder = Path(tempfile.gettempdir()) / f"rocking-study-{os.getuid()}" / folder.name
        folder.mkdir(parents=True, exist_ok=True)
    return str(folder)


# Only contraction to multiply-add is allowed: reordering would make results depend on the vector width.
_SETTINGS = {"nogil": True, "fastmath": {"contract"}, "error_model": "numpy", "cache": True}


def compiled(function: F) -> F:
    """Compile an outermost kernel; the machine code is kept between processes."""
    given = numba.config.CACHE_DIR
    if not os.environ.get("NUMBA_CACHE_DIR"):
        numba.config.CACHE_DIR = _cache_folder(function.__module__.split(".")[1])
    try:
        return cast(F, numba.njit(**_SETTINGS)(function))
    finally:
        numba.config.CACHE_DIR = given


def inlined(function: F) -> F:
    """Compile a piece that is always inlined into the kernel that calls it."""
    return cast(F, numba.njit(**{**_SETTINGS, "cache": False}, forceinline=True)(function))


def called(function: F) -> F:
    """Compile a piece that is called on rare events."""
    return cast(F, numba.njit(**{**_SETTINGS, "cache": False})(function))
