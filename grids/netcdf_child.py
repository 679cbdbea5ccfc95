"""The process that reads netCDF files of others: ``python -m grids.netcdf_child``, one request a line.

With the name of a file it reads that one and ends, which says whether anybody can (`grids.netcdf_file.check_netcdf`).

The library under netCDF4 trusts what a file says of itself: a few wrong bytes make it take all memory, run for
ever or end the process. So it works here, under limits of memory and computing time, and the process that asks
survives it (`grids.netcdf_file`). A request is JSON with ``path``, ``bytes`` (the most that may be taken) and
``variables`` (false: the attributes of the file alone); the answer is one line of JSON, then the numbers of the
variables that have any, one after another.
"""

from __future__ import annotations

import json
import resource
import sys
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np

SECONDS, MEGABYTES_A_SECOND = 1, 10
"""Of computing time that one file may take, and one more for so many megabytes of it."""

COMPRESSED = 1000
"""Largest ratio of compression that zlib reaches."""


def try_file(path: Path) -> None:
    """Read all variables and keep nothing; within the memory and the time that a file of its size can need."""
    size = path.stat().st_size
    _limit(COMPRESSED * size + 100_000_000, 5 * _seconds(size))
    with netCDF4.Dataset(path) as data:
        for variable in data.variables.values():
            variable[...]


def main() -> None:
    answers = sys.stdout.buffer
    answers.write(b"ready\n")
    answers.flush()
    for line in sys.stdin:
        request = json.loads(line)
        arrays: list[np.ndarray] = []
        try:
            _limit(int(request["bytes"]), _seconds(Path(request["path"]).stat().st_size))
            answer = _read(Path(request["path"]), int(request["bytes"]), arrays, request["variables"])
        except MemoryError:
            answer = {"error": "it wants more memory than a file of its size can hold"}
        except Exception as error:
            answer = {"error": str(error) or type(error).__name__}
        if "error" in answer:
            arrays = []  # what was read until then: it would be taken for the answer about the next file
        answers.write(json.dumps(answer).encode() + b"\n")
        for array in arrays:
            answers.write(array.tobytes())
        answers.flush()


def _seconds(size: int) -> int:
    """Of computing time for a file of so many bytes."""
    return SECONDS + size // (1_000_000 * MEGABYTES_A_SECOND)


def _limit(more_bytes: int, seconds: int) -> None:
    """Let this process take so much more memory and computing time."""
    now = 1024 * int(Path("/proc/self/status").read_text().split("VmSize:")[1].split()[0])
    used = resource.getrusage(resource.RUSAGE_SELF)
    spent = int(used.ru_utime + used.ru_stime)
    for kind, limit in ((resource.RLIMIT_AS, now + more_bytes), (resource.RLIMIT_CPU, spent + seconds + 1)):
        hard = resource.getrlimit(kind)[1]  # that of a batch system cannot be raised
        resource.setrlimit(kind, (limit if hard == resource.RLIM_INFINITY else min(limit, hard), hard))


def _read(path: Path, most_bytes: int, arrays: list[np.ndarray], variables: bool) -> dict[str, Any]:
    """Attributes and ``variables`` of a file; numbers (float64, nan where there is none) go into ``arrays``."""
    described = []
    with netCDF4.Dataset(path) as data:
        if not variables:
            return {"attributes": _attributes(data), "variables": []}
        sizes = {name: variable.size * 8 for name, variable in data.variables.items()}
        if sum(sizes.values()) > most_bytes:
            raise ValueError(f"it says that it holds {sum(sizes.values()):.3g} bytes, far more than a file of its size")
        for name, variable in data.variables.items():
            _check_scaling(name, variable)
            one: dict[str, Any] = {
                "name": name,
                "dimensions": variable.dimensions,
                "shape": variable.shape,
                "type": str(variable.dtype if variable.dtype is not str else "text"),
                "attributes": _attributes(variable),
            }
            if isinstance(variable.dtype, np.dtype) and variable.dtype.kind in "fiu":
                values = np.ma.filled(np.ma.asarray(variable[...], dtype=np.float64), np.nan)
                if values.shape != variable.shape:  # the answer would hold more or fewer numbers than it says
                    raise ValueError(f"{name} says that it is {variable.shape} and holds {values.shape}")
                arrays.append(np.ascontiguousarray(values))
                one["numbers"] = True
            elif variable.dtype is str:
                one["text"] = [str(value) for value in np.ravel(variable[...])]
            described.append(one)
        return {"attributes": _attributes(data), "variables": described}


def _check_scaling(name: str, variable: Any) -> None:
    """Raise ValueError for a scale or offset in words, which netCDF4 leaves out or stumbles over."""
    for attribute in ("scale_factor", "add_offset"):
        value = getattr(variable, attribute, 1.0)
        if isinstance(value, str):
            raise ValueError(f"{attribute} of {name} is {value!r}, no number")


def _attributes(owner: Any) -> dict[str, str]:
    return {name: str(owner.getncattr(name)) for name in owner.ncattrs()}


if __name__ == "__main__":
    if len(sys.argv) > 1:
        try_file(Path(sys.argv[1]))
    else:
        main()
