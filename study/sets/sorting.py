"""Which measure of the motion sorts the outcomes best."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from scipy.stats import rankdata
from scipy.stats import t as student

from models.base import FloatArray
from models.errors import InputError
from study.sets.cells import MOTION, NAMES, Event, chosen_cells, happens, intensity, pairs
from study.sets.lognormal import FEWEST_MOTIONS, fit_lognormal


def sorting(
    cube: xr.Dataset,
    event: Event,
    at: Mapping[str, Any] | None = None,
    *,
    measures: Sequence[str] = NAMES,
    confidence: float = 0.95,
) -> xr.Dataset:
    """How well each measure alone tells cells with the event from those without, best first, over ``measure``.

    `area`: the chance that of two such cells the one with the event has the larger measure (area under the receiver
    operating characteristic, Hanley and McNeil, Radiology 143, 1982): 1 sorts perfectly, .5 says nothing. `area_low`
    and `area_high` by the delete-one-motion jackknife, nan with few motions; `dispersion`: beta of the lognormal fit.
    Measures that the motions cannot have (Sa of stretched ones) are left out. Raises InputError where the event happens
    in all cells or in none.
    """
    cells, selection = chosen_cells(cube, at)
    outcome = happens(cells, event)
    rows = {}
    for name in measures:
        try:
            x, y, motion = pairs(intensity(cells, name), outcome)
        except InputError:
            continue
        if not 0.0 < y.sum() < y.size:
            share = "all" if y.size and y.all() else "none"
            raise InputError(f"'{event}' holds in {share} of the {y.size} cells: there is nothing to sort")
        rows[name] = (*_area_with_interval(x, y, motion, confidence), fit_lognormal(x, y, motion).dispersion[0])
    order = sorted(rows, key=lambda name: -rows[name][0])
    columns = np.array([rows[name] for name in order]).T
    names = ("area", "area_low", "area_high", "dispersion")
    return xr.Dataset(
        {name: ("measure", column) for name, column in zip(names, columns, strict=True)}, coords={"measure": order}
    ).assign_attrs(event=str(event), selection=selection, motions=cells.sizes[MOTION], confidence=confidence)


def area_under_curve(x: FloatArray, y: FloatArray) -> float:
    """Chance that a cell with y = 1 has a larger x than one with y = 0, ties counting half (Mann and Whitney)."""
    ones = float(y.sum())
    ranks = rankdata(x)[y == 1.0].sum()
    return float((ranks - ones * (ones + 1.0) / 2) / (ones * (y.size - ones)))


def _area_with_interval(
    x: FloatArray, y: FloatArray, motion: FloatArray, confidence: float
) -> tuple[float, float, float]:
    area = area_under_curve(x, y)
    names = np.unique(motion)
    kept = [motion != name for name in names]
    if names.size < FEWEST_MOTIONS or any(not 0.0 < y[k].sum() < y[k].size for k in kept):
        return area, np.nan, np.nan
    areas = np.array([area_under_curve(x[k], y[k]) for k in kept])
    spread = np.sqrt((names.size - 1) / names.size * np.sum((areas - areas.mean()) ** 2))
    half = float(student.ppf(0.5 + confidence / 2, names.size - 1) * spread)
    return area, max(area - half, 0.0), min(area + half, 1.0)
