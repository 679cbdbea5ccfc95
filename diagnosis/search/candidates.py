"""The mechanisms that may be missing, as unknowns with places to start from."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.fit.unknowns import Unknown, library, of_parameter
from diagnosis.search.spells import When
from grids.instruments.base import Surroundings
from grids.specimen import Specimen
from models.base import FloatArray, Mechanism, MechanismParameter

GRID = (0.03, 0.1, 0.3, 0.6, 0.95)
"""Shares of the way from the null to a bound."""
FINE_GRID = tuple(np.geomspace(0.01, 0.95, 32).tolist())
"""The same where the effect sets in at a threshold somewhere on the way."""
SHAPE_GRID = 3
FINE_SHAPES = tuple(np.geomspace(0.01, 0.95, 12).tolist())
"""Shares of the range of a shape that may keep an effect from acting, such as the strain from which a set begins."""
ORDERS = (1.0, 2.0, 3.0, 4.0)


@dataclass(frozen=True, eq=False)
class Candidate:
    """One mechanism, or one variant of it with some parameters held.

    ``unknowns``: the effect's parameter first, then those that shape it; ``held``: the others. ``spell``: when it acts,
    None for always; ``price``: what the choice of the spell costs, in 2 log likelihood. ``steep``: the effect sets in
    within a small part of its range, with no slope at its null.
    """

    mechanism: Mechanism
    unknowns: tuple[Unknown, ...]
    held: dict[str, float]
    spell: When | None = None
    price: float = 0.0
    steep: bool = False

    @property
    def name(self) -> str:
        return self.mechanism.name

    @property
    def effect_class(self) -> str:
        return self.mechanism.effect_class

    @property
    def null(self) -> FloatArray:
        """Coordinates (d,) at which the effect is off."""
        return np.array([u.coordinate(u.start) for u in self.unknowns])

    @property
    def one_sided(self) -> bool:
        """Whether the null is a bound of the effect's parameter."""
        low, high = self.unknowns[0].bounds
        return bool(self.null[0] <= low or self.null[0] >= high)

    def nulls(self) -> Iterator[FloatArray]:
        """Coordinates (d,) at which the effect is off, one after the other of what shapes it over its range, finely."""
        for k, unknown in enumerate(self.unknowns[1:], start=1):
            low, high = unknown.bounds
            for share in FINE_SHAPES:
                null = self.null
                null[k] = low + share * (high - low)
                yield null

    def shapes(self) -> Iterator[FloatArray]:
        """Coordinates (d,) at which the effect is off: the null, then what shapes it spread over its range."""
        yield self.null
        for rest in product(*(_spread(u) for u in self.unknowns[1:])):
            if not np.array_equal(rest, self.null[1:]):
                yield np.array([self.null[0], *rest])

    def grid(self, finely: bool = False) -> Iterator[FloatArray]:
        """Coordinates (d,) spread over the range, on both sides of the null, ``finely`` or not."""
        null = self.null
        shapes = [_spread(u) for u in self.unknowns[1:]]
        low, high = self.unknowns[0].bounds
        inner = float(np.clip(null[0], low, high))
        for bound in (low, high):
            reach = bound - inner
            if reach == 0.0:
                continue
            for share in FINE_GRID if finely else GRID:
                for rest in product(*shapes):
                    yield np.array([inner + share * reach, *rest])


def _spread(unknown: Unknown) -> FloatArray:
    low, high = unknown.bounds
    return np.linspace(low, high, SHAPE_GRID + 2)[:-1] if low == 0.0 else np.linspace(low, high, SHAPE_GRID)


def candidates(measured: Measured, specimen: Specimen) -> tuple[Candidate, ...]:
    """Every mechanism that can act on the model or its instruments and is not switched on already.

    Where a mechanism acts at two joints, each of them alone is a variant.
    """
    found: list[Candidate] = []
    refused = absent(measured)
    for name, mechanism in library(measured.model).items():
        if name in specimen.mechanisms or name in refused or mechanism.tabulated or not reads(mechanism, measured):
            continue
        if name in ("filter", "base_filter"):
            found += _filters(mechanism)
            continue
        plain = mechanism.parameters
        of_joints = mechanism.addressable(measured.model.name)[len(plain) :]
        for parameters in (plain, of_joints[0::2], of_joints[1::2]):
            if parameters:
                found += _with_whole_numbers_held(mechanism, parameters, measured)
    return tuple(found)


