"""What a rubber law is: one file that declares it, states it for arrays, and advances one fibre by a step.

u is the compression (m), h the law's hidden state, p its `Numbers`. All forms hold for both signs of u, so that
the same law serves a layer in compression and a bearing in shear.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, Literal, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray, Mechanism, MechanismParameter, Values

Numbers = Mapping[str, FloatArray]
"""A law's parameters by name, and ``stiffness`` k (N m-2), ``thickness`` e (m); arrays that broadcast."""
Role = Literal["shifts", "adds", "softens"]


class Layered(Protocol):
    """Coefficients of a model whose rubber can have laws."""

    def with_law(self, name: str, values: Values) -> Self: ...


def with_law(coefficients: Layered, values: Values, name: str) -> Layered:
    """The coefficients with the law ``name`` in their rubber."""
    return coefficients.with_law(name, values)


def rubber_mechanism(
    name: str, parameters: tuple[MechanismParameter, ...], *, equation: str, signature: str, sentence: str,
    static_test: str, source: str, models: Sequence[str] = ("interface", "isolated"),
) -> Mechanism:  # fmt: skip
    """The mechanism of a rubber law: a class of its own, addressed at both joints of a wall together or at one."""
    acts: dict[str, Callable[..., Any]] = {model: partial(with_law, name=name) for model in models}
    return Mechanism(
        name, name, parameters, equation, signature, sentence, acts, source, ("interface",), static_test=static_test
    )


def nothing(u: FloatArray, *_: Any) -> FloatArray:
    """Zeros as many as ``u``: of a law without memory, without a stress or an energy of its own."""
    return np.zeros_like(u)


def unmoved(u: FloatArray, h: FloatArray, p: Numbers) -> FloatArray:
    """The hidden state as it was."""
    return h


def accepted(p: Numbers) -> str:
    """No complaint."""
    return ""


def unlimited(p: Numbers) -> FloatArray:
    """Infinite."""
    return np.full(np.shape(p["thickness"]), np.inf)


def everything(p: Numbers) -> FloatArray:
    """One."""
    return np.ones(np.shape(p["stiffness"]))


def resting(p: Numbers, u: FloatArray) -> tuple[NDArray[np.bool_], str]:
    """Nowhere restless."""
    return np.zeros(u.shape, np.bool_), ""


@dataclass(frozen=True)
class RubberLaw:
    """A law as functions of arrays that broadcast, and its step for the compiled kernels.

    ``role``: what ``effect(u, h, p)`` is. ``shifts``: compression that carries nothing any more (m), taken off
    u for all that follows; ``adds``: stress beyond k u (N m-1); ``softens``: share that is lost of the sum of all that.
    ``slope(u, h, p)``: of an added stress over u on unloading (N m-2), what has flowed held.
    ``energy(u, h, p)``: stored with an added stress (J m-2); no change of it exceeds the work.
    ``rate(u, u', h, p)``: h' (per s). ``relaxed(u, p)``: h after an infinitely long rest at u.
    ``turned(u, rest, p)``: h after moving slowly from a long rest at ``rest`` to u. ``reached(u, h, p)``: what h
    becomes at once at u. ``hidden``: whether there is an h.
    ``numbers(p, step)``: what ``update`` wants for steps of ``step`` (s), by the names of its arguments.
    ``update(u, change, h, *numbers)``: h, effect and slope of one fibre at the end of a step over which u has
    grown by ``change`` (``_`` where the law does not look at it) to u; plain floats, without branches.
    ``limit(p)``: compression (m) that the layer cannot reach; a run that passes it is taken again in finer steps.
    ``of_strain``: whether the rubber's thickness enters. ``refusal(p)``: what is wrong with the numbers,
    after the name of the law and a point, or "".
    ``restless(p, u)``: where the law never comes to rest at u, and a sentence about the worst such place.
    ``left(p)``: share of the stiffness k that it leaves to further elements of its kind.
    """

    mechanism: Mechanism
    role: Role
    effect: Callable[[FloatArray, FloatArray, Numbers], FloatArray]
    numbers: Callable[[Numbers, FloatArray], Numbers]
    update: Callable[..., tuple[float, float, float]]
    slope: Callable[[FloatArray, FloatArray, Numbers], FloatArray] = nothing
    energy: Callable[[FloatArray, FloatArray, Numbers], FloatArray] = nothing
    rate: Callable[[FloatArray, FloatArray, FloatArray, Numbers], FloatArray] = nothing
    relaxed: Callable[[FloatArray, Numbers], FloatArray] = nothing
    turned: Callable[[FloatArray, FloatArray, Numbers], FloatArray] = nothing
    reached: Callable[[FloatArray, FloatArray, Numbers], FloatArray] = unmoved
    hidden: bool = True
    limit: Callable[[Numbers], FloatArray] = unlimited
    of_strain: bool = False
    refusal: Callable[[Numbers], str] = accepted
    restless: Callable[[Numbers, FloatArray], tuple[NDArray[np.bool_], str]] = resting
    left: Callable[[Numbers], FloatArray] = everything

    @property
    def name(self) -> str:
        return self.mechanism.name

    @property
    def kind(self) -> str:
        """The name of the law, or of the first element of its kind."""
        return self.mechanism.beside or self.name

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the mechanism's parameters."""
        return tuple(p.name for p in self.mechanism.parameters)

    @property
    def nulls(self) -> dict[str, FloatArray]:
        """The parameters at which the law does nothing, those that only shape it at any value."""
        return {p.name: np.array([p.null]) for p in self.mechanism.parameters}

    @cached_property
    def wanted(self) -> tuple[str, ...]:
        """Names of the numbers that ``update`` takes, in its order: the rows of the kernels' tables."""
        return tuple(inspect.signature(self.update).parameters)[3:]


def further(law: RubberLaw, models: Sequence[str]) -> RubberLaw:
    """The same law once more, on these models: the second element of a sum of such, named with a 2.

    Its stiffness k is what `RubberLaw.left` says of the first.
    """
    first, name = law.mechanism, f"{law.name}_2"
    again = replace(
        first,
        name=name,
        acts={model: partial(with_law, name=name) for model in models},
        equation=f"a second element beside {first.name}: {first.equation}",
        sentence=f"a second element: {first.sentence}",
        at_joints=(),
        beside=first.name,
    )
    return replace(law, mechanism=again)


def in_sum(laws: Mapping[str, RubberLaw], given: Mapping[str, Numbers]) -> list[tuple[RubberLaw, Numbers]]:
    """Those of the ``laws`` that are ``given`` numbers, in their order, each element with the stiffness left to it."""
    found = []
    for name, law in laws.items():
        if name in given:
            p, first = given[name], given.get(law.mechanism.beside)
            if first is not None:
                p = {**p, "stiffness": p["stiffness"] * law.left(first)}
            found.append((law, p))
    return found
