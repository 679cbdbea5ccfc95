"""The coefficients of two stacked blocks: what every integrator of the model starts from."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from models.base import FloatArray, Values
from models.walls import bodies


@dataclass(frozen=True)
class Stack:
    """Geometry, inertia and laws of n walls with a block on top, one array ``(n,)`` a field, SI units.

    Block 1 (the wall) has its mass centre at ``centre_1`` (h1) over the base and its top at
    ``height_1`` (2 h1); block 2 has its mass centre at ``centre_2`` (h2) over that. ``inertia_1``,
    ``inertia_2`` are about the mass centres. The joints reach +-``half_length_1`` and
    +-``half_joint`` from their middle, their pivots lie at +-``base_pivot`` (b1) and +-``top_pivot``
    (b2), the mass centres ``shift_1`` and ``shift_2`` to the right of it.

    The base acceleration is ``offset + scale a(t)``, the apparent gravity
    G = ``gravity + vertical_factor scale a_z(t)``.
    ``base_restitution``, ``top_restitution``: given ratio of the relative angular velocities at a
    joint (nan: by projection), times ``base_factor``, ``top_factor``; see `models.stacked.reference.impact`.
    ``viscous``: couple on block 1 over the inertia of both about the corner and over theta_1', s-1.
    ``coulomb``: couple of dry friction (N m) on block 1 against theta_1', see `models.stacked.equation`.
    ``pitch_per_acceleration`` (rad s2 m-1), ``pitch_low_pass`` (Hz): of the base, see `models.pitch`.
    """

    mass_1: FloatArray
    inertia_1: FloatArray
    centre_1: FloatArray
    height_1: FloatArray
    mass_2: FloatArray
    inertia_2: FloatArray
    centre_2: FloatArray
    half_length_1: FloatArray
    half_joint: FloatArray
    base_pivot: FloatArray
    top_pivot: FloatArray
    shift_1: FloatArray
    shift_2: FloatArray
    gravity: FloatArray
    offset: FloatArray
    vertical_factor: FloatArray
    base_restitution: FloatArray
    top_restitution: FloatArray
    base_factor: FloatArray
    top_factor: FloatArray
    viscous: FloatArray
    coulomb: FloatArray
    pitch_per_acceleration: FloatArray
    pitch_low_pass: FloatArray

    @property
    def size(self) -> int:
        return int(self.mass_1.size)

    def replace(self, **changes: Any) -> Stack:
        """A copy with fields replaced; values broadcast to ``(n,)``."""
        arrays = {k: np.broadcast_to(np.asarray(v, float), self.mass_1.shape) for k, v in changes.items()}
        return replace(self, **arrays)

    def take(self, index: Any) -> Stack:
        """The walls selected by an index array or mask."""
        return replace(self, **{f.name: getattr(self, f.name)[index] for f in fields(self)})

    def one(self, lane: int = 0) -> Stack:
        """One wall with plain floats in its fields, for code that runs a wall at a time."""
        floats: dict[str, Any] = {f.name: float(getattr(self, f.name)[lane]) for f in fields(self)}
        return replace(self, **floats)

    @cached_property
    def mass(self) -> FloatArray:
        """M = m1 + m2 in kg."""
        return self.mass_1 + self.mass_2

    @cached_property
    def centre(self) -> FloatArray:
        """Height in m of the mass centre of both as one body."""
        return (self.mass_1 * self.centre_1 + self.mass_2 * (self.height_1 + self.centre_2)) / self.mass

    @cached_property
    def shift(self) -> FloatArray:
        """The mass centre of both as one body, in m to the right of the middle."""
        return (self.mass_1 * self.shift_1 + self.mass_2 * self.shift_2) / self.mass

    @cached_property
    def half_width(self) -> FloatArray:
        """b in m of both as one body: from its mass centre to the nearer pivot of the base."""
        return self.base_pivot - np.abs(self.shift)

    @cached_property
    def half_width_2(self) -> FloatArray:
        """b in m of block 2: from its mass centre to the nearer pivot of the top joint."""
        return self.top_pivot - np.abs(self.shift_2)

    @cached_property
    def slenderness(self) -> FloatArray:
        """alpha = atan(b/h) in rad of both as one body."""
        return np.arctan2(self.half_width, self.centre)

    @cached_property
    def slenderness_2(self) -> FloatArray:
        """alpha in rad of block 2 on a base of its own."""
        return np.arctan2(self.half_width_2, self.centre_2)

    @property
    def height_2(self) -> FloatArray:
        """Height in m of block 2's mass centre over the base."""
        return self.height_1 + self.centre_2

    @property
    def frame_inertia(self) -> tuple[FloatArray, FloatArray]:
        """Couples (kg m2) over -psi'' on theta_1 and on r: both bodies about the middle of the base, upright."""
        whole = self.inertia_1 + self.mass_1 * self.centre_1**2 + self.inertia_2 + self.mass_2 * self.height_2**2
        return whole, self.inertia_2 + self.mass_2 * self.height_2 * self.centre_2

    def corner_inertia(self, side: Any) -> FloatArray:
        """I_O in kg m2 of both as one body about the base pivot on ``side`` (1 or -1)."""
        arm_1, arm_2 = side * self.base_pivot - self.shift_1, side * self.base_pivot - self.shift_2
        return np.asarray(
            self.inertia_1
            + self.mass_1 * (self.centre_1**2 + arm_1**2)
            + self.inertia_2
            + self.mass_2 * ((self.height_1 + self.centre_2) ** 2 + arm_2**2)
        )

    @cached_property
    def frequency_parameter(self) -> FloatArray:
        """p = sqrt(M g R / I_O) in s-1 of both as one body, about the nearer pivot."""
        side = np.where(self.shift >= 0.0, 1.0, -1.0)
        radius = np.hypot(self.half_width, self.centre)
        return np.asarray(np.sqrt(self.mass * self.gravity * radius / self.corner_inertia(side)))

    @cached_property
    def frequency_parameter_2(self) -> FloatArray:
        """p in s-1 of block 2 on a base of its own."""
        radius = np.hypot(self.half_width_2, self.centre_2)
        corner = self.inertia_2 + self.mass_2 * radius**2
        return np.asarray(np.sqrt(self.mass_2 * self.gravity * radius / corner))

    @cached_property
    def momentum_restitution(self) -> FloatArray:
        """e of both as one body, the smaller of both directions; 1 - 2 M b^2/I_O without eccentricity."""
        far = np.maximum(self.corner_inertia(1.0), self.corner_inertia(-1.0))
        return np.asarray(1.0 - 2.0 * self.mass * self.base_pivot * (self.base_pivot + np.abs(self.shift)) / far)


