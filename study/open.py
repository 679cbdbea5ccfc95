"""Read back what a run wrote."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

import numpy as np
import xarray as xr

import study.accessor  # noqa: F401  (registers cube.rocking)
from grids.files import path_of
from grids.netcdf_file import check_name, check_netcdf
from grids.netcdf_lock import NETCDF_LOCK, bounded_cache
from models.base import STATUS
from models.errors import InputError, nearest
from study.labels import flags
from study.seal import is_intact, is_sealed

CUBE = "cube.nc"
"""Name under which a run writes and seals the cube of a study."""


def open_study(folder: str | Path, outputs: Collection[str] | None = None, *, lazy: bool = False) -> xr.Dataset:
    """The cube of a study, in memory: ``folder`` is ``results/<name>`` or the path of a cube file.

    All of its outputs, or those named and the status, which maps need. A ``lazy`` one holds dask arrays in the chunks
    of the file, which stays open until it is closed, and need not fit in memory:
    ``with open_study(folder, lazy=True) as cube``, select, then ``compute()``.

    Maps and slices hang on it: ``cube.rocking.overturning_map(x="aspect_ratio", y="top_mass")``.
    Raises InputError when there is no cube yet, or when a byte of it has changed since it was written.
    """
    path = path_of(folder, "study", "give the name of its folder, results/NAME")
    if path.is_dir() or not path.suffix:
        path = path / CUBE
    if not path.exists():
        raise InputError(f"{path} does not exist: run the study first, or correct the folder")
    check_name(path)
    if not is_sealed(path):  # another program's, or an export: the library below may not survive what is wrong with it
        try:
            check_netcdf(path)
        except InputError as error:
            raise InputError(f"{path}: {error}") from None
    elif not is_intact(path, CUBE):
        raise InputError(f"{path} has changed since it was written: run the study again, it is made anew")
    try:
        if lazy:
            with NETCDF_LOCK, bounded_cache():
                cube = xr.open_dataset(path, engine="netcdf4", chunks={}, lock=NETCDF_LOCK)
            found = _chosen(cube, path, outputs)
            if found is not cube:
                found.set_close(cube.close)
            return found
        with NETCDF_LOCK, xr.open_dataset(path, engine="netcdf4") as cube:
            return _chosen(cube, path, outputs).load()
    except InputError:
        raise
    except (OSError, ValueError) as error:
        raise InputError(f"{path} is not a readable cube ({error}): run the study again") from None


def _chosen(cube: xr.Dataset, path: Path, outputs: Collection[str] | None) -> xr.Dataset:
    if "status" not in cube.data_vars:
        raise InputError(
            f"{path} is no cube of a study (it has no variable 'status'): name results/NAME or its cube.nc"
        )
    today = _of_today(cube)
    if outputs is None:
        return today
    names = [outputs] if isinstance(outputs, str) else [*outputs]
    for name in names:
        if name not in today.data_vars:
            raise InputError(f"{path} has no output '{name}'; {nearest(str(name), map(str, today.data_vars))}")
    return today[[*dict.fromkeys([*names, "status"])]]


def _of_today(cube: xr.Dataset) -> xr.Dataset:
    """The cube with the flags of `models.base.STATUS`, whose numbers have changed since the first version."""
    stored = str(cube["status"].attrs.get("flag_meanings", "")).split()
    if stored == list(STATUS) or not set(stored) <= set(STATUS):
        return cube
    codes = np.array([STATUS.index(word) for word in stored], dtype=np.int8)
    status = xr.apply_ufunc(codes.__getitem__, cube["status"], dask="parallelized", output_dtypes=[codes.dtype])
    return cube.assign(status=status.assign_attrs({**cube["status"].attrs, **flags(STATUS)}))
