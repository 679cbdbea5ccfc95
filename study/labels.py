"""Attributes and values of a cube's coordinates, from the declarations of model and mechanisms."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grids.motions.measures import MEASURES, PREFIX, measures_of
from grids.plan import Plan
from grids.targets import MOTION, SCALES
from models.base import STATUS, Parameter, Quantity
from models.model import Model
from study.keys import motions_by_name


@dataclass(frozen=True)
class Coordinate:
    """A coordinate variable of the cube: values over ``dims`` and CF attributes."""

    name: str
    dims: tuple[str, ...]
    values: NDArray[Any]
    attributes: Mapping[str, Any] = field(default_factory=dict)


def describe(quantity: Parameter | Quantity) -> dict[str, Any]:
    """CF attributes of a declared quantity; ``comment`` holds the rule by which it is computed."""
    rule = getattr(quantity, "rule", "") or quantity.meaning
    attributes = {"units": quantity.unit, "long_name": quantity.meaning, "comment": rule}
    if quantity.symbol:
        attributes["symbol"] = quantity.symbol
    if quantity.name == "status":
        attributes |= flags(STATUS)
    elif getattr(quantity, "dtype", "") == "bool":
        attributes |= flags(("no", "yes"))
    return attributes


def flags(words: tuple[str, ...]) -> dict[str, Any]:
    """CF attributes of an integer variable whose values 0, 1, 2 ... mean ``words``."""
    return {"flag_values": np.arange(len(words), dtype=np.int8), "flag_meanings": " ".join(words)}


def axis_coordinates(plan: Plan, model: Model) -> list[Coordinate]:
    """The dimension coordinates, and what an axis of cases or samples sets at its points."""
    found = []
    for axis in plan.axes:
        attributes = {"units": axis.unit, "long_name": axis.long_name, "comment": axis.long_name}
        attributes |= _declared(model, axis.name) | {"axis_of_study": True}
        found.append(Coordinate(axis.name, (axis.name,), np.asarray(axis.values), attributes))
        if axis.points is not None:
            for name, values in axis.points.items():
                found.append(Coordinate(name, (axis.name,), np.asarray(values), _declared(model, name)))
    return found


def _declared(model: Model, name: str) -> dict[str, Any]:
    """Attributes of anything a plan can vary; empty for the name of an axis of cases."""
    if name == MOTION:
        return {"units": "1", "long_name": "ground motion", "comment": "name of the record"}
    if name in model.options:
        return {"units": "1", "long_name": name.replace("_", " "), "comment": "option of the model"}
    mechanism, dot, parameter = name.partition(".")
    if dot:
        return describe(model.mechanisms[mechanism].parameter(parameter))
    declared = {p.name: p for p in (*model.parameters, *SCALES)}
    return describe(declared[name]) if name in declared else {}


def motion_coordinates(plan: Plan) -> list[Coordinate]:
    """Names and measures (`grids.motions.measures`) of the records: along the axis that varies them, or scalars."""
    along = next((axis for axis in plan.axes if MOTION in axis.sets), None)
    motions = motions_by_name(plan)
    measured = {name: measures_of(motion) for name, motion in motions.items()}
    names = list(motions) if along is None else along.sets[MOTION].tolist()
    dims = () if along is None else (along.name,)
    found = []
    for measure in MEASURES:
        values = np.array([measured[name][measure.name] for name in names])
        attributes = {"units": measure.unit, "long_name": measure.meaning, "symbol": measure.symbol}
        attributes["comment"] = "of the record as read, before any scaling"
        found.append(Coordinate(PREFIX + measure.name, dims, values if dims else np.asarray(values[0]), attributes))
    if along is None:
        label = {"units": "1", "long_name": "ground motion", "comment": "name of the record"}
        found.insert(0, Coordinate(MOTION, (), np.array(names[0], dtype=object), label))
    return found
