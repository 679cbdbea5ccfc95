"""What a model and a mechanism declare about themselves.

Declarations are data: the one source for the documentation, for the checks of plans and
specimens, and for the labels and units of a cube. Physics stands in the folders of the models.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from models.tables import Tables

Values = Mapping[str, Any]
"""Parameter values by name: floats or arrays that broadcast to the lanes' shape ``(n,)``."""
FloatArray = NDArray[np.float64]


STATUS = ("not_run", "rest", "rocking", "overturned", "outside_model", "not_converged", "failed")
"""What can become of a cell: the words of a cube's ``status`` flags, by their values 0 to 6."""
UNANSWERED = tuple(STATUS.index(word) for word in ("outside_model", "not_converged", "failed"))
"""Flags of cells without a valid answer: every output but ``status`` is nan, of whole numbers and flags `MISSING`."""
MISSING = -1


@dataclass(frozen=True)
class Parameter:
    """A number a user may give. ``low`` and ``high`` are the bounds beyond which it has no meaning.

    ``default`` None means: must be given, unless an alternative (see `Model.alternatives`) is.
    ``low_open`` excludes the lower bound itself (a width of zero).
    """

    name: str
    symbol: str
    unit: str
    meaning: str
    low: float = -np.inf
    high: float = np.inf
    default: float | None = None
    low_open: bool = False


@dataclass(frozen=True)
class MechanismParameter(Parameter):
    """A parameter of a mechanism: ``null`` switches it off, ``low``..``high`` is what a fit may reach.

    ``fit_inverse``: the null is infinite (or the response saturates), so a fit works with 1/value.
    ``shape``: it shapes the effect (a gap, a time constant) and has none of its own; the mechanism
    is off when its first parameter is at its null. ``stiff``: the equations cost ever more towards
    the null, so a fit stays within ``low``..``high`` and does not approach it. ``required``: it decides
    the effect and has no natural default, so plans and specimens that use the mechanism must give it.
    """

    null: float = 0.0
    fit_inverse: bool = False
    shape: bool = False
    stiff: bool = False
    required: bool = False


OverParts = Literal["first", "largest", "least", "total", "last", "bits"]


@dataclass(frozen=True)
class Quantity:
    """An output of a run, a derived constant, or an observable channel of a history.

    ``peak_of``: observables whose largest absolute value the output is (see `models.peaks`); an output without
    them is summed up by the integrators. ``over_parts``: how the output of a run that is cut follows from those of
    its parts (`models.piecewise`): the first time, the largest, the least, the sum, the last, or the bits of all;
    None for what is no output.
    """

    name: str
    symbol: str
    unit: str
    meaning: str
    rule: str = ""
    dtype: str = "float64"
    peak_of: tuple[str, ...] = ()
    over_parts: OverParts | None = None


JOINTS = (("base", "at the base"), ("top", "at the top joint"))
"""Ends of the names that address one joint, and what they mean."""


@dataclass(frozen=True)
class Mechanism:
    """Physics that a base model leaves out: one handle, the same in studies, specimens and diagnosis.

    ``acts`` maps a model's name to the function that changes that model's coefficients (their type is
    the model's own). Where the equation has other parameters on another model, that is a second
    declaration of the same name.
    ``signature`` says where the residual shows when it is left out, and after a semicolon what tells it
    from others that show there; ``sentence`` is what a report prints, with the parameters' names in braces.
    """

    name: str
    effect_class: str
    parameters: tuple[MechanismParameter, ...]
    equation: str
    signature: str
    sentence: str
    acts: Mapping[str, Callable[..., Any]] = field(default_factory=dict)
    source: str = ""
    at_joints: tuple[str, ...] = ()
    """Models on which ``parameter_base`` and ``parameter_top`` address one joint alone."""
    sentences: Mapping[str, str] = field(default_factory=dict)
    """By parameter, or parameters with commas between: the sentence where the mechanism acts through these."""
    tabulated: Tables | None = None
    """The tables whose values its parameters are: files name the table, and a diagnosis does not switch it on."""
    static_test: str = ""
    """A test without shaking that would settle it, as an instruction; empty where there is none."""
    beside: str = ""
    """Of a further element of the same kind: the name of the first, beside which a diagnosis tries it."""

    @property
    def shows(self) -> str:
        """Where the residual shows when it is left out; what shows at the same place is easily taken for it."""
        return self.signature.partition(";")[0]

    def parameter(self, name: str) -> MechanismParameter:
        for parameter in (*self.parameters, *self._of_joints()):
            if parameter.name == name:
                return parameter
        raise KeyError(name)

    def addressable(self, model: str) -> tuple[MechanismParameter, ...]:
        """The parameters by every name that a plan or specimen of ``model`` may use."""
        return (*self.parameters, *(self._of_joints() if model in self.at_joints else ()))

    def _of_joints(self) -> tuple[MechanismParameter, ...]:
        places = JOINTS if self.at_joints else ()
        return tuple(
            replace(p, name=f"{p.name}_{joint}", meaning=f"{p.meaning}, {where}")
            for p in self.parameters
            for joint, where in places
        )

    def sentence_for(self, given: Mapping[str, float]) -> str:
        """The sentence, still with its braces, for the parameters that are ``given`` a value off their null."""
        nulls, first = self.nulls, self.parameters[0].name
        off = {name for name, value in given.items() if value != nulls.get(name)}
        through = {key: set(key.split(", ")) for key in self.sentences}
        fitting = [key for key, names in through.items() if names <= off and (first in names or first not in off)]
        return self.sentences[max(fitting, key=lambda key: len(through[key]))] if fitting else self.sentence

    def says(self, given: Mapping[str, float]) -> str:
        """The sentence with the values in place, those not given at their null; a joint is named."""
        plain, where = dict(given), ""
        for joint, place in JOINTS:
            for parameter in self.parameters:
                if f"{parameter.name}_{joint}" in plain:
                    plain[parameter.name] = plain.pop(f"{parameter.name}_{joint}")
                    where = f" ({place})"
        return self.sentence_for(plain).format_map({**self.nulls, **plain}) + where

    @property
    def nulls(self) -> dict[str, float]:
        return {p.name: p.null for p in self.parameters}


@dataclass(frozen=True)
class Event:
    """Something that happens at an instant of a history."""

    time: float
    kind: str
    body: int = 1


@dataclass(frozen=True)
class History:
    """One run over time: channels ``(n_times,)`` by observable name, and the events in order."""

    time: FloatArray
    channels: Mapping[str, FloatArray]
    events: tuple[Event, ...]
    outputs: Mapping[str, float]
