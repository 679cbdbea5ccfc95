"""netCDF: a motion (``acceleration_north`` ...) or a recording (``base_acceleration_x``, ``_z``).

Every variable ``acceleration_NAME`` or ``base_acceleration_NAME`` over ``time`` is a component;
variable and time state their units.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from grids.motions.readers.base import FloatArray, Reader, Record, assemble, check_samples, component_name
from grids.motions.units import acceleration_factor
from grids.netcdf_lock import NETCDF_LOCK
from grids.sampling import uniform_step
from grids.units import factor_to_si
from models.errors import InputError


def _numbers(variable: Any) -> FloatArray:
    return np.asarray(np.ma.filled(np.ma.asarray(variable[:], dtype=np.float64), np.nan))


def _content(path: Path) -> tuple[dict[str, str], dict[str, tuple[FloatArray, str, tuple[str, ...]]]]:
    """Global attributes, and values, unit and dimensions of ``time`` and of the components."""
    import netCDF4

    try:
        with NETCDF_LOCK, netCDF4.Dataset(path) as data:
            attributes = {name: str(data.getncattr(name)) for name in data.ncattrs()}
            wanted = [n for n in data.variables if n == "time" or component_name(n) is not None]
            return attributes, {
                name: (
                    _numbers(data.variables[name]),
                    str(getattr(data.variables[name], "units", "")),
                    data.variables[name].dimensions,
                )
                for name in wanted
            }
    except (OSError, RuntimeError) as error:
        raise InputError(f"{path.name}: cannot be read as netCDF ({error}): it is cut short or damaged") from None
    except (ValueError, TypeError):
        raise InputError(f"{path.name}: time or acceleration holds no numbers: write numbers with units") from None


def _read(path: Path, key: str | None, statement: Mapping[str, Any]) -> Record:
    attributes, variables = _content(path)
    if "time" not in variables:
        raise InputError(f"{path.name}: has no variable 'time': add the times of the samples, with units")
    times, unit, _ = variables.pop("time")
    if not variables:
        raise InputError(
            f"{path.name}: has no variable acceleration_NAME or base_acceleration_NAME: "
            "rename the channels of the motion"
        )
    for name, (_, stated, dimensions) in variables.items():
        if dimensions != ("time",):
            raise InputError(f"{path.name}: {name} lies over {dimensions or 'nothing'}, not over ('time',)")
        if not stated:
            raise InputError(f"{path.name}: {name} states no units: add the attribute units, for instance 'm s-2'")
    if not unit:
        raise InputError(f"{path.name}: time states no units: add the attribute units = 's'")
    word = unit.split(" since ")[0]
    step = uniform_step(times if word == "s" else times * factor_to_si(word, "s", f"{path.name}: time"), path.name)
    components = [
        (
            component_name(name) or name,
            step,
            check_samples(values * acceleration_factor(stated, f"{path.name}: {name}"), f"{path.name}: {name}"),
        )
        for name, (values, stated, _) in variables.items()
    ]
    kept: dict[str, Any] = {k: attributes[k] for k in ("title", "source", "license", "processing") if k in attributes}
    return assemble(path.stem, components, {"format": NETCDF.name, "files": (path.name,), **kept}, where=path.name)


NETCDF = Reader("netCDF", (".nc", ".nc4"), _read)
