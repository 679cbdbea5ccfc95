"""Incremental dynamic analysis: how an output grows with the intensity, motion by motion, and its quantiles."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from models.base import FloatArray
from models.errors import InputError
from models.errors import nearest as closest
from study.selection import INTENSITIES
from study.sets.cells import MOTION, chosen_cells, intensity
from study.status import OVERTURNED, UNKNOWN

QUANTILES = (0.16, 0.5, 0.84)
LEVELS = 60


def incremental(
    cube: xr.Dataset,
    output: str,
    measure: str = "pga",
    at: Mapping[str, Any] | None = None,
    *,
    quantiles: tuple[float, ...] = QUANTILES,
) -> xr.Dataset:
    """Curves of an output over a measure (Vamvatsikos and Cornell, Earthq. Eng. Struct. Dyn. 31, 2002).

    `strength` and the output itself over motion and the cube's intensity axis, overturned cells infinite, cells without
    a valid answer nan; `quantile_curves` over ``quantile`` and ``level``: quantiles over the motions at one intensity,
    between the steps of a motion linear in the logarithm, infinite where it overturns at the next step; only within the
    range that every motion reaches. Raises InputError for a cube without axes of motion and intensity.
    """
    if output not in cube.data_vars or output in ("status", "overturned"):
        known = [str(name) for name in cube.data_vars if name not in ("status", "overturned")]
        raise InputError(f"'{output}' is no output that grows with the intensity: {closest(output, known)}")
    cells, selection = chosen_cells(cube, at)
    scale = next((d for d in INTENSITIES if d in cells.dims), None)
    if scale is None:
        raise InputError("incremental dynamic analysis needs an axis pga or motion_scale: add it to [axes]")
    cells = cells.sortby(scale).isel({scale: np.sort(cells[scale].values) > 0.0})  # without shaking nothing grows
    if cells.sizes[scale] < 2:
        raise InputError(f"incremental dynamic analysis needs two values of {scale} above zero: add one to [axes]")
    strength = intensity(cells, measure)
    if bool((strength.isel({scale: 0}) == strength.isel({scale: -1})).any()):
        raise InputError(f"{measure} does not grow when a motion is scaled: take pga, pgv or another that does")
    values = cells[output].where(cells["status"] != OVERTURNED, np.inf).where(~cells["status"].isin(UNKNOWN))
    low, high = float(strength.isel({scale: 0}).max()), float(strength.isel({scale: -1}).min())
    levels = strength.values[0] if measure == scale else np.geomspace(low, high, LEVELS) if low < high else np.array([])
    rows = np.array([_at(levels, x, y) for x, y in zip(strength.values, values.values, strict=True)])
    found = xr.Dataset(
        {
            "strength": strength,
            output: values.assign_attrs(cube[output].attrs),
            "quantile_curves": (("quantile", "level"), _quantiles(rows, quantiles)),
            "overturned_share": ("level", np.isinf(rows).mean(axis=0)),
        },
        coords={"quantile": list(quantiles), "level": levels},
    )
    found["level"].attrs = dict(strength.attrs)
    return found.assign_attrs(output=output, measure=measure, selection=selection, motions=cells.sizes[MOTION])


def _at(levels: FloatArray, x: FloatArray, y: FloatArray) -> FloatArray:
    """The curve of one motion at ``levels``: linear in ln x between its steps, exact on them."""
    right = np.clip(np.searchsorted(x, levels), 1, x.size - 1)
    share = np.log(levels / x[right - 1]) / np.log(x[right] / x[right - 1])
    low, high = y[right - 1], y[right]
    with np.errstate(invalid="ignore"):
        between = low + share * (high - low)
    between = np.where(np.isinf(low) | np.isinf(high), np.inf, between)
    return np.where(share == 0.0, low, np.where(share == 1.0, high, between))


def _quantiles(rows: FloatArray, quantiles: tuple[float, ...]) -> FloatArray:
    """Quantiles over the motions by order statistics, infinite values included; nan where one is unknown."""
    if not rows.size:
        return np.empty((len(quantiles), rows.shape[1]))
    found = np.quantile(rows, quantiles, axis=0, method="inverted_cdf")
    return np.where(np.isnan(rows).any(axis=0), np.nan, found)