def firsts(some: Sequence[Candidate]) -> list[Candidate]:
    """Without further elements of a kind, which are tried beside the first."""
    return [candidate for candidate in some if not candidate.mechanism.beside]


def reads(mechanism: Mechanism, measured: Measured) -> bool:
    """Whether an instrument does anything to the channels that are compared; mechanisms of the model always may."""
    whole = mechanism.acts.keys() <= {"whole"}
    if not whole and mechanism.acts.keys() != {"response"}:
        return True
    if whole and measured.stretches is None:
        return False
    count = 512
    signals = {c: np.sin(np.arange(count) / 5.0) for c in measured.channels}
    values = {p.name: p.low if p.high == p.null else p.high for p in mechanism.parameters}
    around = Surroundings(0.01, np.cos(np.arange(count) / 5.0), 1.0, places=measured.places)
    found = mechanism.acts["whole" if whole else "response"](signals, values, around)
    return any(not np.array_equal(found[c], signals[c]) for c in signals)


def _with_whole_numbers_held(
    mechanism: Mechanism, parameters: Sequence[MechanismParameter], measured: Measured
) -> list[Candidate]:
    """One candidate for each choice of the whole-number parameters, which are no continuous unknowns."""
    declared = measured.identification.whole
    plain = [p.name for p in mechanism.parameters]
    whole = {p.name: declared.get(f"{mechanism.name}.{own}", ()) for p, own in zip(parameters, plain, strict=True)}
    unknowns = tuple(_unknown(mechanism, p, measured) for p in parameters if not whole[p.name])
    held = {f"{mechanism.name}.{name}": values for name, values in whole.items() if values}
    return [Candidate(mechanism, unknowns, dict(zip(held, chosen, strict=True))) for chosen in product(*held.values())]


def absent(measured: Measured) -> dict[str, str]:
    """Mechanisms that cannot be tried on these recordings, and why."""
    never: dict[str, str] = {}
    for place in measured.places.values():
        never |= measured.model.unplaced(place)
    if all(s.vertical_acts and s.vertical is not None for s in measured.shakings):
        never["vertical_acceleration"] = "the vertical motion of the base acts in the base model already"
    elif any(s.vertical is None for s in measured.shakings):
        never["vertical_acceleration"] = "not all recordings hold the vertical motion of the base"
    return never


def _unknown(mechanism: Mechanism, parameter: MechanismParameter, measured: Measured) -> Unknown:
    unknown = of_parameter(mechanism, parameter)
    if parameter.shape and parameter.unit == "rad":
        high = min(unknown.high, 0.9 * measured.reference_peak)
        return replace(unknown, high=high, scale=high / 20.0)
    if parameter.shape and unknown.low > 0.0 and unknown.high / unknown.low > 3.0:
        return replace(unknown, kind="log", scale=0.1)
    return unknown


def _filters(mechanism: Mechanism) -> list[Candidate]:
    """A low-pass and a high-pass, each of every order, the one run both ways too: these are no continuous unknowns."""
    found, both_ways = [], f"{mechanism.name}.zero_phase"
    for parameter in mechanism.parameters:
        if parameter.unit != "Hz":
            continue
        choices = {"order": ORDERS, "zero_phase": (0.0, 1.0)} if parameter.fit_inverse else {"order": ORDERS[:2]}
        own = {f"{mechanism.name}.{name}": each for name, each in choices.items() if name in mechanism.nulls}
        held = [dict(zip(own, chosen, strict=True)) for chosen in product(*own.values())]
        found += [
            Candidate(mechanism, (of_parameter(mechanism, parameter),), one, steep=one.get(both_ways) == 1.0)
            for one in held
        ]
    return found
