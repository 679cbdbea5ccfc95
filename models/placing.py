"""Where the bodies of a model are, so that instruments at any point of them can be predicted."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from models.base import FloatArray, Quantity, Values
from models.errors import InputError
from models.kinematics import Place
from models.observed import Observed


class Placing:
    """The part of a model that says where its bodies are.

    ``bodies``: how many rigid bodies `poses` places; ``across_alone``: they move sideways, and neither up nor round.
    Mechanisms with which it does not hold: ``not_placed``, a body is not rigid or not on its pivots; ``moves_pivots``,
    those move with the motion; ``turns_base``, readings that are not relative to the base lack what its rotation adds.
    """

    name: str
    observables: tuple[Quantity, ...]
    bodies: int = 0
    across_alone: bool = False
    not_placed: tuple[str, ...] = ()
    moves_pivots: tuple[str, ...] = ()
    turns_base: tuple[str, ...] = ()

    def poses(self, coefficients: Any, samples: FloatArray) -> Mapping[str, FloatArray]:
        """Poses ``(n, samples)`` of states as integrators return them (`models.kinematics.Poses`), without rotations.

        For body k = 1, 2, ... the displacement of the middle of its underside against the base, ``underside_k_x`` and
        ``underside_k_z`` (m), counted from rest, and its height over the base at rest, ``underside_k_height`` (m); its
        ``mass_k`` (kg) and, from that middle, its mass centre ``centre_k_x``, ``centre_k_z`` (m). With ``across_alone``
        the first, its rates (``velocity_k_x``, absolute ``acceleration_k_x``) and ``mass_k``.
        """
        return {}

    def with_poses(
        self, observables: Mapping[str, FloatArray], coefficients: Any, samples: FloatArray
    ) -> Mapping[str, FloatArray]:
        """The observables of states and the poses, each computed when it is asked for."""
        return Observed.joined(observables, self.poses(coefficients, samples))

    def bodies_of(self, values: Values) -> int:
        """How many bodies there are with these parameters."""
        return self.bodies

    def check_place(self, name: str, place: Place, values: Values) -> None:
        """Raises InputError where no body of these parameters has the channel ``name``, or it is an observable's name.

        And where it measures what bodies of the model do not do.
        """
        if any(name == quantity.name for quantity in self.observables):
            raise InputError(f"channel {name}: model {self.name} computes a quantity of this name: rename the channel.")
        bodies = self.bodies_of(values)
        if place.body > bodies:
            has = {0: "places no rigid body", 1: "has one body"}.get(bodies, f"has {bodies} bodies")
            raise InputError(
                f"channel {name} is on body {place.body} and model {self.name} {has}: leave the channel out, or use "
                "another model."
            )
        if self.across_alone and not place.across:
            raise InputError(
                f"channel {name} is {place.meaning}, and bodies of model {self.name} move to the right and left "
                "alone: leave the channel out."
            )

    def unplaced(self, place: Place) -> dict[str, str]:
        """Mechanisms with which the reading of ``place`` is not predicted, and why."""
        why = "it moves points of a body otherwise than a rigid body's, which channels at positions are predicted by"
        found = dict.fromkeys(self.not_placed, why)
        if place.quantity not in ("rotation", "angular_velocity"):
            found |= dict.fromkeys(self.moves_pivots, "it moves the pivots, which channels at positions do not follow")
        if place.absolute:
            why = "it turns the base, which absolute accelerations and load cells at positions are predicted without"
            found |= dict.fromkeys(self.turns_base, why)
        return found


def masses(like: FloatArray, *bodies: tuple[FloatArray, FloatArray, FloatArray]) -> dict[str, Callable[[], FloatArray]]:
    """Mass (kg) and mass centre (m; x, z) of each body, arrays (n,), as poses in the shape of ``like`` (n, samples)."""

    def lane(values: FloatArray) -> FloatArray:
        return np.broadcast_to(values[:, None], like.shape)

    names = ("mass_{}", "centre_{}_x", "centre_{}_z")
    return {
        name.format(k): partial(lane, values)
        for k, body in enumerate(bodies, start=1) for name, values in zip(names, body, strict=True)
    }  # fmt: skip
