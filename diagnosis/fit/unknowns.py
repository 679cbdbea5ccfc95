"""What a fit may change: base parameters within tolerances or ranges, and parameters of mechanisms."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from grids.instruments import INSTRUMENTS
from grids.specimen import Specimen
from models.base import FloatArray, Mechanism, MechanismParameter
from models.model import Model

STEPS_OF_RANGE = 20.0
LOG_SPAN = 3.0
"""A range [low, high] wider than this ratio is fitted in its logarithm."""
AT_BOUND = 1e-7
"""Share of a range over which a coordinate is not told from its bound."""
WIDEST_PRIOR = 3.0
"""Standard deviations that a toleranced parameter may depart from its nominal value."""


@dataclass(frozen=True)
class Unknown:
    """One fitted number. The fit works with a coordinate of order one:

    linear: value = scale u;  log: value = exp(scale u);  inverse: value = 1/(scale u), infinite at u = 0.
    ``prior`` is (mean, standard deviation) of the value, for linear ones. ``stiff``: an inverse one
    that stays within its range, its null apart.
    """

    name: str
    unit: str
    low: float
    high: float
    start: float
    scale: float
    kind: Literal["linear", "log", "inverse"] = "linear"
    prior: tuple[float, float] | None = None
    stiff: bool = False

    def value(self, u: float) -> float:
        if self.kind == "linear":
            return float(self.scale * u)
        if self.kind == "log":
            return float(np.exp(self.scale * u))
        return float(1.0 / (self.scale * u)) if u > 0.0 else np.inf

    def coordinate(self, value: float) -> float:
        if self.kind == "linear":
            return float(value / self.scale)
        if self.kind == "log":
            return float(np.log(value) / self.scale)
        return 0.0 if np.isinf(value) else float(1.0 / (value * self.scale))

    @property
    def bounds(self) -> tuple[float, float]:
        """Of the coordinate, low first. An inverse one may reach its null, unless it is stiff there."""
        if self.kind == "inverse":
            return self.coordinate(self.high) if self.stiff else 0.0, self.coordinate(self.low)
        return self.coordinate(self.low), self.coordinate(self.high)


def clip(unknowns: Sequence[Unknown], u: FloatArray) -> FloatArray:
    """The coordinates within their bounds; what is `AT_BOUND` of its range or nearer to one is there.

    A model that is stiff near the null of an effect, where the null itself is not, takes that many steps for what is
    left of rounding.
    """
    low, high = np.array([x.bounds for x in unknowns]).reshape(-1, 2).T
    slack = np.where(np.isfinite(high - low), AT_BOUND * (high - low), 0.0)
    return np.where(u <= low + slack, low, np.where(u >= high - slack, high, u))


def values_of(unknowns: Sequence[Unknown], u: FloatArray) -> dict[str, float]:
    return {x.name: x.value(float(c)) for x, c in zip(unknowns, u, strict=True)}


def library(model: Model) -> dict[str, Mechanism]:
    """Every mechanism of the model and of instruments, by name."""
    return {**model.mechanisms, **INSTRUMENTS}


def effects(model: Model) -> dict[str, Mechanism]:
    """Everything that an answer may name: the library, and other base models."""
    ladder = model.identification.ladder if model.identification else ()
    return {**library(model), **{rung.name: rung.mechanism for rung in ladder}}


def of_specimen(specimen: Specimen, model: Model) -> tuple[Unknown, ...]:
    """Toleranced parameters with their priors, and those to calibrate within their ranges."""
    units = {p.name: p.unit for p in model.parameters}
    known = library(model)
    units |= {f"{m}.{p.name}": p.unit for m in known for p in known[m].addressable(model.name)}
    found = []
    for name, relative in specimen.tolerance.items():
        nominal = specimen.nominal[name]
        sd = abs(relative * nominal)
        low, high = nominal - WIDEST_PRIOR * sd, nominal + WIDEST_PRIOR * sd
        start = min(max(specimen.parameters[name], low), high)
        found.append(Unknown(name, units[name], low, high, start, sd, prior=(nominal, sd)))
    found += [in_range(name, units[name], low, high) for name, (low, high) in specimen.calibrate.items()]
    return tuple(found)


def in_range(name: str, unit: str, low: float, high: float) -> Unknown:
    """A number of which only the range is known."""
    if low > 0.0 and high / low > LOG_SPAN:
        return Unknown(name, unit, low, high, float(np.sqrt(low * high)), 0.1, "log")
    return Unknown(name, unit, low, high, (low + high) / 2.0, (high - low) / STEPS_OF_RANGE)


def of_parameter(mechanism: Mechanism, parameter: MechanismParameter) -> Unknown:
    """A mechanism's parameter over its range, from its null."""
    name = f"{mechanism.name}.{parameter.name}"
    at = parameter.null
    if parameter.fit_inverse:
        scale = 1.0 / (parameter.low * STEPS_OF_RANGE)
        return Unknown(name, parameter.unit, parameter.low, parameter.high, at, scale, "inverse", stiff=parameter.stiff)
    low, high = min(parameter.low, parameter.null), max(parameter.high, parameter.null)
    return Unknown(name, parameter.unit, low, high, at, (high - low) / STEPS_OF_RANGE)


def fixed_values(specimen: Specimen) -> dict[str, float]:
    """Values that stay: parameters and the mechanisms already switched on."""
    values: dict[str, float] = dict(specimen.parameters)
    for mechanism, parameters in specimen.mechanisms.items():
        values |= {f"{mechanism}.{name}": value for name, value in parameters.items()}
    return values


def instruments_of(values: Mapping[str, float]) -> dict[str, dict[str, float]]:
    """The values of instruments by mechanism and parameter."""
    found: dict[str, dict[str, float]] = {}
    for key, value in values.items():
        mechanism, _, parameter = key.partition(".")
        if mechanism in INSTRUMENTS:
            found.setdefault(mechanism, {})[parameter] = value
    return found


def without_instruments(values: Mapping[str, float]) -> dict[str, float]:
    """The values of the wall alone."""
    return {key: value for key, value in values.items() if key.partition(".")[0] not in INSTRUMENTS}
