"""From a cube of a design to the sensitivity of its outputs, for each motion and for the set."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from grids.axes import Axis
from grids.plan import Plan
from models.base import FloatArray
from models.errors import InputError
from models.errors import nearest as closest
from study.selection import complete, place, select
from study.sensitivity.indices import MORRIS, SOBOL, at_the_ends, indices
from study.sets.cells import MOTION, Event, happens
from study.status import UNKNOWN

SET = "all motions"
LEADING = {SOBOL: "total", MORRIS: "mu_star"}
"""The index by which parameters are ranked."""


def design_axis(plan: Plan) -> Axis:
    """The plan's axis of a design. Raises InputError when it has none, or several."""
    axes = [axis for axis in plan.axes if axis.design is not None]
    if len(axes) != 1:
        held = f"{len(axes)} of them" if axes else "none"
        raise InputError(
            f"a sensitivity needs one axis of kind saltelli or morris, this plan has {held}: write for example "
            "sample = { saltelli = 256, seed = 1, parameters = { ... } } in [axes]"
        )
    return axes[0]


def analyse(
    cube: xr.Dataset,
    plan: Plan,
    events: Sequence[Event] = (),
    at: Mapping[str, Any] | None = None,
    *,
    confidence: float = 0.95,
) -> xr.Dataset:
    """Indices of every output and event (`study.sensitivity.indices`) over (motions, output, parameter).

    `motions` are the set, of which the mean over the motions is taken (of a yes or no: the share of the motions, a
    probability), and each motion. `at_low` and `at_high` are means of the output in the lowest and highest fifth of
    each parameter. By output: `unknown_share` of the points, `share_of_motion` and `share_of_parameters` of the
    variance over both that either explains alone (nan for one motion). An overturned wall enters with the value its
    output has (peak_rotation: pi/2); outputs without a value in some answered cell (onset_time of a wall at rest) are
    left out. Other axes than motion take their selected or middle value.
    """
    axis = design_axis(plan)
    assert_design(cube, axis)
    keep = [axis.name, *([MOTION] if MOTION in cube.dims else [])]
    taken = complete(cube, at, keep)
    cells = select(cube, taken)
    cells = cells.squeeze([dim for dim in cells.dims if dim not in keep])
    if MOTION not in cells.dims:
        cells = cells.expand_dims(MOTION)
    values = _values(cells.transpose(MOTION, axis.name), events)
    motions = [str(name) for name in cells[MOTION].values]
    labels = [SET, *motions] if len(motions) > 1 else motions
    parts = [
        xr.concat([_one(axis, rows, k, labels, confidence) for k in range(len(labels))], "motions", **JOIN)
        for rows in values.values()
    ]
    found = xr.concat(parts, "output", **JOIN)
    found = found.assign_coords(motions=labels, output=list(values), parameter=list(axis.sets))
    for name, which in (("share_of_motion", 1), ("share_of_parameters", 0)):
        found[name] = ("output", [_share(rows, which) for rows in values.values()])
    found["unknown_share"] = ("output", [float(np.isnan(rows).mean()) for rows in values.values()])
    return found.assign_attrs(
        kind=axis.design.kind if axis.design else "",
        points=axis.size,
        selection=place(cube, taken),
        confidence=confidence,
    )


JOIN: dict[str, Any] = {"data_vars": "all", "coords": "minimal", "compat": "override", "join": "exact"}


def assert_design(cube: xr.Dataset, axis: Axis) -> None:
    """Raise InputError when the cube is not of the plan's design."""
    if axis.name not in cube.dims or cube.sizes[axis.name] != axis.size:
        raise InputError(f"the cube has not the plan's axis '{axis.name}': run the plan again")


def _values(cells: xr.Dataset, events: Sequence[Event]) -> dict[str, FloatArray]:
    """Outputs and events as numbers (motions, points), nan where a cell has no valid answer."""
    answered = ~cells["status"].isin(UNKNOWN)
    found: dict[str, FloatArray] = {}
    for name in map(str, cells.data_vars):
        row = cells[name].astype(float).where(answered)
        if name != "status" and not bool((row.isnull() & answered).any()):
            found[name] = row.values
    for event in events:
        found[str(event)] = happens(cells, event).values
    if not found:
        known = [str(name) for name in cells.data_vars]
        raise InputError(
            f"no output has a value in every cell: add one to [outputs], {closest('peak_rotation', known)}"
        )
    return found


def _one(axis: Axis, rows: FloatArray, number: int, labels: list[str], confidence: float) -> xr.Dataset:
    """Indices of one output under one motion, or of its mean over all."""
    if axis.design is None:
        raise TypeError("the axis has no design")
    several = len(labels) > 1
    values = rows.mean(axis=0) if several and number == 0 else rows[number - several]
    found = indices(axis.design, values, confidence=confidence)
    low, high = at_the_ends(axis.design, values)
    dims = {1: ("parameter",), 2: ("parameter", "other_parameter")}
    data = {name: (dims[array.ndim], array) for name, array in (found | {"at_low": low, "at_high": high}).items()}
    return xr.Dataset(data | {"mean": ((), float(np.nanmean(values)) if np.isfinite(values).any() else np.nan)})


def _share(rows: FloatArray, axis: int) -> float:
    """Variance of the means along an axis over the whole variance, at points that are known under every motion."""
    known = rows[:, np.isfinite(rows).all(axis=0)]
    if rows.shape[0] < 2 or known.size == 0 or not known.var() > 0.0:
        return np.nan
    return float(known.mean(axis=axis).var() / known.var())
