"""A case on disk: the folder that the diagnosis reads, and the key that it does not."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.diagnosis.cases import Case
from grids.netcdf_lock import NETCDF_LOCK

UNITS = {"rotation_1": "rad", "base_acceleration_x": "m s-2", "base_acceleration_z": "m s-2"}


def write_case(case: Case, folder: Path, key: Path) -> None:
    """Write the recordings and the specimen into ``folder``, the answer to ``key``; the key last."""
    import netCDF4

    folder.mkdir(parents=True, exist_ok=True)
    (folder / "specimen.toml").write_text(case.specimen, encoding="utf-8")
    for name, channels in case.channels.items():
        with NETCDF_LOCK, netCDF4.Dataset(folder / f"{name}.nc", "w") as file:
            file.title = folder.name
            count = len(next(iter(channels.values())))
            file.createDimension("time", count)
            for channel, values in {"time": np.arange(count) / case.sampling_hz, **channels}.items():
                variable = file.createVariable(channel, "f8" if channel == "time" else "f4", ("time",))
                variable.units = UNITS.get(channel, "s")
                variable[:] = values
    write_json(key, case.key)


def write_json(path: Path, content: Mapping[str, Any]) -> None:
    """Whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_suffix(".partial")
    partial.write_text(json.dumps(content, indent=1), encoding="utf-8")
    os.replace(partial, path)


def read_json(path: Path) -> dict[str, Any]:
    content: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return content
