"""Part of a cube as CSV (one row a cell) or as a smaller netCDF file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import xarray as xr

from grids.netcdf_lock import NETCDF_LOCK
from models.errors import InputError, nearest
from study.selection import select
from study.store import write_whole


def export(
    cube: xr.Dataset, out: str | Path, *, outputs: Sequence[str] = (), at: Mapping[str, Any] | None = None
) -> Path:
    """Write ``out`` (.csv or .nc): all outputs or the named ones, at the selected values.

    The CSV has one row a cell, a column for every coordinate and output with its unit in brackets,
    numbers with all their digits. Raises InputError for unknown names and endings.
    """
    path = Path(out)
    chosen = select(cube, at)
    known = [str(name) for name in chosen.data_vars]
    for name in outputs:
        if name not in known:
            raise InputError(f"'{name}' is no output of this cube: {nearest(name, known)}")
    chosen = chosen[list(outputs)] if outputs else chosen
    chosen.attrs = dict(cube.attrs)
    if path.suffix == ".csv":
        write_whole(path, lambda temporary: _write_csv(chosen, temporary))
    elif path.suffix == ".nc":
        write_dataset(chosen, path)
    else:
        raise InputError(f"cannot export to '{path.name}': end the name in .csv or .nc")
    return path


def write_dataset(values: xr.Dataset, path: Path) -> Path:
    """Write a Dataset as netCDF, whole or not at all."""

    def write(temporary: Path) -> None:
        with NETCDF_LOCK:
            values.to_netcdf(temporary, engine="netcdf4", format="NETCDF4")

    write_whole(path, write)
    return path


def _write_csv(cube: xr.Dataset, path: Path) -> None:
    """Rows in the order of the cube, one slab of the first axis at a time."""
    dims = list(map(str, cube.dims))
    names = [*dims, *(str(n) for n in cube.coords if n not in cube.dims), *map(str, cube.data_vars)]
    with path.open("w", encoding="utf-8", newline="") as file:
        for k in range(cube.sizes[dims[0]] if dims else 1):
            slab = cube.isel({dims[0]: [k]}) if dims else cube.expand_dims("cell")
            frame = slab.to_dataframe(dim_order=dims or None).reset_index()[names]
            heading = [_heading(name, cube[name]) for name in names]
            frame.to_csv(file, index=False, header=heading if k == 0 else False)


def _heading(name: str, values: xr.DataArray) -> str:
    unit = values.attrs.get("units", "1")
    return name if unit == "1" else f"{name} [{unit}]"
