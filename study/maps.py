"""Maps over two axes of a cube: what overturns, what starts to rock, and at which intensity.

A cell without a valid answer (not run, outside the model, not converged, failed) is unknown; a smallest intensity is
given only where every lower one is known, for overturning is not monotone. ``at`` selects values of the other axes
as in `study.selection`, ``nearest`` what lies nearest to them; axes left open take their middle value. Of an axis of
samples left open a map has the share of the samples: the chance, as far as the wall is known.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import xarray as xr

import models
from models.errors import InputError
from models.errors import nearest as closest
from study.selection import INTENSITIES, SAMPLE, check_axis, complete, is_samples, over_samples, place, select
from study.status import OVERTURNED, ROCKING, UNKNOWN

At = Mapping[str, Any]


def overturning_map(
    cube: xr.Dataset, x: str | None = None, y: str | None = None, at: At | None = None, *, nearest: bool = False
) -> xr.DataArray:
    """Overturned (1), stands (0) or unknown (nan) over ``x`` and ``y`` if one of them is the intensity axis (or
    there is none left), else the smallest intensity of the grid that overturns (nan: none does). Over an axis of
    samples: the share of them that overturns, or the smallest intensity that overturns at least half.

    ``x`` and ``y`` default as in `default_axes`; the result has dimensions ``(y, x)``. Raises InputError for
    unknown axes and for values off the grid.
    """
    return _map(cube, x, y, at, nearest, (OVERTURNED,), "overturned", "overturns {}")


def onset_map(
    cube: xr.Dataset, x: str | None = None, y: str | None = None, at: At | None = None, *, nearest: bool = False
) -> xr.DataArray:
    """Uplift (1), none (0) or unknown (nan), or the smallest intensity of the grid at which uplift occurs.

    Axes, selection and dimensions as in `overturning_map`.
    """
    return _map(cube, x, y, at, nearest, (ROCKING, OVERTURNED), "uplift", "makes {} rock")


def output_map(
    cube: xr.Dataset,
    output: str,
    x: str | None = None,
    y: str | None = None,
    at: At | None = None,
    *,
    nearest: bool = False,
) -> xr.DataArray:
    """The values of one output over ``x`` and ``y``, dimensions ``(y, x)``; nan where unknown.

    Axes and selection as in `overturning_map`, the intensity selected like any other axis.
    """
    _check_output(cube, output)
    x, y = default_axes(cube, x, y, at)
    taken = complete(cube, at, (x, y), nearest=nearest)
    chosen = select(cube, taken)
    known = _over(chosen[output].where(~chosen["status"].isin(UNKNOWN)), x, y).compute()
    return known.assign_attrs(cube[output].attrs, selection=place(cube, taken))


def status_map(cube: xr.Dataset, x: str | None = None, y: str | None = None, at: At | None = None) -> xr.DataArray:
    """The flags of ``status`` over ``x`` and ``y``, dimensions ``(y, x)``; axes and selection as in `output_map`."""
    x, y = default_axes(cube, x, y, at)
    return _over(select(cube, complete(cube, at, (x, y)))["status"], x, y).compute()


def _over(values: xr.DataArray, x: str, y: str) -> xr.DataArray:
    return values.squeeze([dim for dim in values.dims if dim not in (x, y)]).transpose(y, x)


def slices(cube: xr.Dataset, output: str, x: str, at: At | None = None, *, nearest: bool = False) -> xr.DataArray:
    """One output over ``x``, with at most one more dimension (one curve a value): the first axis left open.

    Raises InputError for unknown names and for values off the grid.
    """
    _check_output(cube, output)
    check_axis(cube, x)
    free = [str(d) for d, size in cube.sizes.items() if size > 1 and d != x and d not in (at or {})]
    others = [name for name in free if not is_samples(cube, name)][:1]
    taken = complete(cube, at, (x, *others), nearest=nearest)
    chosen = select(cube, taken)[output].compute()
    curves = chosen.squeeze([d for d in chosen.dims if d not in (x, *others)]).transpose(*others, x)
    return curves.assign_attrs(selection=place(cube, taken))


def default_axes(
    cube: xr.Dataset, x: str | None, y: str | None, at: Mapping[str, Any] | None = None
) -> tuple[str, str]:
    """``x`` and ``y``, or the first axes longer than one that are no intensity; then the intensity. None of ``at``."""
    for axis in (x, y):
        if axis is not None:
            check_axis(cube, axis)
    long = [str(dim) for dim, size in cube.sizes.items() if size > 1]
    long = [name for name in long if name in (x, y) or not is_samples(cube, name)]
    open_ones = [d for d in long if d not in (at or {})]
    free = [*(d for d in open_ones if d not in INTENSITIES), *(d for d in open_ones if d in INTENSITIES)]
    x = x or next((d for d in free if d != y), None)
    y = y or next((d for d in free if d != x), None)
    if x is None or y is None:
        raise InputError(f"a map needs two axes with several values, this cube has {len(open_ones)}: draw slices")
    if x == y:
        raise InputError(f"x and y are both '{x}': choose two axes")
    return x, y


def _check_output(cube: xr.Dataset, output: str) -> None:
    if output not in cube.data_vars:
        raise InputError(f"'{output}' is no output of this cube: {closest(output, map(str, cube.data_vars))}")


def _check_overturns(cube: xr.Dataset) -> None:
    """Refuse the cube of a model in which nothing rocks or overturns."""
    name = cube.attrs.get("model")
    if name in models.MODELS and all(q.name != "overturned" for q in models.get(name).outputs):
        known = [str(output) for output in cube.data_vars if output != "status"]
        raise InputError(
            f"model '{name}' neither rocks nor overturns, so its cube has no such map; draw an output instead: "
            f"output_map, or 'rocking map --output {known[0] if known else 'NAME'}'"
        )


def _map(
    cube: xr.Dataset,
    x: str | None,
    y: str | None,
    at: At | None,
    nearest: bool,
    flags: tuple[int, ...],
    name: str,
    verb: str,
) -> xr.DataArray:
    _check_overturns(cube)
    x, y = default_axes(cube, x, y, at)
    # a single intensity is no grid to search: then the map says yes or no
    searched = [i for i in INTENSITIES if cube.sizes.get(i, 1) > 1 and i not in (x, y, *(at or {}))][:1]
    among = over_samples(cube, at, (x, y))
    taken = complete(cube, at, (x, y, *searched, *among), nearest=nearest)
    status = select(cube, taken)["status"].compute()
    status = status.squeeze([dim for dim in status.dims if dim not in (x, y, *searched, *among)])
    happens = status.isin(flags).astype(float).where(~status.isin(UNKNOWN))
    if among and not searched:
        result = happens.mean(SAMPLE).transpose(y, x)
        result.attrs = {
            "units": "1",
            "long_name": f"share of the samples: {name}",
            "comment": "of the samples with a valid answer; nan: none has one",
            "selection": f"{place(cube, taken)}, {cube.sizes[SAMPLE]} samples".removeprefix(", "),
        }
        return result.rename(f"{name}_share")
    if among:
        happens = _of_most(happens)
    if not searched:
        result = happens.transpose(y, x)
        result.attrs = {"units": "1", "long_name": name, "comment": "1: yes, 0: no, nan: unknown"}
        result.attrs["selection"] = place(cube, taken)
        return result.rename(name)
    (along,) = searched
    result = _smallest(happens, along).transpose(y, x)
    result.attrs = {
        "units": cube[along].attrs["units"],
        "long_name": f"smallest {along} of the grid that {verb.format('half of the samples' if among else 'the wall')}",
        "comment": "nan: no value of the grid does, or, where the coordinate unknown is true, the outcome at a lower "
        "one is unknown",
        "selection": place(cube, taken),
        "smallest": float(cube[along].min()),
        "largest": float(cube[along].max()),
    }
    return result.rename(f"{along}_{name}")


def _of_most(happens: xr.DataArray) -> xr.DataArray:
    """1 where it happens to at least half of the samples, 0 where not, nan where those without an answer decide."""
    least, most = happens.fillna(0.0).mean(SAMPLE), happens.fillna(1.0).mean(SAMPLE)
    return (least >= 0.5).astype(float).where((least >= 0.5) == (most >= 0.5))


def _smallest(happens: xr.DataArray, along: str) -> xr.DataArray:
    """Smallest coordinate with 1, nan where none or (``unknown`` true) where an unknown comes before it."""
    ordered = happens.sortby(along)
    hit = ordered != 0.0  # a 1 or an unknown
    first = hit.argmax(along)
    found = hit.any(along) & (ordered.isel({along: first}) == 1.0)
    smallest = ordered[along].isel({along: first}).where(found).drop_vars(along)
    return smallest.assign_coords(unknown=(hit.any(along) & ~found).drop_vars(along, errors="ignore"))
