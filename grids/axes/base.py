"""An axis of a study: one dimension of the cube, setting one name or several at each point."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grids.motions.measures import PREFIX as OF_MOTIONS
from grids.targets import MOTION, Target, Targets
from grids.units import factor_to_si, to_si
from models.errors import InputError

MOST_POINTS = 10_000_000

OF_COMMANDS = (MOTION, "unknown", "computed", "bin", "level")
"""What cubes and commands call by these names."""


@dataclass(frozen=True, eq=False)
class Design:
    """Points of a sensitivity analysis: its kind of axis, and the shares ``(n, parameters)`` of the distributions.

    ``choices``: how many words each parameter has to choose from, 0 of numbers.
    """

    kind: str
    shares: NDArray[np.float64]
    choices: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Axis:
    """``values`` (n,): numbers in the SI ``unit``, or words (records, options, labels of cases).

    ``points`` is None for an axis that varies what it is named after; otherwise the axis is a list
    of cases or samples, and ``points`` holds the values ``(n,)`` of each name it sets.
    """

    name: str
    values: NDArray[Any]
    unit: str
    long_name: str
    points: Mapping[str, NDArray[Any]] | None = None
    design: Design | None = None

    @property
    def size(self) -> int:
        return int(self.values.size)

    @property
    def sets(self) -> Mapping[str, NDArray[Any]]:
        """The values ``(n,)`` of every name that varies along this axis."""
        return {self.name: self.values} if self.points is None else self.points


@dataclass(frozen=True)
class Request:
    """One entry of [axes]: its name, its table, and what the names in it may mean."""

    name: str
    table: Mapping[str, Any]
    targets: Targets
    folder: Path
    taken: frozenset[str] = frozenset()

    @property
    def where(self) -> str:
        return f"[axes] {self.name}"

    def target(self) -> Target:
        return self.targets.find(self.name, self.where)

    def number_target(self) -> Target:
        """The target, where only a number makes sense."""
        target = self.target()
        if target.words or self.name == MOTION:
            raise InputError(f"{self.where}: this axis takes words; list them with values = [...].")
        return target

    def in_si(self, value: object, target: Target, where: str) -> float:
        """A number in the table's ``unit`` (SI without one), or a string that carries its own."""
        unit = self.table.get("unit")
        if unit is None or isinstance(value, str):
            return to_si(value, target.unit, where)
        if not isinstance(unit, str):
            raise InputError(f"{self.where}: unit = {unit!r}; give the unit as a string.")
        return to_si(value, "1", where) * factor_to_si(unit, target.unit, where)

    def span(self, key: str) -> tuple[float, float, int]:
        """The SI ends and the count of an entry ``key = [low, high, count]``."""
        entry = self.table[key]
        if not isinstance(entry, list) or len(entry) != 3:
            raise InputError(f"{self.where}: {key} = {entry!r}; give [low, high, count].")
        where = f"{self.where} {key}"
        low, high = (self.in_si(value, self.number_target(), where) for value in entry[:2])
        if not np.isfinite([low, high]).all():
            raise InputError(f"{where} = {entry}: both ends must be finite; correct them.")
        if not low < high:
            raise InputError(f"{where} = {entry}: low must be below high; swap or separate them.")
        return low, high, count(entry[2], 2, where)

    def own_name(self) -> str:
        """The name of an axis of cases or samples, which must not mean anything else."""
        if self.name in self.taken or self.name in OF_COMMANDS or self.name.startswith(OF_MOTIONS):
            raise InputError(
                f"{self.where}: this name is taken by a parameter, an output or a command; "
                "call an axis of cases or samples for example 'case'."
            )
        if not self.name.isidentifier():
            raise InputError(f"{self.where}: write the name with letters, digits and _ only.")
        return self.name


@dataclass(frozen=True)
class AxisKind:
    """A way to write an axis: the key that marks it, the keys beside it, and its reader."""

    key: str
    beside: tuple[str, ...]
    read: Callable[[Request], Axis]


def count(value: object, least: int, where: str) -> int:
    """A number of points; InputError outside ``least`` .. 10 million."""
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= MOST_POINTS:
        raise InputError(f"{where}: count {value!r}; give a whole number from {least} to {MOST_POINTS:_}.")
    return value


def number_axis(request: Request, numbers: NDArray[np.float64]) -> Axis:
    """An axis of numbers, checked against the bounds, each value once.

    Values keep 13 significant digits, so that a point shared by two grids is the same number
    whichever way it was written, and an extended axis finds its finished cells again.
    """
    target = request.number_target()
    values = np.array([float(f"{number:.13g}") for number in numbers])
    checked = bounded(values, target, request.where)
    unique, counts = np.unique(checked, return_counts=True)
    if unique.size < checked.size:
        raise InputError(
            f"{request.where}: value {unique[counts > 1][0]:.6g} {target.unit} is given twice; leave one out."
        )
    return Axis(request.name, checked, target.unit, target.meaning)


def bounded(values: NDArray[np.float64], target: Target, where: str) -> NDArray[np.float64]:
    """The values if all lie inside the target's bounds; InputError about the first that does not."""
    above = values > target.low if target.low_open else values >= target.low
    fine = above & (values <= target.high) & np.isfinite(values)
    for value in values[~fine]:
        target.bounded(float(value), where)
    return values
