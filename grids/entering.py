"""Every value that enters a study's runs, and where it comes from: the plan, its specimen, or a default."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import models
from grids.plan import Plan
from grids.units import with_unit
from models.model import Model


@dataclass(frozen=True)
class Entry:
    """A fixed value (SI) or word of all cells; ``source`` is "plan", "specimen" or "default"."""

    name: str
    value: float | str
    unit: str
    meaning: str
    source: str

    def __str__(self) -> str:
        value = self.value if isinstance(self.value, str) else with_unit(self.value, self.unit)
        return f"{self.name} = {value}" + (" (default)" if self.source == "default" else "")


def entering(plan: Plan) -> tuple[Entry, ...]:
    """Parameters, parameters of the mechanisms in use, options, integrator and tail that hold for all cells.

    What varies stands in the axes; what the model works out itself where nothing is given (a default of nan)
    stands among the derived constants.
    """
    model = models.get(plan.model)
    return (*_numbers(plan, model), *_words(plan, model), *_of_run(plan))


def _numbers(plan: Plan, model: Model) -> Iterator[Entry]:
    varied = {name for axis in plan.axes for name in axis.sets}
    declared = {p.name: (p.default, p.unit, p.meaning) for p in model.parameters}
    for mechanism in _in_use(plan, varied):
        own = model.mechanisms[mechanism]
        for p in own.addressable(model.name):
            # one joint's own value replaces that of both
            joint = p not in own.parameters
            declared[f"{mechanism}.{p.name}"] = (None if joint else p.null, p.unit, p.meaning)
    from_specimen = _flat(plan)
    for name, (default, unit, meaning) in declared.items():
        if name in varied:
            continue
        if name in plan.fixed:
            value = plan.fixed[name]
            yield Entry(name, value, unit, meaning, "specimen" if from_specimen.get(name) == value else "plan")
        elif default is not None and not math.isnan(default) and not _at_both_joints(name, plan, varied):
            yield Entry(name, default, unit, meaning, "default")


def _in_use(plan: Plan, varied: set[str]) -> list[str]:
    return list(dict.fromkeys(name.partition(".")[0] for name in (*plan.fixed, *varied) if "." in name))


def _at_both_joints(name: str, plan: Plan, varied: set[str]) -> bool:
    return all(f"{name}_{joint}" in plan.fixed or f"{name}_{joint}" in varied for joint in ("base", "top"))


def _flat(plan: Plan) -> dict[str, float]:
    if plan.specimen is None:
        return {}
    mechanisms = plan.specimen.mechanisms.items()
    return {**plan.specimen.parameters, **{f"{m}.{p}": v for m, values in mechanisms for p, v in values.items()}}


def _words(plan: Plan, model: Model) -> Iterator[Entry]:
    varied = {name for axis in plan.axes for name in axis.sets}
    for name, word in model.resolve_options(plan.options).items():
        if name not in varied:
            yield Entry(name, word, "1", "option of the model", "plan" if name in plan.options else "default")


def _of_run(plan: Plan) -> Iterator[Entry]:
    run = plan.given_in_run
    yield Entry("integrator", plan.integrator, "1", "integrator", "plan" if "integrator" in run else "default")
    yield Entry("tail", plan.tail, "s", "longest free motion after the record", "plan" if "tail" in run else "default")
