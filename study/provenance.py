"""Where a cube or an answer comes from: versions, commit, host and times, and how they become attributes.

Times and hosts are written here only, so that data variables and coordinates of two runs of one
plan can be compared bit for bit.
"""

from __future__ import annotations

import hashlib
import json
import platform
import socket
import subprocess
from collections.abc import Mapping
from datetime import UTC, datetime
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from grids.arrays import real_number
from grids.writer import WRITER

PACKAGES = (WRITER, "numpy", "scipy", "numba", "xarray", "netCDF4", "dask", "distributed", "SALib")


def attribute(value: Any) -> Any:
    """A value as netCDF takes it: text, a number or a numeric array.

    netCDF refuses None, booleans, mappings and mixed lists: None becomes "", booleans "true" and
    "false", paths and times text, mappings and lists that hold anything but numbers JSON.
    """
    if value is None:
        return ""
    if isinstance(value, bool | np.bool_):
        return "true" if value else "false"
    if isinstance(value, str | int | float | np.number):
        return value
    if isinstance(value, np.ndarray) and value.dtype.kind in "iuf":
        return value
    if isinstance(value, list | tuple) and value and all(real_number(item) is not None for item in value):
        return np.asarray(value)
    if isinstance(value, Mapping | list | tuple | np.ndarray):
        return as_json(value)
    return str(value)


def as_json(value: Any, **options: Any) -> str:
    """JSON of mappings, sequences, numpy values, paths and times, keys in their given order."""
    return json.dumps(value, default=_plain, ensure_ascii=False, **options)


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    return str(value)


def now() -> str:
    """Universal time, ISO 8601 to the second."""
    return datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def sha256(text: str) -> str:
    """Hex digest of a text in UTF-8."""
    return hashlib.sha256(text.encode()).hexdigest()


@cache
def versions() -> dict[str, str]:
    """Versions of Python and of the packages whose code takes part in a run."""
    found = {"python": platform.python_version()}
    for package in PACKAGES:
        try:
            found[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            found[package] = "not installed as a package"
    return found


def source() -> str:
    """The program and its version, with which the attribute `source` of a file begins."""
    return f"{WRITER} {versions()[WRITER]}"


@cache
def commit() -> str:
    """Git commit of the running code, with "+changes" when files differ from it; "" outside git."""
    root = Path(__file__).resolve().parent.parent
    if not (root / ".git").exists():
        return ""

    def git(*words: str) -> str:
        command = ["git", "-C", str(root), *words]
        return subprocess.run(command, capture_output=True, text=True, check=True, timeout=10).stdout.strip()

    try:
        changed = git("status", "--porcelain", "--untracked-files=no")
        return git("rev-parse", "HEAD") + ("+changes" if changed else "")
    except (OSError, subprocess.SubprocessError):
        return ""


def program() -> dict[str, str | None]:
    """What an answer says of the program that gave it: commit (None outside git), when it was made, and versions."""
    return {"commit": commit() or None, "made": now(), **versions()}


def machine() -> dict[str, str]:
    """Host name, processor and operating system."""
    return {"host": socket.gethostname(), "machine": platform.machine(), "system": platform.system()}
