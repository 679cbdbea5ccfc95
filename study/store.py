"""The block store: a block's file exists if and only if the block is finished.

A file is written under a hidden random name, flushed to the disk, renamed onto its key, and the
folder is flushed too; a kill at any moment leaves either no block or a whole one. A file is sealed
with its key (`study.seal`), so damage after that and files put under another key are found. The
netCDF library is not safe between threads, so every open..close holds `NETCDF_LOCK`.
"""

from __future__ import annotations

import errno
import os
import shutil
import time
import uuid
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grids.netcdf_file import check_name
from grids.netcdf_lock import NETCDF_LOCK
from models.errors import InputError
from study.provenance import attribute
from study.seal import is_intact, seal

COMPRESSION: dict[str, Any] = {"compression": "zlib", "complevel": 1, "shuffle": True}

LEFTOVER_SECONDS = 3600.0


def flush(path: Path) -> None:
    """Force a file or a folder onto the disk."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def write_whole(path: Path, write: Callable[[Path], None]) -> None:
    """Let ``write`` fill a hidden temporary file beside ``path``, then put it in place in one step.

    Raises OSError that names ``path`` for whatever the disk refuses, by way of the netCDF library too.
    """
    if path.suffix == ".nc":
        check_name(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.stem}.{uuid.uuid4().hex}.tmp")
    try:
        write(temporary)
        flush(temporary)
        os.replace(temporary, path)
    except OSError as error:
        raise OSError(error.errno or errno.EIO, error.strerror or str(error), str(path)) from None
    except RuntimeError as error:
        if not str(error).startswith("NetCDF:"):
            raise
        free = shutil.disk_usage(path.parent).free / 1e6
        why = f"the netCDF library cannot write it ({free:.0f} MB are free on that disk)"
        raise OSError(errno.EIO, why, str(path)) from None
    finally:
        temporary.unlink(missing_ok=True)
    flush(path.parent)


def write_text(path: Path, text: str) -> None:
    """Write a text file whole or not at all."""
    write_whole(path, lambda temporary: _write_utf8(temporary, text))


def _write_utf8(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")


class DamagedBlock(InputError):
    """A block's file is not what its task wrote (a failing disk, a half copied folder)."""


@dataclass(frozen=True)
class BlockStore:
    """The folders ``blocks`` (``<key>.nc``) and ``failed`` (``<key>.txt``) of one study."""

    folder: Path

    @property
    def blocks(self) -> Path:
        return self.folder / "blocks"

    @property
    def failed(self) -> Path:
        return self.folder / "failed"

    def finished(self) -> set[str]:
        """Keys of the blocks whose files are there, intact or not."""
        return {path.stem for path in self.blocks.glob("*.nc") if not path.name.startswith(".")}

    def is_intact(self, key: str) -> bool:
        """Whether a block's file holds what its task wrote."""
        return is_intact(self._path(key), key)

    def failures(self) -> dict[str, str]:
        """Why blocks failed, by key; a block that a later attempt finished is none."""
        finished = self.finished()
        reasons = {path.stem: path.read_text("utf-8", "replace") for path in sorted(self.failed.glob("*.txt"))}
        return {key: reason for key, reason in reasons.items() if key not in finished}

    def sweep(self) -> None:
        """Remove what killed runs left half written.

        Young files stay: a cluster's worker may still be at work for a run that was killed.
        """
        for folder in (self.folder, self.blocks, self.failed):
            for leftover in folder.glob(".*.tmp"):
                if time.time() - leftover.stat().st_mtime > LEFTOVER_SECONDS:
                    leftover.unlink(missing_ok=True)

    def write(
        self,
        key: str,
        coordinates: Mapping[str, NDArray[Any]],
        outputs: Mapping[str, NDArray[Any]],
        attributes: Mapping[str, Any],
    ) -> None:
        """Store a finished block; the dimensions of ``outputs`` are the names of ``coordinates``."""

        def fill(temporary: Path) -> None:
            _write(temporary, coordinates, outputs, attributes)
            seal(temporary, key)

        write_whole(self._path(key), fill)
        (self.failed / f"{key}.txt").unlink(missing_ok=True)

    def read(self, key: str) -> tuple[dict[str, tuple[Any, ...]], dict[str, NDArray[Any]]]:
        """Values along the axes of a finished block, and its outputs, shaped as its axes, by name.

        Raises DamagedBlock when the file is not what was written.
        """
        import netCDF4

        path = self._path(key)
        if not self.is_intact(key):
            raise DamagedBlock(f"{path} is not what was written: run again, it is computed anew")
        with NETCDF_LOCK, netCDF4.Dataset(path) as dataset:
            dataset.set_auto_mask(False)
            found = {name: dataset[name][...] for name in dataset.variables}
            axes = {name: tuple(found.pop(name).tolist()) for name in dataset.dimensions}
        return axes, found

    def _path(self, key: str) -> Path:
        return self.blocks / f"{key}.nc"

    def fail(self, key: str, reason: str) -> None:
        """Record why a block failed; the next run tries it again."""
        write_text(self.failed / f"{key}.txt", reason)


def _write(
    path: Path,
    coordinates: Mapping[str, NDArray[Any]],
    outputs: Mapping[str, NDArray[Any]],
    attributes: Mapping[str, Any],
) -> None:
    import netCDF4

    with NETCDF_LOCK, netCDF4.Dataset(path, "w") as dataset:
        dataset.setncatts({name: attribute(value) for name, value in attributes.items()})
        for name, values in coordinates.items():
            dataset.createDimension(name, len(values))
            kind = str if values.dtype.kind in "OUS" else values.dtype
            dataset.createVariable(name, kind, (name,))[:] = values.astype(object) if kind is str else values
        for name, values in outputs.items():
            variable = dataset.createVariable(
                name,
                values.dtype,
                tuple(coordinates),
                fill_value=False,
                chunksizes=values.shape or None,
                **COMPRESSION,
            )
            variable[...] = np.ascontiguousarray(values)
