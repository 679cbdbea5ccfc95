"""Recordings in netCDF: dimension `time` (s), variables by standard name with a `units` attribute."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from grids.netcdf_lock import NETCDF_LOCK
from grids.recordings.base import CHANNELS, FloatArray, Raw, unknown_channel
from grids.sampling import uniform_step
from grids.units import factor_to_si
from models.errors import InputError

if TYPE_CHECKING:
    import xarray

SUFFIXES = (".nc", ".nc4", ".cdf", ".netcdf")


def read(path: Path) -> Raw:
    """The channels of a netCDF file in SI; raises InputError."""
    import xarray

    try:
        with NETCDF_LOCK, xarray.open_dataset(path, decode_times=False, engine="netcdf4") as stored:
            data = stored.load()
    except (OSError, ValueError, RuntimeError) as error:
        raise InputError(f"not a readable netCDF file ({error}); is it damaged or cut short?") from None
    if "time" not in data.dims or "time" not in data.variables:
        found = ", ".join(map(str, data.dims))
        raise InputError(f"has no dimension and variable 'time' (dimensions: {found}); add it.")
    times = _si(data["time"], "time", "s")
    channels: dict[str, FloatArray] = {}
    notes: list[str] = []
    levels: tuple[str, ...] = ()
    for key, variable in data.data_vars.items():
        name = str(key)
        if name not in CHANNELS:
            if "time" in variable.dims:
                notes.append(f"{unknown_channel(name)} It is left out.")
            continue
        wanted = ("level", "time") if CHANNELS[name].by_level else ("time",)
        if set(variable.dims) != set(wanted):
            raise InputError(f"{name} is over {variable.dims}; it belongs over {wanted}.")
        channels[name] = _si(variable.transpose(*wanted), name, CHANNELS[name].unit)
        if "level" in wanted:
            levels = tuple(str(level) for level in data["level"].values.tolist())
    source = {str(k): str(v) for k, v in data.attrs.items()}
    return Raw(uniform_step(times, "time"), float(times[0]), channels, levels, tuple(notes), source)


def _si(variable: xarray.DataArray, name: str, unit: str) -> FloatArray:
    if variable.size == 0:
        raise InputError(f"{name} is empty; was the file written to its end?")
    if not np.issubdtype(variable.dtype, np.number):
        raise InputError(f"{name} holds {variable.dtype}, not numbers; store numbers with units.")
    stated: Any = variable.attrs.get("units")
    if stated is None and unit != "1":
        raise InputError(f"{name} has no attribute 'units'; add it, for example '{unit}'.")
    if name == "time":
        stated = str(stated).partition(" since ")[0]
    return np.asarray(variable.values, dtype=np.float64) * factor_to_si(str(stated or "1"), unit, name)
