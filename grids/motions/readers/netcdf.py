"""netCDF: a motion (``acceleration_north`` ...) or a recording (``base_acceleration_x``, ``_z``).

Every variable ``acceleration_NAME`` or ``base_acceleration_NAME`` over ``time`` is a component;
variable and time state their units.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from grids.motions.readers.base import Reader, Record, assemble, check_samples, component_name
from grids.netcdf_file import read_netcdf
from grids.sampling import uniform_step
from grids.units import factor_to_si
from models.errors import InputError


def _read(path: Path, key: str | None, statement: Mapping[str, Any]) -> Record:
    try:
        data = read_netcdf(path)
    except InputError as error:
        raise InputError(f"{path.name}: {error}") from None
    variables = {n: one for n, one in data.variables.items() if n == "time" or component_name(n) is not None}
    if "time" not in variables:
        raise InputError(f"{path.name}: has no variable 'time': add the times of the samples, with units")
    for name, variable in variables.items():
        if variable.values is None:
            raise InputError(f"{path.name}: {name} holds {variable.type}, no numbers: write numbers with units")
        if variable.dimensions != ("time",):
            raise InputError(f"{path.name}: {name} lies over {variable.dimensions or 'nothing'}, not over ('time',)")
    clock = variables.pop("time")
    unit = clock.attributes.get("units", "")
    if not variables:
        raise InputError(
            f"{path.name}: has no variable acceleration_NAME or base_acceleration_NAME: "
            "rename the channels of the motion"
        )
    for name, variable in variables.items():
        if not variable.attributes.get("units"):
            raise InputError(f"{path.name}: {name} states no units: add the attribute units, for instance 'm s-2'")
    if not unit:
        raise InputError(f"{path.name}: time states no units: add the attribute units = 's'")
    word, times = unit.split(" since ")[0], np.asarray(clock.values)
    step = uniform_step(times if word == "s" else times * factor_to_si(word, "s", f"{path.name}: time"), path.name)
    components = [
        (
            component_name(name) or name,
            step,
            check_samples(
                np.asarray(one.values) * factor_to_si(one.attributes["units"], "m s-2", f"{path.name}: {name}"),
                f"{path.name}: {name}",
            ),
        )
        for name, one in variables.items()
    ]
    kept: dict[str, Any] = {k: v for k in ("title", "source", "license", "processing") if (v := data.attributes.get(k))}
    return assemble(path.stem, components, {"format": NETCDF.name, "files": (path.name,), **kept}, where=path.name)


NETCDF = Reader("netCDF", (".nc", ".nc4"), _read)