def assemble(values: Values, vertical: bool, size: int | None = None) -> Stack:
    """The stack of the parameters alone, without mechanisms; ``values`` broadcast to ``(n,)``.

    The top joint is as long as the shorter body, so a top block longer than the wall rocks on the
    wall's corners.
    """
    body = bodies(values, size)
    shape = body.mass_1.shape
    zero, one = np.zeros(shape), np.ones(shape)

    def given(name: str) -> FloatArray:
        return np.broadcast_to(np.asarray(values.get(name, np.nan), dtype=np.float64), shape)

    return Stack(
        mass_1=body.mass_1,
        inertia_1=body.inertia_1,
        centre_1=body.half_height_1,
        height_1=2.0 * body.half_height_1,
        mass_2=body.mass_2,
        inertia_2=body.inertia_2,
        centre_2=body.half_height_2,
        half_length_1=body.half_length_1,
        half_joint=body.half_joint,
        base_pivot=body.half_length_1,
        top_pivot=body.half_joint,
        shift_1=zero,
        shift_2=zero,
        gravity=body.gravity,
        offset=zero,
        vertical_factor=one if vertical else zero,
        base_restitution=given("base_restitution"),
        top_restitution=given("top_restitution"),
        base_factor=one,
        top_factor=one,
        viscous=zero,
        coulomb=zero,
        pitch_per_acceleration=zero,
        pitch_low_pass=np.full(shape, 10.0),
    )


def at_joint(values: Values, name: str, joint: str) -> Any:
    """A mechanism's parameter at ``joint`` (base, top): ``name_joint`` if given, else ``name``."""
    return values.get(f"{name}_{joint}", values[name])
