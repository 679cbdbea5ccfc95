"""Which slice of a cube is meant: values of its axes by name, held against the grid, never guessed.

A value of an axis of numbers is a number in the axis's SI unit or a text with its unit (``pga="0.3 g"``); it must
lie on the grid, to the four digits that figures and messages print, unless the nearest one is asked for. An axis
left open takes its middle value, but for one of samples, of which none lies in the middle. Titles and `place` say
what was taken.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import Any

import numpy as np
import xarray as xr

from grids import samples
from grids.units import to_si
from models.errors import InputError
from models.errors import nearest as closest
from study.wording import title, unit_shown

SAMPLE = samples.NAME
INTENSITIES = ("pga", "motion_scale")
"""Axes along which the smallest value is sought."""
SAME = 5e-4
"""Relative distance within which two values print alike."""


def select(cube: xr.Dataset, at: Mapping[str, Any] | None, *, nearest: bool = False) -> xr.Dataset:
    """The cube at one value of each axis in ``at``; the others stay whole.

    Raises InputError for unknown axes and words, for numbers without a unit in a text, and for values off the
    grid (with their neighbours) unless the ``nearest`` will do.
    """
    return cube.isel({name: position(cube, name, value, nearest) for name, value in (at or {}).items()})


def on_grid(cube: xr.Dataset, at: Mapping[str, Any] | None, *, nearest: bool = False) -> dict[str, Any]:
    """The values of the grid that ``at`` means, by axis; errors as in `select`."""
    positions = {name: position(cube, name, value, nearest) for name, value in (at or {}).items()}
    return {name: cube[name].values[index] for name, index in positions.items()}


def complete(
    cube: xr.Dataset, at: Mapping[str, Any] | None, keep: Collection[str], *, nearest: bool = False
) -> dict[str, Any]:
    """The value on the grid of every axis that ``keep`` does not leave whole: as ``at`` says, else the middle one."""
    given = on_grid(cube, at, nearest=nearest)
    if both := [name for name in given if name in keep]:
        raise InputError(f"'{both[0]}' is shown over its whole range: leave it out of the selection")
    left = [str(d) for d, size in cube.sizes.items() if size > 1 and d not in given and d not in keep]
    if any(is_samples(cube, name) for name in left):
        raise InputError(
            f"axis '{SAMPLE}' holds {cube.sizes[SAMPLE]} equally likely walls, and this shows one: choose it, for "
            f"instance {SAMPLE}=0, or draw an overturning map or a fragility, which take all of them"
        )
    return given | {name: _middle(cube[name]) for name in left}


def _middle(axis: xr.DataArray) -> Any:
    """The middle value, in whatever order the axis has them; of words the one in the middle of the list."""
    values = np.sort(axis.values) if axis.dtype.kind in "iuf" else axis.values
    return values[values.size // 2]


def over_samples(cube: xr.Dataset, at: Mapping[str, Any] | None, shown: Collection[str]) -> list[str]:
    """The axis of samples, if all of it is asked for: neither shown nor selected."""
    return [str(d) for d in cube.dims if is_samples(cube, str(d)) and d not in {*shown, *(at or {})}]


def is_samples(cube: xr.Dataset, name: str) -> bool:
    """Whether an axis holds several equally likely walls (`grids.samples`)."""
    return name == SAMPLE and cube.sizes[name] > 1 and cube[name].attrs.get("comment") == samples.MEANING


def place(cube: xr.Dataset, at: Mapping[str, Any]) -> str:
    """What ``at`` takes of the cube, for a title or a line: the motion, and the value of every axis."""
    chosen = cube.isel({name: int(np.flatnonzero(cube[name].values == value)[0]) for name, value in at.items()})
    parts = [str(chosen["motion"].values.item())] if "motion" in chosen.coords and chosen["motion"].size == 1 else []
    for name, axis in chosen.coords.items():
        is_axis = axis.attrs.get("axis_of_study") == "true"
        if is_axis and name != "motion" and axis.size == 1:
            parts.append(f"{title(str(name))} {value_shown(axis, axis.values.ravel()[0])}")
    return ", ".join(parts)


def value_shown(axis: xr.DataArray, value: Any) -> str:
    """A value of an axis with its unit, as figures print it."""
    if axis.dtype.kind not in "iuf":
        return str(value)
    factor, unit = unit_shown(str(axis.attrs.get("units", "1")))
    return f"{factor * value:.4g}" + ("" if unit == "1" else f" {unit}")


def check_axis(cube: xr.Dataset, name: str) -> None:
    """Refuse what is no axis of the cube."""
    if name not in cube.dims:
        raise InputError(f"'{name}' is no axis of this cube: {closest(name, map(str, cube.dims))}")


def position(cube: xr.Dataset, name: str, value: Any, nearest: bool = False) -> int:
    """Index along the axis ``name`` of a value as a user gives it; see `select`."""
    check_axis(cube, name)
    axis = cube[name]
    if axis.dtype.kind not in "iuf":
        words = [str(word) for word in axis.values]
        if str(value) not in words:
            raise InputError(f"axis '{name}' has no '{value}': {closest(str(value), words)}")
        return words.index(str(value))
    wanted = _number(axis, name, value)
    same = np.flatnonzero(axis.values == wanted)
    if same.size:  # inf too, from which nothing has a distance
        return int(same[0])
    index = int(np.argmin(np.abs(axis.values - wanted)))
    near = nearest or abs(axis.values[index] - wanted) <= SAME * abs(wanted)
    if math.isinf(wanted) or not near:
        raise InputError(f"{name} = {value_shown(axis, wanted)} is not on the grid: {_neighbours(axis, wanted)}")
    if nearest and (end := _end_short_of(axis.values, wanted)) is not None:
        raise InputError(
            f"{name} = {value_shown(axis, wanted)} is not on the grid, nor near its end at {value_shown(axis, end)}: "
            "give a value of the grid"
        )
    return index


def _number(axis: xr.DataArray, name: str, value: Any) -> float:
    unit = str(axis.attrs.get("units", "1"))
    if not isinstance(value, int | float | str | np.number) or isinstance(value, bool):
        raise InputError(f"axis '{name}' needs a number in {unit} or a text with its unit, not {value!r}")
    if isinstance(value, str) and unit != "1" and lacks_unit(value):
        shown = unit_shown(unit)[1]
        raise InputError(
            f"{name}={value} has no unit: write {name}='{value} {shown}' or another unit of {unit}; "
            f"the axis goes from {value_shown(axis, axis.values.min())} to {value_shown(axis, axis.values.max())}"
        )
    return to_si(value if isinstance(value, str) else float(value), unit, name)


def lacks_unit(text: str) -> bool:
    """Whether a text is a number alone."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def _end_short_of(values: np.ndarray[tuple[int], np.dtype[np.float64]], wanted: float) -> float | None:
    """The end of the grid that a value lies farther beyond than its largest step; None where it does not."""
    low, high = float(values.min()), float(values.max())
    step = np.max(np.diff(np.sort(values))) if values.size > 1 else SAME * abs(wanted)
    if low - wanted > step:
        return low
    return high if wanted - high > step else None


def _neighbours(axis: xr.DataArray, wanted: float) -> str:
    below, above = axis.values[axis.values < wanted], axis.values[axis.values > wanted]
    if not below.size or not above.size:
        low, high = value_shown(axis, axis.values.min()), value_shown(axis, axis.values.max())
        else_nearest = "" if math.isinf(wanted) else ", or ask for the nearest"
        return f"it goes from {low} to {high}; give a value of it{else_nearest}"
    two = f"{value_shown(axis, below.max())} and {value_shown(axis, above.min())}"
    return f"its neighbours are {two}; give one of them, or ask for the nearest"
