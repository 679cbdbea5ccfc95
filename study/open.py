"""Read back what a run wrote."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

import study.accessor  # noqa: F401  (registers cube.rocking)
from grids.netcdf_lock import NETCDF_LOCK
from models.errors import InputError


def open_study(folder: str | Path) -> xr.Dataset:
    """The cube of a study, in memory: ``folder`` is ``results/<name>`` or the path of a cube file.

    Maps and slices hang on it: ``cube.rocking.overturning_map(x="aspect_ratio", y="top_mass")``.
    Raises InputError when there is no cube yet.
    """
    path = Path(folder)
    if path.is_dir() or not path.suffix:
        path = path / "cube.nc"
    if not path.exists():
        raise InputError(f"{path} does not exist: run the study first, or correct the folder")
    try:
        with NETCDF_LOCK, xr.open_dataset(path, engine="netcdf4") as cube:
            return cube.load()
    except (OSError, ValueError) as error:
        raise InputError(f"{path} is not a readable cube ({error}): run the study again") from None
