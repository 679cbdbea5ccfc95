"""Part of a cube as CSV (one row a cell) or as a smaller netCDF file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from math import prod
from pathlib import Path
from typing import Any

import dask
import xarray as xr

from grids.netcdf_lock import NETCDF_LOCK, bounded_cache
from models.errors import InputError, nearest
from study.selection import select
from study.store import write_whole

ROWS_AT_ONCE = 1 << 17
"""Cells of a table in memory at once."""


def export(
    cube: xr.Dataset, out: str | Path, *, outputs: Sequence[str] = (), at: Mapping[str, Any] | None = None
) -> Path:
    """Write ``out`` (.csv or .nc): all outputs or the named ones, at the selected values.

    A smaller cube keeps ``status``, without which it is none.

    The CSV has one row a cell, a column for every coordinate and output with its unit in brackets,
    numbers with all their digits. Raises InputError for unknown names and endings.
    """
    path = Path(out)
    chosen = select(cube, at)
    known = [str(name) for name in chosen.data_vars]
    for name in outputs:
        if name not in known:
            raise InputError(f"'{name}' is no output of this cube: {nearest(name, known)}")
    if outputs:
        table = path.suffix == ".csv"
        chosen = chosen[list(outputs if table else dict.fromkeys([*outputs, "status"]))]
    chosen.attrs = dict(cube.attrs)
    if path.suffix == ".csv":
        write_whole(path, lambda temporary: _write_csv(chosen, temporary))
    elif path.suffix == ".nc":
        write_dataset(chosen, path)
    else:
        raise InputError(f"cannot export to '{path.name}': end the name in .csv or .nc")
    return path


def write_dataset(values: xr.Dataset, path: Path) -> Path:
    """Write a Dataset as netCDF, whole or not at all; a lazy one chunk by chunk."""

    def write(temporary: Path) -> None:
        # read in this thread, which holds the lock
        with NETCDF_LOCK, bounded_cache(), dask.config.set(scheduler="synchronous"):
            values.to_netcdf(temporary, engine="netcdf4", format="NETCDF4")

    write_whole(path, write)
    return path


def _write_csv(cube: xr.Dataset, path: Path) -> None:
    """Rows in the order of the cube, some at a time."""
    dims = list(map(str, cube.dims))
    names = [*dims, *(str(n) for n in cube.coords if n not in cube.dims), *map(str, cube.data_vars)]
    heading: list[str] | bool = [_heading(name, cube[name]) for name in names]
    with path.open("w", encoding="utf-8", newline="") as file:
        for part in _slabs([cube.sizes[dim] for dim in dims]):
            slab = cube.isel(dict(zip(dims, part, strict=True))) if dims else cube.expand_dims("cell")
            frame = slab.compute().to_dataframe(dim_order=dims or None).reset_index()[names]
            frame.to_csv(file, index=False, header=heading)
            heading = False


def _slabs(shape: Sequence[int]) -> Iterator[tuple[slice, ...]]:
    """Parts of a grid in the order of its cells: some values of an axis, each of those before it, all of the others."""
    whole = len(shape)
    while whole and prod(shape[whole - 1 :]) <= ROWS_AT_ONCE:
        whole -= 1
    if whole == 0:
        yield tuple(slice(None) for _ in shape)
        return
    step = max(1, ROWS_AT_ONCE // prod(shape[whole:]))
    for place in product(*map(range, shape[: whole - 1])):
        for start in range(0, shape[whole - 1], step):
            yield (*(slice(k, k + 1) for k in place), slice(start, start + step), *(slice(None) for _ in shape[whole:]))


def _heading(name: str, values: xr.DataArray) -> str:
    unit = values.attrs.get("units", "1")
    return name if unit == "1" else f"{name} [{unit}]"
