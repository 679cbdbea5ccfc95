"""Rocking spectra and overturning acceleration spectra over the frequency parameter p of a wall.

A cube is such a spectrum where one of its axes changes p = sqrt(M g R/I_O) and nothing that matters besides: blocks of
one slenderness and several heights. PGA is held against the onset acceleration g tan(alpha) (Zhang and Makris, J. Eng.
Mech. 127, 2001).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from models.errors import InputError
from study.selection import SAME, complete, place, select
from study.sets.cells import MOTION, given
from study.sets.incremental import QUANTILES
from study.status import OVERTURNED, ROCKING, UNKNOWN

P, ONSET = "frequency_parameter", "onset_acceleration"


def axis_of_p(cube: xr.Dataset) -> str:
    """The one axis along which p changes. Raises InputError when there is none, or more than one."""
    if P not in cube.coords:
        raise InputError(
            f"a rocking spectrum needs {P}, which model '{cube.attrs.get('model')}' does not have: use housner"
        )
    axes = [str(dim) for dim in cube[P].dims if cube.sizes[dim] > 1]
    if len(axes) != 1:
        changes = f"it changes along {', '.join(axes)}" if axes else "it is the same in all cells"
        raise InputError(f"{P} must change along one axis, here {changes}: vary the height at a fixed aspect_ratio")
    onset = cube[ONSET]
    if axes[0] in onset.dims and bool((onset.max(axes[0]) > (1.0 + SAME) * onset.min(axes[0])).any()):
        raise InputError(f"{ONSET} changes along {axes[0]} too: vary the height at a fixed aspect_ratio")
    return axes[0]


def rocking_spectrum(cube: xr.Dataset, at: Mapping[str, Any] | None = None) -> xr.Dataset:
    """Largest rotation over the slenderness angle against p, `peak_rotation_ratio` over (motion, p's axis).

    (Makris and Konstantinidis, Earthq. Eng. Struct. Dyn. 32, 2003.) Overturned walls are infinite, unanswered ones nan;
    an axis of intensity takes its selected or middle value. Coordinates: p (s-1) and 2 pi/p (s).
    """
    if "peak_rotation_ratio" not in cube.data_vars:
        raise InputError("a rocking spectrum needs the output peak_rotation_ratio: add it to [outputs]")
    along = axis_of_p(cube)
    cells, selection = _taken(cube, at, (along,))
    values = cells["peak_rotation_ratio"].where(cells["status"] != OVERTURNED, np.inf)
    values = values.where(~cells["status"].isin(UNKNOWN)).assign_attrs(cube["peak_rotation_ratio"].attrs)
    return _with_p(xr.Dataset({"peak_rotation_ratio": values}), cells, along, selection)


def overturning_spectrum(cube: xr.Dataset, at: Mapping[str, Any] | None = None) -> xr.Dataset:
    """PGA over onset acceleration against p: what overturns (1), stands (0) or is unknown (nan), by motion.

    `overturns` and `rocks` over (motion, p's axis, pga); `smallest` over (motion, p's axis): the smallest ratio of the
    grid that overturns (inf: none; nan: a smaller one is unknown); `quantile_curves` of it over the motions;
    `onset_ratio` over (p's axis, pga): PGA/(g tan(alpha)). `t_impulse` and `t_moment` (s) by motion: PGV/PGA and
    sqrt(PGD/PGA), for `three_curves`. Needs an axis pga.
    """
    if "pga" not in cube.dims or cube.sizes["pga"] < 2:
        raise InputError("an overturning acceleration spectrum needs an axis pga: add it to [axes]")
    along = axis_of_p(cube)
    cells, selection = _taken(cube.sortby("pga"), at, (along, "pga"))
    known = ~cells["status"].isin(UNKNOWN)
    overturns = (cells["status"] == OVERTURNED).astype(float).where(known)
    ratio = (cells["pga"] / cells[ONSET]).broadcast_like(overturns.isel({MOTION: 0}, drop=True))
    hit = overturns != 0.0
    first = hit.argmax("pga")
    smallest = ratio.broadcast_like(overturns).isel(pga=first).where(overturns.isel(pga=first) == 1.0)
    smallest = smallest.where(hit.any("pga"), np.inf).drop_vars("pga")
    found = xr.Dataset(
        {
            "overturns": overturns,
            "rocks": cells["status"].isin((ROCKING, OVERTURNED)).astype(float).where(known),
            "onset_ratio": ratio.transpose(along, "pga"),
            "smallest": smallest.transpose(MOTION, along),
            "t_impulse": cells["record_velocity_range"] / cells["record_pga"],
            "t_moment": np.sqrt(cells["record_displacement_range"] / cells["record_pga"]),
        }
    )
    stretch = given(cells, "time_scale")
    if stretch is not None:  # both times are those of the motion as it shook the blocks
        found["t_impulse"], found["t_moment"] = found["t_impulse"] * stretch, found["t_moment"] * stretch
    rows = found["smallest"].values
    curves = np.quantile(rows, QUANTILES, axis=0, method="inverted_cdf")
    found["quantile_curves"] = (("quantile", along), np.where(np.isnan(rows).any(axis=0), np.nan, curves))
    return _with_p(found.assign_coords(quantile=list(QUANTILES)), cells, along, selection)


def three_curves(p: xr.DataArray, t_impulse: xr.DataArray, t_moment: xr.DataArray) -> dict[str, xr.DataArray]:
    """PGA over onset acceleration below which a block stands, by three curves: 1, 1/(p t_I), 1/(p t_M)^2.

    The three powers of p are those of the simplified overturning acceleration spectrum (Towards physically justified,
    site-specific overturning acceleration response spectra, SSRN 6181908, 2026): no rocking, overturning without
    impact, overturning after one. Its abstract gives the powers, not how t_I and t_M are read off a record. Here they
    follow from the linear block for p t -> 0, where gravity has no time to act: an impulse PGA t_I turns it over at p
    t_I PGA/(alpha g) = 1, opposite impulses whose moment is PGA t_M^2 carry it to alpha at (p t_M)^2 PGA/(alpha g) = 1.
    So PGA t_I is the range of the velocity, which is the largest impulse of any interval, PGA t_M^2 that of the
    displacement.
    """
    return {
        "no rocking": xr.ones_like(p * t_impulse),
        "without impact": 1.0 / (p * t_impulse),
        "after one impact": 1.0 / (p * t_moment) ** 2,
    }


def _taken(cube: xr.Dataset, at: Mapping[str, Any] | None, keep: tuple[str, ...]) -> tuple[xr.Dataset, str]:
    """The cells over motion (an axis of one where the cube has none) and ``keep``."""
    if MOTION not in cube.dims:
        if MOTION in cube.coords and cube[MOTION].ndim:
            raise InputError(f"the motion changes along '{cube[MOTION].dims[0]}': make it an axis of its own, motion")
        cube = cube.expand_dims(MOTION)
        cube = cube.assign_coords(
            {n: c.expand_dims(MOTION) for n, c in cube.coords.items() if str(n).startswith("record_")}
        )
    taken = complete(cube, at, (MOTION, *keep))
    cells = select(cube, taken)
    cells = cells.squeeze([dim for dim in cells.dims if dim not in (MOTION, *keep)])
    return cells.transpose(MOTION, *keep), place(cube, taken)


def _with_p(found: xr.Dataset, cells: xr.Dataset, along: str, selection: str) -> xr.Dataset:
    p = cells[P].squeeze()
    period = (2.0 * np.pi / p).assign_attrs(units="s", long_name="2 pi/p")
    return found.assign_coords({P: p, "period_parameter": period}).assign_attrs(along=along, selection=selection)
