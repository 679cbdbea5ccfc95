"""Samples of what a calibration or a diagnosis found, as an axis of a study.

[samples]
from = "answer/posterior.nc"
count = 200                       # the first 200 of them; all without it
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pydantic import Field

from grids.axes import Axis
from grids.axes.base import bounded
from grids.files import Schema
from grids.netcdf_file import read_netcdf
from grids.targets import Targets
from grids.units import factor_to_si
from models.errors import InputError

NAME = "sample"
MEANING = "sample of what was found"
"""Marks the axis in a cube: a list of design points may be called `sample` too."""


class SamplesTable(Schema):
    source: str = Field(alias="from")
    count: int | None = Field(default=None, ge=1)


def read_samples(table: SamplesTable, targets: Targets, folder: Path) -> Axis:
    """The axis `sample`, which sets at each of its points all names in the file together.

    Variables over `sample`, named as in plans, with `units`; those with the attribute ``of = "errors"`` belong to the
    recordings and are passed over. Raises InputError.
    """
    where = f"[samples] from = '{table.source}'"
    try:
        data = read_netcdf(folder / table.source)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
    points = {}
    for name, variable in data.variables.items():
        if variable.dimensions != (NAME,) or name == NAME or variable.attributes.get("of") == "errors":
            continue
        target = targets.find(name, f"{where} {name}")
        if target.words or variable.values is None:
            raise InputError(f"{where}: {name} is no number that can vary; leave it out of the file.")
        factor = factor_to_si(str(variable.attributes.get("units", "1")), target.unit, f"{where} {name}")
        points[name] = bounded(np.asarray(variable.values, np.float64) * factor, target, f"{where} {name}")
    if not points:
        raise InputError(
            f"{where}: the file holds no variable over '{NAME}'; give one that calibrate or diagnose wrote."
        )
    held = len(next(iter(points.values())))
    count = held if table.count is None else table.count
    if count > held:
        raise InputError(f"[samples] count = {count}: the file holds {held} samples; give at most these.")
    points = {name: values[:count] for name, values in points.items()}
    return Axis(NAME, np.arange(count), "1", MEANING, points)
