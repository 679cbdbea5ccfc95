"""Which code computes: a fingerprint that the workers of a cluster are held against."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

from study.provenance import versions

ROOMS = ("models", "grids", "study")
DECIDING = ("numpy", "numba")


@cache
def code_version() -> str:
    """SHA-256 over every source that a block passes through, and the versions below it."""
    root = Path(__file__).resolve().parent.parent
    digest = hashlib.sha256(str([versions()[name] for name in DECIDING]).encode())
    for path in sorted(path for room in ROOMS for path in (root / room).rglob("*.py")):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()
