"""The coefficients of one rocking block: what every integrator of the model starts from."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray, Values
from models.housner.cantilever import modal_integrals

REACHES = 3
"""Columns of `Block.table` before its values."""


@dataclass(frozen=True)
class Block:
    """Geometry, inertia and laws of n blocks, one array ``(n,)`` (float) a field, SI units.

    The body has mass ``mass`` (M), its mass centre at ``height`` (h) over the base and
    ``right``/``left`` (b+, b-) horizontally from the pivots on which it stands for theta > 0 and
    theta < 0; ``base_half_width`` (b) is half the base, before any inset; ``inertia`` (I) is about
    the mass centre. About a pivot I_O = I + M (h^2 + b^2).

    The base acceleration is ``offset + scale a(t)``, the apparent gravity
    G = ``gravity + vertical_factor scale a_z(t)``.
    Impact (see `models.housner.reference.impact`): ``restitution`` is a given absolute ratio (nan: angular
    momentum decides), times ``restitution_factor``, and the laws' coefficients.
    The remaining fields belong to mechanisms; their null switches them off.
    """

    mass: FloatArray
    height: FloatArray
    base_half_width: FloatArray
    right: FloatArray
    left: FloatArray
    inertia: FloatArray
    gravity: FloatArray
    offset: FloatArray
    vertical_factor: FloatArray
    # impact laws
    restitution: FloatArray
    restitution_factor: FloatArray
    aspect_coefficient: FloatArray
    amplitude_exponent: FloatArray
    aspect: FloatArray
    velocity_slope: FloatArray
    loss_per_impact: FloatArray
    restitution_floor: FloatArray
    contact_restitution: FloatArray
    # geometry that changes with the motion
    corner_radius: FloatArray
    crushing_rate: FloatArray
    joint_angle: FloatArray
    # couples: N m per rad, rad, N m s, N m, 1 (over I_O)
    stiffness: FloatArray
    gap: FloatArray
    viscous: FloatArray
    coulomb: FloatArray
    quadratic: FloatArray
    # base and body
    pitch_per_acceleration: FloatArray
    pitch_low_pass: FloatArray
    friction: FloatArray
    first_frequency: FloatArray
    # an oscillator that the base drives (`models.oscillator`)
    oscillator_motion: FloatArray
    oscillator_force: FloatArray
    oscillator_frequency: FloatArray
    oscillator_damping: FloatArray
    # the first cantilever mode phi (1 at the wall's top): integrals of phi^2, phi, phi z over the mass
    modal_mass: FloatArray
    modal_force: FloatArray
    modal_moment: FloatArray
    # a law in a table, (n, columns) as `models.housner.lanes.table` reads it but reaches for spacings; (n, 0) without
    table: FloatArray

    @property
    def size(self) -> int:
        return int(self.mass.size)

    def replace(self, **changes: Any) -> Block:
        """A copy with fields replaced; values broadcast to ``(n,)``."""
        arrays = {k: np.broadcast_to(np.asarray(v, float), self.mass.shape) for k, v in changes.items()}
        return replace(self, **arrays)

    def take(self, index: Any) -> Block:
        """The blocks selected by an index array or mask."""
        return replace(self, **{f.name: getattr(self, f.name)[index] for f in fields(self)})

    @property
    def half_width(self) -> FloatArray:
        """The smaller distance to a pivot: the side on which the block tips first."""
        return np.minimum(self.right, self.left)

    @property
    def slenderness(self) -> FloatArray:
        """alpha = atan(b/h) in rad, of the side that tips first."""
        return np.arctan2(self.half_width, self.height)

    @property
    def radius(self) -> FloatArray:
        """R in m, pivot to mass centre, of the side that tips first."""
        return np.hypot(self.half_width, self.height)

    @property
    def pivot_inertia(self) -> FloatArray:
        """I_O in kg m2, about the pivot of the side that tips first."""
        return self.inertia + self.mass * self.radius**2

    @property
    def frequency_parameter(self) -> FloatArray:
        """p = sqrt(M g R / I_O) in s-1."""
        p: FloatArray = np.sqrt(self.mass * self.gravity * self.radius / self.pivot_inertia)
        return p

    @property
    def momentum_restitution(self) -> FloatArray:
        """Housner's e = [I + M (h^2 - b+ b-)] / [I + M (h^2 + b^2)], the smaller of both directions.

        For b+ = b- it equals 1 - 2 M b^2 / I_O.
        """
        before = self.inertia + self.mass * (self.height**2 - self.right * self.left)
        after = self.inertia + self.mass * (self.height**2 + np.maximum(self.right, self.left) ** 2)
        e: FloatArray = before / after
        return e

    def clashes(self) -> list[str]:
        """Sentences about mechanisms that do not act together on some block."""
        if self.plain:
            return []
        slides, bounces = np.isfinite(self.friction), self.contact_restitution > 0.0
        bends = np.isfinite(self.first_frequency)
        found = []
        for one, first, other, second in (
            ("sliding", slides, "bounce", bounces),
            ("sliding", slides, "wall_flexibility", bends),
            ("bounce", bounces, "wall_flexibility", bends),
            ("rounded_corner", self.corner_radius > 0.0, "wall_flexibility", bends),
            ("crushing", self.crushing_rate > 0.0, "wall_flexibility", bends),
            ("flexible_joint", self.joint_angle > 0.0, "wall_flexibility", bends),
            ("coulomb_damping", self.coulomb > 0.0, "wall_flexibility", bends),
            ("table_force", self.tabulated, "sliding", slides),
            ("table_force", self.tabulated, "bounce", bounces),
            ("table_force", self.tabulated, "wall_flexibility", bends),
        ):
            if np.any(first & second):
                found.append(f"{one} and {other} do not act together in this model: leave one of them out")
        return found

    @property
    def tabulated(self) -> NDArray[np.bool_]:
        """Whether a law in a table acts (n,): its reaches alone do nothing."""
        return np.asarray(np.any(self.table[:, REACHES:] != 0.0, axis=1))

    @cached_property
    def plain(self) -> bool:
        """Whether no mechanism adds a couple, a rolling corner, pitch, sliding, flight or flexure."""
        zero = (
            self.corner_radius, self.crushing_rate, self.joint_angle, self.stiffness, self.viscous, self.coulomb,
            self.quadratic, self.pitch_per_acceleration, self.contact_restitution, self.oscillator_motion,
            self.oscillator_force,
        )  # fmt: skip
        rigid = np.isinf(np.stack((self.friction, self.first_frequency))).all()
        return bool(rigid and not np.stack(zero).any() and not np.any(self.tabulated))


def assemble(values: Values, vertical: bool, size: int | None = None) -> Block:
    """The block of the parameters alone, without mechanisms; ``values`` broadcast to ``(n,)``.

    Wall (m1, h1 = height/2, b = width/2) and top mass (m2, its centre h2 above the wall's top)
    move as one body:  S = m1 h1 + m2 (2 h1 + h2),  M = m1 + m2,  h = S/M,
    I = I1 + m1 (h - h1)^2 + I2 + m2 (2 h1 + h2 - h)^2. A solid rectangle has
    I1 = m1 (width^2 + height^2)/12.
    """
    given = {name: np.asarray(value, float) for name, value in values.items()}
    shape = np.broadcast_shapes(*(v.shape for v in given.values()), (size or 1,))

    def value(name: str, default: float) -> FloatArray:
        array = np.empty(shape)
        array[:] = given.get(name, default)
        return array

    height = value("height", np.nan)
    width = value("width", np.nan) if "width" in given else value("aspect_ratio", np.nan) * height
    mass, top = value("mass", np.nan), value("top_mass", 0.0)
    own = value("inertia", np.nan) if "inertia" in given else mass * (width**2 + height**2) / 12.0
    total = mass + top
    top_height = height + value("top_mass_height", 0.0)
    centre = (mass * height / 2.0 + top * top_height) / total
    inertia = (
        own + mass * (centre - height / 2.0) ** 2 + value("top_mass_inertia", 0.0) + top * (top_height - centre) ** 2
    )
    zero, one, infinite = np.zeros(shape), np.ones(shape), np.full(shape, np.inf)
    return Block(
        mass=total,
        height=centre,
        base_half_width=width / 2.0,
        right=width / 2.0,
        left=width / 2.0,
        inertia=inertia,
        gravity=value("gravity", 9.80665),
        offset=zero,
        vertical_factor=one if vertical else zero,
        restitution=value("restitution", np.nan),
        restitution_factor=one,
        aspect_coefficient=value("restitution_aspect_coefficient", 0.0),
        amplitude_exponent=value("restitution_amplitude_exponent", 0.0),
        aspect=width / height,
        velocity_slope=zero,
        loss_per_impact=zero,
        restitution_floor=zero,
        contact_restitution=zero,
        corner_radius=zero,
        crushing_rate=zero,
        joint_angle=zero,
        stiffness=zero,
        gap=zero,
        viscous=zero,
        coulomb=zero,
        quadratic=zero,
        pitch_per_acceleration=zero,
        pitch_low_pass=np.full(shape, 10.0),
        friction=infinite,
        first_frequency=infinite,
        oscillator_motion=zero,
        oscillator_force=zero,
        oscillator_frequency=np.ones(shape),
        oscillator_damping=np.full(shape, 0.05),
        table=np.zeros((int(np.prod(shape)), 0)),
        **modal_integrals(mass, height, top, value("top_mass_height", 0.0), value("top_mass_inertia", 0.0)),
    )
