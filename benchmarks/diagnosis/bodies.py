"""Two bodies, one on the other, of a benchmark's cases: what is of one model, and what moves as it truly does."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from benchmarks.diagnosis.effects import Hidden
from benchmarks.diagnosis.open_laws import Law
from benchmarks.diagnosis.scene import FloatArray, Unsuitable
from models.model import Model
from models.shaking import Shaking

ROTATIONS = ("rotation_1", "rotation_2")
HELD = (*ROTATIONS, "rotation_rate_1", "rotation_rate_2")
FALLEN = 1.0
"""rad, of a body that no longer stands."""
Values = Mapping[str, float]
Motion = tuple[str, Shaking, float]
"""Name and motion of a recording, and the largest rotation (rad) of the lower body without effects."""


class Apart(Protocol):
    """A program apart: rotations and rates (`HELD`) of two bodies at the shaking's steps, nan once one falls.

    ``coarse``: as precisely as the search for a size needs. ``kicks``: scatter of its impacts at the base, the change
    of theta'_after over theta'_before; None of bodies that have no impacts (`Bodies.impacts`).
    """

    def __call__(
        self, values: Values, mechanisms: Values, shaking: Shaking, law: Law | None, numbers: Sequence[float],
        largest: float, coarse: bool, kicks: FloatArray | None,
    ) -> dict[str, FloatArray]: ...  # fmt: skip


@dataclass(frozen=True)
class Bodies:
    """What is of one model: its catalogue, its specimens, its motions and the program apart.

    ``refitted``: parameters that a refit moves, with their relative tolerances; ``calibrated``: ranges of those that
    the specimen leaves open. ``window(values)``: s. ``specimen(rng)``: nominal and true values; ``motion(true, rng,
    low_pass)``: a motion under which it moves well. ``knows``: whether the program apart can take a law; ``impacts``:
    whether its bodies have any, which may scatter.
    """

    model: Model
    catalogue: Mapping[str, Hidden]
    tolerance: Values
    refitted: Values
    window: Callable[[Values], float]
    specimen: Callable[[np.random.Generator], tuple[dict[str, float], dict[str, float]]]
    motion: Callable[[Values, np.random.Generator, float], Motion]
    apart: Apart
    knows: Callable[[Law], bool]
    calibrated: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    impacts: bool = False

    def bounds(self, name: str, true: float) -> tuple[float, float]:
        """Of the logarithm of a refitted parameter over its ``true`` value; three tolerances where it has one."""
        if name not in self.calibrated:
            return -3.0 * self.refitted[name], 3.0 * self.refitted[name]
        low, high = self.calibrated[name]
        return float(np.log(low / true)), float(np.log(high / true))


@dataclass(frozen=True)
class Truth:
    """Two bodies, what is missing in them, and whether a program ``apart`` moves them, or the lanes."""

    of: Bodies
    values: Values
    mechanisms: Values
    apart: bool
    law: Law | None = None
    numbers: tuple[float, ...] = (0.0,) * 7
    largest: float = 1.0
    kicks: FloatArray | None = None

    def rotations(self, shaking: Shaking, coarse: bool = False) -> dict[str, FloatArray]:
        """Rotations (rad) and their rates at the shaking's steps. Raises Unsuitable where a body falls."""
        if self.apart:
            found = self.of.apart(
                self.values, self.mechanisms, shaking, self.law, self.numbers, self.largest, coarse, self.kicks
            )
        else:
            channels = self.of.model.simulate({**self.values, **self.mechanisms}, shaking).channels
            found = {name: channels[name] for name in HELD}
        if not all(np.max(np.abs(found[name])) < FALLEN for name in ROTATIONS):  # nan too
            raise Unsuitable
        return found
