"""The ground motions of a plan: one, or one for each value of the axis `motion`."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from grids.axes import Axis
from grids.files import Schema
from grids.motions import Motion, find, read_motion
from grids.motions.made import MAKERS
from grids.plan_checks import check_vertical
from grids.targets import MOTION
from models.errors import InputError
from models.model import Model


class MotionTable(Schema):
    files: str | list[str | dict[str, Any]] | None = None
    pulse: dict[str, Any] | None = None
    artificial: dict[str, Any] | None = None
    component: str | None = None
    vertical: bool | None = None


def read_motions(
    table: MotionTable,
    axes: tuple[Axis, ...],
    folder: Path,
    model: Model,
    vertical: bool | None,
    apart: bool,
) -> tuple[tuple[Motion, ...], tuple[Axis, ...]]:
    """The motions, and the axes with the motions' names where they vary.

    ``vertical`` stands where the plan does not say; a model that is shaken horizontally only gets no
    vertical component. ``apart``: a mechanism applies the vertical
    component itself, so the record must have one and the plan may not feed it as well.
    """
    vertical = table.vertical if table.vertical is not None else vertical
    if apart and vertical:
        raise InputError(
            "'vertical_acceleration.kappa' stands for a vertical motion that is left out; "
            "set [motion] vertical = false or leave the mechanism out."
        )
    check_vertical(model, vertical)
    wanted = apart or (vertical if model.takes_vertical else False)

    def read(source: Any) -> Motion:
        return read_motion(source, component=table.component, vertical=wanted, near=folder)

    listing = [axis for axis in axes if MOTION in axis.sets]
    given = [name for name in ("files", *MAKERS) if getattr(table, name) is not None]
    if len(given) + len(listing) != 1:
        places = [f"[motion] {name}" for name in given] + [f"[axes] {axis.name}" for axis in listing]
        held = f"{' and '.join(places)} both name motions" if places else "no motion is given"
        kinds = ", ".join(f"[motion] {kind}" for kind in MAKERS)
        raise InputError(f"{held}; give exactly one of [motion] files, {kinds}, an axis of motions.")
    if not listing:
        made = [{kind: getattr(table, kind)} for kind in MAKERS if kind in given]
        sources = made or _listed(table.files)
        motions = _distinct([read(source) for source in _expanded(sources, folder)])
        if len(motions) == 1:
            return motions, axes
        return motions, (Axis(MOTION, _names(motions), "1", "ground motion"), *axes)
    axis = listing[0]
    if axis.points is None:
        motions = _distinct([read(source) for source in _expanded(axis.values, folder)])
        return motions, tuple(replace(a, values=_names(motions)) if a is axis else a for a in axes)
    read_once = {str(source): read(source) for source in axis.points[MOTION]}
    names = _names([read_once[str(source)] for source in axis.points[MOTION]])
    points = {**axis.points, MOTION: names}
    motions = _distinct(list(read_once.values()))
    return motions, tuple(replace(a, points=points) if a is axis else a for a in axes)


def _listed(files: str | list[str | dict[str, Any]] | None) -> list[str | dict[str, Any]]:
    if not files:
        raise InputError("[motion] files is empty; name at least one record.")
    return [files] if isinstance(files, str) else files


def _expanded(sources: Iterable[Any], folder: Path) -> list[Any]:
    """The sources with globs and lists of seeds replaced by what they stand for."""
    found: list[Any] = []
    for source in sources:
        found += find(source if isinstance(source, dict) else str(source), folder)
    return found


def _distinct(motions: list[Motion]) -> tuple[Motion, ...]:
    for index, motion in enumerate(motions):
        if any(motion.name == other.name for other in motions[:index]):
            raise InputError(f"two motions are called '{motion.name}'; leave one out or rename its file.")
        for other in motions[:index]:
            if motion.fingerprint == other.fingerprint:  # statistics would take them for two records
                raise InputError(
                    f"'{other.name}' and '{motion.name}' are the same motion, sample for sample; leave one out."
                )
    return tuple(motions)


def _names(motions: Iterable[Motion]) -> np.ndarray[tuple[int], np.dtype[np.object_]]:
    names = [motion.name for motion in motions]
    values = np.empty(len(names), dtype=object)
    values[:] = names
    return values
