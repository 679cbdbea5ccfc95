"""A case on disk: the folder that the diagnosis reads, and the key that it does not."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.diagnosis.cases import Case
from diagnosis.prove.answers import write_json
from grids.netcdf_lock import NETCDF_LOCK

UNITS = {"rotation_1": "rad", "rotation_2": "rad", "base_acceleration_x": "m s-2", "base_acceleration_z": "m s-2"}


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
