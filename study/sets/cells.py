"""The cells of a cube as pairs: how strong the motion was, by any measure, and what became of the wall."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from grids.motions.measures import MEASURES, PREFIX, Measure
from models.base import FloatArray
from models.errors import InputError
from models.errors import nearest as closest
from study.selection import INTENSITIES, check_axis, complete, over_samples, place, select
from study.status import OVERTURNED, UNKNOWN

MOTION = "motion"
NAMES = tuple(measure.name for measure in MEASURES)


@dataclass(frozen=True)
class Event:
    """That a wall overturns, or that an ``output`` exceeds a ``threshold`` (in its SI unit); overturned walls do."""

    output: str = "overturned"
    threshold: float | None = None
    unit: str = "1"

    def __str__(self) -> str:
        unit = "" if self.unit == "1" else f" {self.unit}"
        return "overturns" if self.threshold is None else f"{self.output} > {self.threshold:.4g}{unit}"


def event_of(cube: xr.Dataset, output: str = "overturned", threshold: float | None = None) -> Event:
    """The event, checked against the cube. Raises InputError."""
    if output == "overturned":
        if threshold is not None:
            raise InputError(f"overturned is yes or no: leave the threshold {threshold:g} out")
        return Event()
    unit = unit_of(cube, output)
    if threshold is None or not np.isfinite(threshold):
        raise InputError(f"an event of {output} needs the threshold that is exceeded, in {unit}")
    return Event(output, float(threshold), unit)


def unit_of(cube: xr.Dataset, output: str) -> str:
    """The SI unit of an output that an event may be about. Raises InputError."""
    if output not in cube.data_vars or output == "status":
        known = [str(name) for name in cube.data_vars if name != "status"]
        raise InputError(f"'{output}' is no output of this cube: {closest(output, known)}")
    return str(cube[output].attrs.get("units", "1"))


def chosen_cells(
    cube: xr.Dataset,
    at: Mapping[str, Any] | None = None,
    over: str | None = None,
    *,
    nearest: bool = False,
    samples: bool = False,
) -> tuple[xr.Dataset, str]:
    """The cells over `motion`, the intensity axis if there is one, and ``over``; what was taken of the other axes.

    Selection as in `study.selection`; axes left open take their middle value. With ``samples`` an axis of samples left
    open stays whole. Raises InputError without an axis `motion`.
    """
    if MOTION not in cube.dims:
        raise InputError("this cube has no axis 'motion': give [motion] several files, or several seeds")
    if over is not None:
        check_axis(cube, over)
        if over in (MOTION, *INTENSITIES):
            raise InputError(f"curves cannot stand for the values of '{over}', which every curve runs over")
    whole = [*([over] if over else []), MOTION, *(d for d in INTENSITIES if d in cube.dims)]
    among = over_samples(cube, at, whole) if samples else []
    taken = complete(cube, at, [*whole, *among])
    kept = select(cube, taken, nearest=nearest)
    dims = [d for d in (over, *among, MOTION, *INTENSITIES) if d is not None and d in kept.dims]
    return kept.squeeze([d for d in kept.dims if d not in dims]).transpose(*dims), place(cube, taken)


def happens(cells: xr.Dataset, event: Event) -> xr.DataArray:
    """1 where the event happens, 0 where it does not, nan where the cell has no valid answer."""
    status = cells["status"]
    if event.threshold is None:
        found = status == OVERTURNED
    else:
        found = (status == OVERTURNED) | (cells[event.output] > event.threshold)
    return found.astype(float).where(~status.isin(UNKNOWN))


def find_measure(name: str) -> Measure:
    """The measure of that name; InputError with the nearest one otherwise."""
    for measure in MEASURES:
        if measure.name == name:
            return measure
    raise InputError(f"'{name}' is no measure of a motion: {closest(name, NAMES)}")


def given(cells: xr.Dataset, scale: str) -> Any:
    """What a plan sets by that name, along an axis or for all cells; None where it does not."""
    fixed: Mapping[str, float] = json.loads(cells.attrs.get("provenance", "{}")).get("setting", {}).get("fixed", {})
    return cells[scale] if scale in cells.coords else fixed.get(scale)


def intensity(cells: xr.Dataset, name: str) -> xr.DataArray:
    """The measure of the motion as it shook each cell: the record's, scaled with it.

    Raises InputError for Sa(T) of motions stretched in time, which does not follow from the record's.
    """
    measure = find_measure(name)
    if PREFIX + name not in cells.coords:
        raise InputError(f"this cube does not hold {PREFIX + name}: run the study again with this version")
    factor = xr.ones_like(cells["status"], dtype=float)
    if (pga := given(cells, "pga")) is not None:
        factor = factor * pga / cells[f"{PREFIX}pga"]
    if (scale := given(cells, "motion_scale")) is not None:
        factor = factor * scale
    values = cells[PREFIX + name] * factor**measure.power
    if name == "pga" and pga is not None:  # not by way of the record's, which would round it
        values = factor.copy(data=np.ones(factor.shape)) * pga * (1.0 if scale is None else scale)
    stretch = given(cells, "time_scale")
    if stretch is not None and not np.all(np.asarray(stretch) == 1.0):
        if measure.stretch is None:
            raise InputError(f"{name} of motions stretched in time does not follow from the record's: take pga or pgv")
        values = values * stretch**measure.stretch
    values = values.broadcast_like(cells["status"]).transpose(*cells["status"].dims)
    return values.rename(name).assign_attrs(units=measure.unit, long_name=measure.meaning, symbol=measure.symbol)


def pairs(strength: xr.DataArray, outcome: xr.DataArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Intensities, outcomes and numbers of the motion, flat (n,), of the cells in which both are known."""
    number = xr.DataArray(np.arange(outcome.sizes[MOTION]), dims=MOTION).broadcast_like(outcome)
    number = number.transpose(*outcome.dims)
    known = np.isfinite(outcome.values) & np.isfinite(strength.values) & (strength.values > 0.0)
    return strength.values[known], outcome.values[known], number.values[known]
