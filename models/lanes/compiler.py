"""Numba with the settings of every lane kernel, and a cache that cannot go stale."""

from __future__ import annotations

import ast
import hashlib
import os
import stat
import tempfile
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import TypeVar, cast

import numba
from numba.extending import overload, register_jitable

from models.lanes import elementary
from models.lanes.pieces import PieceCompiler
from models.lanes.sealed_cache import compile_once, seal_cache

F = TypeVar("F", bound=Callable[..., object])
_ROOT = Path(__file__).resolve().parent.parent.parent


def sources(module: str, root: Path = _ROOT) -> list[Path]:
    """The files of `models` that ``module`` is made of: its own and, on and on, those it imports from."""
    found: dict[str, Path] = {}
    waiting = [module]
    while waiting:
        name = waiting.pop()
        path = root.joinpath(*name.split("."))
        path = path / "__init__.py" if path.is_dir() and name != "models" else path.with_suffix(".py")
        if name in found or not path.is_file():
            continue
        found[name] = path
        waiting += _imports(path.read_bytes())
    return [found[name] for name in sorted(found)]


@cache
def _imports(source: bytes) -> tuple[str, ...]:
    """What a source may import of `models`."""
    found: list[str] = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "models":
            # a name may be a module of its own
            found += [f"{node.module}", *(f"{node.module}.{alias.name}" for alias in node.names)]
        elif isinstance(node, ast.Import):
            found += [alias.name for alias in node.names if alias.name.startswith("models.")]
    return tuple(found)


def source_hash(module: str, root: Path = _ROOT) -> str:
    """Of every source that a kernel in ``module`` is compiled from, of the compiler and of how much it optimises."""
    digest = hashlib.sha256(f"{numba.__version__} {int(numba.config.OPT)}".encode())
    for path in sources(module, root):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _is_private(folder: Path) -> bool:
    """Whether ``folder``, made if it is missing, is a directory that only this user can write; made mode 0700.

    What lies in it is executed: a link, a folder of another user or one that others can write is refused.
    """
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        status = folder.lstat()
        if not stat.S_ISDIR(status.st_mode) or status.st_uid != os.getuid() or status.st_mode & 0o022:
            return False
        folder.chmod(0o700)
    except OSError:
        return False
    return os.access(folder, os.W_OK)


def cache_folder(module: str) -> Path:
    """The folder for the machine code of a kernel in ``module``, one for each state of its sources.

    Numba itself looks only at the file of the outermost function. The user's cache, else a folder of the user's
    under the temporary one, else a fresh one that the next process does not find.
    """
    bases = [Path(tempfile.gettempdir()) / f"rocking-study-{os.getuid()}"]
    with suppress(RuntimeError):  # no HOME, and a user that the system does not know
        bases.insert(0, Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "rocking-study")
    model = module.split(".")[1]
    for base in bases:
        folder = base / f"{model}-{source_hash(module)}"
        if _is_private(base) and _is_private(folder):
            return folder
    return Path(tempfile.mkdtemp(prefix="rocking-study-"))


# Only contraction to multiply-add is allowed: reordering would make results depend on the vector width.
_SETTINGS = {"nogil": True, "fastmath": {"contract"}, "error_model": "numpy", "cache": True}


def compiled(function: F) -> F:
    """Compile an outermost kernel; the machine code is kept between processes."""
    given = numba.config.CACHE_DIR
    if not os.environ.get("NUMBA_CACHE_DIR"):
        numba.config.CACHE_DIR = str(cache_folder(function.__module__))
    try:
        dispatcher = numba.njit(**_SETTINGS)(function)
        seal_cache(dispatcher)
        compile_once(dispatcher)
        return cast(F, dispatcher)
    finally:
        numba.config.CACHE_DIR = given


def inlined(function: F) -> F:
    """Compile a piece that is always inlined into the kernel that calls it."""
    return cast(
        F, numba.njit(**{**_SETTINGS, "cache": False}, forceinline=True, pipeline_class=PieceCompiler)(function)
    )


def called(function: F) -> F:
    """Compile a piece that is called on rare events."""
    return cast(F, numba.njit(**{**_SETTINGS, "cache": False}, pipeline_class=PieceCompiler)(function))


def in_kernels(function: F, choose: Callable[..., object]) -> F:
    """Let compiled code that calls ``function`` inline what ``choose`` returns for the types of its arguments."""
    choose.__annotations__.clear()  # numba compares them with those of what is returned
    overload(function, jit_options={**_SETTINGS, "cache": False, "forceinline": True})(choose)
    return function


for _piece in (elementary.sine_cosine, elementary.exponential_decay):
    register_jitable(**{**_SETTINGS, "cache": False}, forceinline=True)(_piece)
