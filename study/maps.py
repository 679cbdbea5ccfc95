"""Maps over two axes of a cube: what overturns, what starts to rock, and at which intensity.

A cell whose run is missing, failed or not converged is unknown; a smallest intensity is given only
where every lower one is known, for overturning is not monotone.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

import models
from models.errors import InputError, nearest
from study.status import OVERTURNED, ROCKING, UNKNOWN
from study.wording import title, unit_shown

INTENSITIES = ("pga", "motion_scale")
"""Axes along which the smallest value is sought."""


def overturning_map(cube: xr.Dataset, x: str, y: str, at: Mapping[str, Any] | None = None) -> xr.DataArray:
    """Overturned (1), stands (0) or unknown (nan) over ``x`` and ``y`` if one of them is the intensity
    axis (or there is none left), else the smallest intensity of the grid that overturns (nan: none does).

    ``at`` selects the other axes, nearest value (``{"restitution": 0.9}``; SI units); the result
    has dimensions ``(y, x)``. Raises InputError for unknown axes and for axes left open.
    """
    return _map(cube, x, y, at, (OVERTURNED,), "overturned", "overturns the wall")


def onset_map(cube: xr.Dataset, x: str, y: str, at: Mapping[str, Any] | None = None) -> xr.DataArray:
    """Uplift (1), none (0) or unknown (nan), or the smallest intensity of the grid at which uplift occurs.

    Axes, selection and dimensions as in `overturning_map`.
    """
    return _map(cube, x, y, at, (ROCKING, OVERTURNED), "uplift", "makes it rock")


def slices(cube: xr.Dataset, output: str, x: str, at: Mapping[str, Any] | None = None) -> xr.DataArray:
    """One output over ``x``, with at most one more dimension (one curve a value).

    Raises InputError for unknown names and when more than one other axis is left open.
    """
    if output not in cube.data_vars:
        raise InputError(f"'{output}' is no output of this cube: {nearest(output, map(str, cube.data_vars))}")
    _check_axis(cube, x)
    chosen = select(cube, at)[output]
    others = [str(dim) for dim in chosen.dims if dim != x and chosen.sizes[dim] > 1]
    if x not in chosen.dims:
        raise InputError(f"'{x}' is the abscissa: leave it out of the selection")
    if len(others) > 1:
        raise InputError(f"{', '.join(others)} are open: select all but one, for instance {_example(cube, others)}")
    place = _place(select(cube, at), (x, *others))
    curves = chosen.squeeze([d for d in chosen.dims if d not in (x, *others)]).transpose(*others, x)
    return curves.assign_attrs(selection=place)


def output_map(cube: xr.Dataset, output: str, x: str, y: str, at: Mapping[str, Any] | None = None) -> xr.DataArray:
    """The values of one output over ``x`` and ``y``, dimensions ``(y, x)``; nan where unknown.

    ``at`` selects all other axes, as in `overturning_map`. Raises InputError for unknown names and for axes
    left open.
    """
    if output not in cube.data_vars:
        raise InputError(f"'{output}' is no output of this cube: {nearest(output, map(str, cube.data_vars))}")
    _check_axes(cube, x, y, at)
    chosen = select(cube, at)
    known = chosen[output].where(~chosen["status"].isin(UNKNOWN))
    left = [str(dim) for dim in known.dims if dim not in (x, y) and known.sizes[dim] > 1]
    if left:
        raise InputError(f"{', '.join(left)} must be selected for a map, for instance {_example(cube, left)}")
    result = known.squeeze([dim for dim in known.dims if dim not in (x, y)]).transpose(y, x)
    return result.assign_attrs(cube[output].attrs, selection=_place(chosen, (x, y)))


def select(cube: xr.Dataset, at: Mapping[str, Any] | None) -> xr.Dataset:
    """The cube at the nearest value of each number axis, at the word or record of the others."""
    for name, value in (at or {}).items():
        _check_axis(cube, name)
        numbers = cube[name].dtype.kind in "iuf"
        if not numbers and value not in cube[name].values:
            words = map(str, cube[name].values)
            raise InputError(f"axis '{name}' has no '{value}': {nearest(str(value), words)}")
        if numbers and not isinstance(value, int | float | np.number):
            raise InputError(f"axis '{name}' needs a number in {cube[name].attrs['units']}, not {value!r}")
        index = int(np.argmin(np.abs(cube[name].values - value))) if numbers else value
        cube = cube.isel({name: index}) if numbers else cube.sel({name: index})
    return cube


def default_axes(cube: xr.Dataset, x: str | None, y: str | None) -> tuple[str, str]:
    """``x`` and ``y``, or the first axes longer than one that are no intensity; then the intensity."""
    long = [str(dim) for dim, size in cube.sizes.items() if size > 1]
    free = [*(d for d in long if d not in INTENSITIES), *(d for d in long if d in INTENSITIES)]
    x = x or next((d for d in free if d != y), None)
    y = y or next((d for d in free if d != x), None)
    if x is None or y is None:
        raise InputError(f"a map needs two axes with several values, this cube has {len(long)}: draw slices")
    return x, y


def middle(cube: xr.Dataset, keep: tuple[str, ...], *, intensity: bool = False) -> dict[str, Any]:
    """The middle value of every axis longer than one that is not in ``keep``; of the intensity only if asked for."""
    kept = keep if intensity else (*keep, *_searched(cube, keep))
    return {str(dim): cube[dim].values[size // 2] for dim, size in cube.sizes.items() if dim not in kept and size > 1}


def _place(chosen: xr.Dataset, kept: tuple[str, ...]) -> str:
    """What was selected, for a title: the record and the value of each axis that is gone."""
    parts = [str(chosen["motion"].values)] if "motion" in chosen and chosen["motion"].size == 1 else []
    for name, axis in chosen["status"].coords.items():
        is_axis = axis.attrs.get("axis_of_study") == "true"
        if is_axis and name not in (*kept, "motion") and axis.size == 1:
            value, (factor, unit) = axis.values.ravel()[0], unit_shown(axis.attrs["units"])
            number = f"{factor * value:.4g}" if axis.dtype.kind in "iuf" else str(value)
            parts.append(f"{title(str(name))} {number}" + ("" if unit == "1" else f" {unit}"))
    return ", ".join(parts)


def _check_axis(cube: xr.Dataset, name: str) -> None:
    if name not in cube.dims:
        raise InputError(f"'{name}' is no axis of this cube: {nearest(name, map(str, cube.dims))}")


def _check_axes(cube: xr.Dataset, x: str, y: str, at: Mapping[str, Any] | None) -> None:
    for axis in (x, y):
        _check_axis(cube, axis)
        if axis in (at or {}):
            raise InputError(f"'{axis}' is an axis of the map: leave it out of the selection")
    if x == y:
        raise InputError(f"x and y are both '{x}': choose two axes")


def _check_overturns(cube: xr.Dataset) -> None:
    """Refuse the cube of a model in which nothing rocks or overturns."""
    name = cube.attrs.get("model")
    if name in models.MODELS and all(q.name != "overturned" for q in models.get(name).outputs):
        known = [str(output) for output in cube.data_vars if output != "status"]
        raise InputError(
            f"model '{name}' neither rocks nor overturns, so its cube has no such map; draw an output instead: "
            f"output_map, or 'rocking map --output {known[0] if known else 'NAME'}'"
        )


def _example(cube: xr.Dataset, names: list[str]) -> str:
    value = cube[names[0]].values[0]
    return f"{names[0]}={value:.6g}" if isinstance(value, float) else f"{names[0]}={value}"


def _map(
    cube: xr.Dataset,
    x: str,
    y: str,
    at: Mapping[str, Any] | None,
    flags: tuple[int, ...],
    name: str,
    verb: str,
) -> xr.DataArray:
    _check_overturns(cube)
    _check_axes(cube, x, y, at)
    chosen = select(cube, at)
    status = chosen["status"]
    # a single intensity is no grid to search: then the map says yes or no
    searched = _searched(chosen, (x, y))
    along = searched[0] if searched else None
    left = [str(dim) for dim in status.dims if dim not in (x, y, along) and status.sizes[dim] > 1]
    if left:
        raise InputError(f"{', '.join(left)} must be selected for a map, for instance {_example(cube, left)}")
    status = status.squeeze([dim for dim in status.dims if dim not in (x, y, along)])
    happens = status.isin(flags).astype(float).where(~status.isin(UNKNOWN))
    if along is None:
        result = happens.transpose(y, x)
        result.attrs = {"units": "1", "long_name": name, "comment": "1: yes, 0: no, nan: unknown"}
        result.attrs["selection"] = _place(chosen, (x, y))
        return result.rename(name)
    result = _smallest(happens, along).transpose(y, x)
    result.attrs = {
        "units": cube[along].attrs["units"],
        "long_name": f"smallest {along} of the grid that {verb}",
        "comment": "nan: no value of the grid does, or the outcome at a lower one is unknown",
        "selection": _place(chosen, (x, y, along)),
        "smallest": float(cube[along].min()),
        "largest": float(cube[along].max()),
    }
    return result.rename(f"{along}_{name}")


def _searched(cube: xr.Dataset, kept: tuple[str, ...]) -> list[str]:
    """The intensity axis along which a smallest value can be sought, if there is one."""
    return [i for i in INTENSITIES if cube.sizes.get(i, 1) > 1 and i not in kept][:1]


def _smallest(happens: xr.DataArray, along: str) -> xr.DataArray:
    """Smallest coordinate with 1, nan where none or where an unknown comes before it."""
    ordered = happens.sortby(along)
    hit = ordered != 0.0  # a 1 or an unknown
    first = hit.argmax(along)
    found = hit.any(along) & (ordered.isel({along: first}) == 1.0)
    return ordered[along].isel({along: first}).where(found).drop_vars(along)
