"""Recordings in netCDF: dimension `time` (s), variables by standard name with a `units` attribute.

`base_acceleration_x` may say how it goes on `between_samples`: "band_limited", as what a logger samples (default), or
"linear", as in a simulation under straight lines between its samples.
"""

from __future__ import annotations

import difflib
from pathlib import Path

import numpy as np

from grids.netcdf_file import Variable, read_netcdf
from grids.recordings.base import CHANNELS, REQUIRED, FloatArray, Raw, unknown_channel
from grids.recordings.levels import numbered
from grids.recordings.placed import KEYS, read_places
from grids.sampling import uniform_step
from grids.units import factor_to_si
from models.errors import InputError, nearest
from models.kinematics import Place

BETWEEN = "between_samples"
LINEAR, BAND_LIMITED = "linear", "band_limited"
CLOSE = 0.8
"""How alike (`difflib`) an attribute is to a known one that it is a slip; CF's 'positive' is .67 of 'position_x'."""
SUFFIXES = (".nc", ".nc4", ".cdf", ".netcdf")


def read(path: Path) -> Raw:
    """The channels of a netCDF file in SI; raises InputError."""
    data = read_netcdf(path)
    if "time" not in data.variables:
        found = ", ".join(sorted({dimension for one in data.variables.values() for dimension in one.dimensions}))
        raise InputError(f"has no dimension and variable 'time' (dimensions: {found}); add it.")
    times = _si(data.variables["time"], "time", "s", ("time",))
    channels: dict[str, FloatArray] = {}
    notes: list[str] = []
    levels: tuple[str, ...] = ()
    places: dict[str, Place] = {}
    for name, variable in data.variables.items():
        if name not in CHANNELS and "time" in variable.dimensions and name not in variable.dimensions:
            _refuse_misspelt(name, variable)
        if name not in CHANNELS and "quantity" in variable.attributes and variable.dimensions == ("time",):
            stated = {key: _plain(variable.attributes[key]) for key in KEYS if key in variable.attributes}
            places |= read_places({name: stated}, CHANNELS)
            channels[name] = _si(variable, name, places[name].unit, ("time",))
            continue
        if name not in CHANNELS:
            if "time" in variable.dimensions and name not in variable.dimensions:
                notes.append(f"{unknown_channel(name)} It is left out.")
            continue
        wanted = ("level", "time") if CHANNELS[name].by_level else ("time",)
        channels[name] = _si(variable, name, CHANNELS[name].unit, wanted)
        if "level" in wanted:
            levels = _levels(data.variables.get("level"), len(channels[name]))
    return Raw(
        uniform_step(times, "time"), float(times[0]), channels, levels, tuple(notes), dict(data.attributes), places,
        _band_limited(data.variables.get(REQUIRED)),
    )  # fmt: skip


def _band_limited(base: Variable | None) -> bool:
    stated = BAND_LIMITED if base is None else base.attributes.get(BETWEEN, BAND_LIMITED)
    if stated not in (LINEAR, BAND_LIMITED):
        raise InputError(f"{REQUIRED}: {BETWEEN} is '{stated}'; {nearest(str(stated), (LINEAR, BAND_LIMITED))}")
    return stated == BAND_LIMITED


def _refuse_misspelt(name: str, variable: Variable) -> None:
    """An attribute like one of `KEYS` is meant as one; passed over, it would leave the channel at another place."""
    known = "quantity" in variable.attributes
    for attribute in variable.attributes:
        close = difflib.get_close_matches(attribute.lower(), KEYS, n=1, cutoff=CLOSE)
        if close and attribute not in KEYS and (known or close[0] == "quantity"):  # else the channel is left out
            raise InputError(f"channel {name}: attribute '{attribute}' is not known; did you mean '{close[0]}'?")


def _plain(attribute: str) -> str | float:
    """An attribute as a number where it is one."""
    try:
        return float(attribute)
    except ValueError:
        return attribute


def _levels(stored: Variable | None, count: int) -> tuple[str, ...]:
    if stored is None:
        return tuple(str(level) for level in range(count))
    if stored.dimensions != ("level",):
        raise InputError(f"level is over {stored.dimensions}; it belongs over ('level',).")
    if stored.text is not None:
        return numbered(stored.text)
    if stored.values is None:
        raise InputError(f"level holds {stored.type}, not numbers; number the levels from 0.")
    return numbered([f"{level:g}" for level in stored.values.tolist()])


def _si(variable: Variable, name: str, unit: str, wanted: tuple[str, ...]) -> FloatArray:
    if set(variable.dimensions) != set(wanted) or len(variable.dimensions) != len(wanted):
        raise InputError(f"{name} is over {variable.dimensions}; it belongs over {wanted}.")
    if variable.values is None:
        raise InputError(f"{name} holds {variable.type}, not numbers; store numbers with units.")
    if variable.values.size == 0:
        raise InputError(f"{name} is empty; was the file written to its end?")
    stated = variable.attributes.get("units")
    if stated is None and unit != "1":
        raise InputError(f"{name} has no attribute 'units'; add it, for example '{unit}'.")
    if name == "time":
        stated = str(stated).partition(" since ")[0]
    values = variable.values if variable.dimensions == wanted else variable.values.T
    return np.ascontiguousarray(values) * factor_to_si(stated or "1", unit, name)
