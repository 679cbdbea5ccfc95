"""A checksum at the end of a file, over its bytes and its name in the study.

netCDF-4 files may be followed by other bytes, so a sealed file stays readable by every tool. Damage is found
before a library interprets the bytes: one that trusts a broken header can take all memory or end the program.
"""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import BinaryIO

MARK = b"rocking-study seal\n"
SIZE = len(MARK) + hashlib.sha256().digest_size
PIECE = 1 << 20


def seal(path: Path, name: str) -> None:
    """Append the checksum to a finished file that will be known as ``name``."""
    with path.open("r+b") as file:
        digest = _digest(file, path.stat().st_size, name)
        file.seek(0, 2)
        file.write(MARK + digest)


def is_sealed(path: Path) -> bool:
    """Whether the file ends in a checksum; files of other programs do not."""
    if path.stat().st_size < SIZE:
        return False
    with path.open("rb") as file:
        file.seek(-SIZE, 2)
        return file.read(len(MARK)) == MARK


def is_intact(path: Path, name: str) -> bool:
    """Whether the file is sealed as ``name`` and no byte has changed since."""
    if not path.is_file() or not is_sealed(path):
        return False
    with path.open("rb") as file:
        digest = _digest(file, path.stat().st_size - SIZE, name)
        file.seek(-len(digest), 2)
        return file.read() == digest


def _digest(file: BinaryIO, size: int, name: str) -> bytes:
    """SHA-256 of the name and of the first ``size`` bytes."""
    found = hashlib.sha256(f"{name}\n".encode())
    while size > 0:
        piece = file.read(min(PIECE, size))
        if not piece:
            break
        found.update(piece)
        size -= len(piece)
    return found.digest()
