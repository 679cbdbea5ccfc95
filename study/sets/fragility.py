"""Fragility: how often an event happens, over a measure of the motion."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from scipy.stats import beta

from models.base import FloatArray
from study.sets.cells import Event, chosen_cells, happens, intensity, pairs
from study.sets.lognormal import Lognormal, fit_lognormal

BINS = 10
POINTS = 200


def fragility(
    cube: xr.Dataset,
    event: Event,
    measure: str = "pga",
    at: Mapping[str, Any] | None = None,
    over: str | None = None,
    *,
    confidence: float = 0.95,
) -> xr.Dataset:
    """Empirical and lognormal fragility of an event over a measure of the motion, for each value of ``over``.

    Over ``level`` (200 intensities): `probability` of the lognormal fit with `probability_low`, `_high`; scalars
    `median` and `dispersion` with `_low`, `_high` (see `study.sets.lognormal`). Over ``bin``: `share` of the cells in
    which the event happens, with its Clopper-Pearson interval for as many trials as there are motions in the bin, at
    the mean `strength` of its cells; a bin is a value of the cube's own intensity axis, or a tenth of the cells.
    `cells` counts those with a valid answer, `unknown` the others. ``why`` names what cannot be fitted; its numbers are
    nan.

    Raises InputError without an axis `motion`, and for unknown names and values off the grid.
    """
    cells, selection = chosen_cells(cube, at, over)
    strength, outcome = intensity(cells, measure), happens(cells, event)
    parts = []
    known = strength.values[np.isfinite(outcome.values) & (strength.values > 0.0)]
    levels = np.geomspace(known.min(), known.max(), POINTS) if known.size else np.full(POINTS, np.nan)
    for k in range(cells.sizes[over] if over else 1):
        of = {over: k} if over else {}
        x, y, motion = pairs(strength.isel(of), outcome.isel(of))
        fit = fit_lognormal(x, y, motion, confidence)
        on_axis = measure in cells.dims
        parts.append(_curve(fit, levels, _bins(x, y, motion, on_axis, confidence)))
        parts[-1]["cells"] = ((), x.size)
        parts[-1]["unknown"] = ((), int(outcome.isel(of).size - x.size))
        parts[-1]["why"] = ((), fit.why)
    found = (
        xr.concat(parts, cells[over], data_vars="all", coords="minimal", compat="override", join="outer")
        if over
        else parts[0]
    )
    found["level"].attrs = found["strength"].attrs = dict(strength.attrs)
    found["median"].attrs["units"] = strength.attrs["units"]
    return found.assign_attrs(
        event=str(event), measure=measure, selection=selection, confidence=confidence, motions=cells.sizes["motion"]
    )


def _curve(fit: Lognormal, levels: FloatArray, bins: dict[str, FloatArray]) -> xr.Dataset:
    values: dict[str, Any] = {}
    for name, triple in (("median", fit.median), ("dispersion", fit.dispersion)):
        values |= {f"{name}{end}": ((), v) for end, v in zip(("", "_low", "_high"), triple, strict=True)}
    curve = fit.probability(levels)
    values |= {f"probability{end}": ("level", v) for end, v in zip(("", "_low", "_high"), curve, strict=True)}
    values |= {name: ("bin", v) for name, v in bins.items()}
    return xr.Dataset(values, coords={"level": levels, "bin": np.arange(bins["share"].size)})


def _bins(x: FloatArray, y: FloatArray, motion: FloatArray, on_axis: bool, confidence: float) -> dict[str, FloatArray]:
    """Shares with intervals in groups of cells, in the order of intensity."""
    order = np.argsort(x, kind="stable")
    groups = np.split(order, np.flatnonzero(np.diff(x[order])) + 1) if on_axis else np.array_split(order, BINS)
    groups = [group for group in groups if group.size]
    share = np.array([y[group].mean() for group in groups])
    trials = np.array([np.unique(motion[group]).size for group in groups], dtype=float)
    low, high = binomial_interval(share * trials, trials, confidence)
    strength = np.array([x[group].mean() for group in groups])
    return {"strength": strength, "share": share, "share_low": low, "share_high": high}


def binomial_interval(
    successes: FloatArray, trials: FloatArray, confidence: float = 0.95
) -> tuple[FloatArray, FloatArray]:
    """Clopper and Pearson's interval (Biometrika 26, 1934) of a share; successes need not be whole."""
    tail = (1.0 - confidence) / 2
    low = beta.ppf(tail, successes, trials - successes + 1.0)
    high = beta.ppf(1.0 - tail, successes + 1.0, trials - successes)
    return np.where(successes <= 0.0, 0.0, low), np.where(successes >= trials, 1.0, high)
