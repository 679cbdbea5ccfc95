"""What a plan or specimen may set: a model's parameters and options, mechanisms, the motion's scales."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

from grids.instruments import INSTRUMENTS
from grids.instruments.base import Whole
from grids.units import to_si, with_unit
from models.base import Mechanism, MechanismParameter, Parameter
from models.errors import InputError, nearest
from models.model import Model

MOTION = "motion"
SCALES = (
    Parameter("pga", "PGA", "m s-2", "peak of the horizontal acceleration", 0.0),
    Parameter("motion_scale", "s", "1", "factor on both components of the motion", 0.0),
    Parameter("time_scale", "s_t", "1", "factor on the duration of the motion", 0.0, low_open=True),
)


def find_model(name: object, where: str) -> Model:
    """The model of that name; InputError with the nearest one otherwise."""
    import models

    if name not in models.MODELS:
        raise InputError(f"{where} = '{name}' is no model; {nearest(str(name), models.MODELS)}")
    return models.get(str(name))


@dataclass(frozen=True)
class Target:
    """One thing that can be set: a number with a unit and bounds, or one of some words."""

    name: str
    unit: str
    meaning: str
    low: float = -math.inf
    high: float = math.inf
    low_open: bool = False
    null: float | None = None
    words: tuple[str, ...] = ()
    whole: bool = False

    def number(self, value: object, where: str) -> float:
        """The value in SI, inside the bounds; raises InputError."""
        return self.bounded(to_si(value, self.unit, where), where)

    def bounded(self, number: float, where: str) -> float:
        if number == self.null:
            return number
        too_low = number <= self.low if self.low_open else number < self.low
        if too_low or number > self.high or math.isinf(number):
            raise InputError(
                f"{where} = {with_unit(number, self.unit)} ({self.meaning}): it must be {self._allowed(number)}"
                f"{self._per_cent(number)}."
            )
        if self.whole and not number.is_integer():
            raise InputError(
                f"{where} = {number:g} ({self.meaning}): give a whole number from {self.low:g} to {self.high:g}."
            )
        return number

    def word(self, value: object, where: str) -> str:
        if value not in self.words:
            raise InputError(f"{where} = {value!r}: {nearest(str(value), self.words)}")
        return str(value)

    def _per_cent(self, number: float) -> str:
        """What a share was perhaps meant to be: 5.44 for 5.44 %."""
        share = number / 100.0
        meant = self.unit == "1" and self.high <= 1.0 and self.low < share <= self.high and number >= 2.0 * self.high
        return f" ({number:g} % is {share:g})" if meant else ""

    def _allowed(self, number: float) -> str:
        parts = []
        if math.isfinite(self.low):
            word = "greater than" if self.low_open else "at least"
            parts.append(f"{word} {with_unit(self.low, self.unit)}")
        if math.isfinite(self.high):
            parts.append(f"at most {with_unit(self.high, self.unit)}")
        elif not math.isfinite(number):
            parts.append("finite")
        allowed = " and ".join(parts) or "finite"
        if self.null is not None and math.isinf(self.null):
            allowed += ", or inf for no effect"
        return allowed


def _of(parameter: Parameter, name: str) -> Target:
    null = parameter.null if isinstance(parameter, MechanismParameter) else None
    return Target(
        name, parameter.unit, parameter.meaning, parameter.low, parameter.high, parameter.low_open, null,
        whole=isinstance(parameter, Whole),
    )  # fmt: skip


@dataclass(frozen=True)
class Targets:
    """What a model, its mechanisms, (in a study) the motion's scales and (in a specimen) instruments offer."""

    model: Model
    with_instruments: bool = False
    with_scales: bool = False

    @property
    def mechanism_names(self) -> Collection[str]:
        from models.mechanisms import MECHANISMS

        return {*(mechanism.name for mechanism in MECHANISMS), *self.model.mechanisms, *INSTRUMENTS}

    def flatten(self, table: Mapping[str, Any]) -> dict[str, Any]:
        """Both TOML spellings of a mechanism's parameter, quoted or as a sub-table, as dotted names.

        A table under a name that is a parameter of the model too (restitution) is the mechanism's only
        if it holds one of the mechanism's parameters.
        """
        flat: dict[str, Any] = {}
        for name, value in table.items():
            if name in self.mechanism_names and isinstance(value, dict) and self._of_mechanism(name, value):
                flat.update({f"{name}.{parameter}": entry for parameter, entry in value.items()})
            else:
                flat[name] = value
        return flat

    def _of_mechanism(self, name: str, table: Mapping[str, Any]) -> bool:
        if name not in self.names():
            return True
        acting = self.model.mechanisms.get(name)
        return acting is not None and any(parameter.name in table for parameter in acting.parameters)

    def mechanism(self, name: str, where: str) -> Mechanism:
        """A mechanism that may be used here; InputError says why another may not."""
        if name in INSTRUMENTS:
            if self.with_instruments:
                return INSTRUMENTS[name]
            raise InputError(
                f"{where}: '{name}' acts on the instruments, not on the wall; a study cannot vary it: "
                "put it in a specimen and use simulate."
            )
        acting = self.model.mechanisms
        if name in acting:
            return acting[name]
        if name in self.mechanism_names:
            raise InputError(
                f"{where}: mechanism '{name}' does not act on model '{self.model.name}'; "
                f"acting: {', '.join(sorted(acting)) or 'none'}."
            )
        usable = {*acting, *(INSTRUMENTS if self.with_instruments else ())}
        raise InputError(f"{where}: there is no mechanism '{name}'; {nearest(name, usable)}")

    def find(self, name: str, where: str) -> Target:
        """The target of that name; InputError with the nearest one otherwise."""
        mechanism_name, dot, parameter_name = name.partition(".")
        if dot:
            mechanism = self.mechanism(mechanism_name, where)
            known = {parameter.name: parameter for parameter in mechanism.addressable(self.model.name)}
            if parameter_name not in known:
                raise InputError(
                    f"{where}: mechanism '{mechanism_name}' has no parameter '{parameter_name}'; "
                    f"{nearest(parameter_name, known)}"
                )
            return _of(known[parameter_name], name)
        parameters = {parameter.name: parameter for parameter in self._plain()}
        if name in parameters:
            return _of(parameters[name], name)
        if name in self.model.options:
            return Target(name, "1", f"{name} of the model", words=self.model.options[name])
        if name in self.mechanism_names:
            raise InputError(
                f"{where}: '{name}' is a mechanism; name its parameter: "
                + " or ".join(f"'{name}.{p.name}'" for p in self.mechanism(name, where).parameters)
                + "."
            )
        dotted = [f"{m.name}.{p.name}" for m in self.model.mechanisms.values() for p in m.parameters]
        names = [*parameters, *self.model.options, *dotted, *self.model.mechanisms]
        listed = [*sorted(self.names()), "and parameters of mechanisms as 'mechanism.parameter'"]
        raise InputError(f"{where} is not a parameter of model '{self.model.name}'; {nearest(name, names, listed)}")

    def option(self, name: str, word: object, where: str) -> str:
        """A word of one of the model's options; raises InputError."""
        if name not in self.model.options:
            raise InputError(f"{where} is no option of model '{self.model.name}'; {nearest(name, self.model.options)}")
        return self.find(name, where).word(word, where)

    def names(self) -> set[str]:
        """Every name without a dot that can be set."""
        return {*(parameter.name for parameter in self._plain()), *self.model.options}

    def _plain(self) -> tuple[Parameter, ...]:
        return (*self.model.parameters, *(SCALES if self.with_scales else ()))
