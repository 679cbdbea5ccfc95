"""What an instrument on a rigid body reads, from the pose of the body: once for all models, for rotations of any size.

A point p = (x, z) of a body, from the middle of its underside, is displaced against the base by

    d = U + Rot(theta) p - p,      Rot(t)(x, z) = (x cos t + z sin t, -x sin t + z cos t),

U the displacement of that middle, theta the rotation, clockwise positive. Models give U and theta (`Model.poses`).

Rates are differences of samples: velocity (d_k+1 - d_k-1)/(2 dt), acceleration (d_k+1 - 2 d_k + d_k-1)/dt^2. The latter
is exactly the mean of the true acceleration over one sample on either side, weighted by a triangle, so an impact's jump
of velocity dv is a reading of dv/dt and the sum over time keeps it. Both are in error by O(dt^2) between impacts. The
first and last sample repeat their neighbours' (`Place.order`).

Of bodies that move sideways alone models give the rates too, so that nothing is differentiated: a difference of the
relative motion does not cancel, sample by sample, with the motion of the base that is added to it, and an isolated
body's acceleration is the small rest of both.

What a joint carries follows from the bodies above it: by Newton's law the force on them is the sum of m_k times the
absolute accelerations of their mass centres, and their weight. No law of contact is needed for it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray
from models.shaking import Shaking

GRAVITY = 9.80665
"""m s-2, in the readings of accelerometers."""
UNITS = {
    "displacement": "m", "velocity": "m s-1", "acceleration": "m s-2", "rotation": "rad",
    "angular_velocity": "rad s-1", "uplift": "m", "compression": "m", "force": "N",
}  # fmt: skip
DIRECTIONS = ("x", "z", "across", "along")
REFERENCES = ("base", "body_below", "absolute")

Poses = Mapping[str, FloatArray]
"""``underside_k_x``, ``underside_k_z``: U of body k (m); ``underside_k_height``: of its underside over the base at rest
(m); ``rotation_k`` (rad); ``mass_k`` (kg) and ``centre_k_x``, ``centre_k_z``: its mass centre from the middle of its
underside (m): arrays (..., samples). Of bodies that move sideways alone ``underside_k_x`` and ``mass_k``, with
``velocity_k_x`` against the base (m s-1) and the absolute ``acceleration_k_x`` (m s-2)."""


@dataclass(frozen=True)
class Place:
    """What one instrument measures: a ``quantity`` of a ``body`` at (``x``, ``z``) m, in a ``direction``.

    Position from the middle of the body's underside, turning with it. Directions ``x`` (right) and ``z`` (up) stay,
    ``across`` and ``along`` are the body's own x and z. ``relative_to`` base, absolute, or body_below (in the axes of
    that body, from the point of it that lay there at rest). An accelerometer that turns (across, along) feels gravity,
    less its reading at rest: across (a_x cos - (a_z + g) sin), along (a_x sin + (a_z + g) cos - g), sin, cos of theta.
    Uplift is the opening of the joint under the body at x, compression its opposite. A force is what load cells under
    the body exert on it, in direction x or z, less its reading at rest.
    """

    quantity: str
    body: int = 1
    x: float = 0.0
    z: float = 0.0
    direction: str = "x"
    relative_to: str = "base"

    @property
    def unit(self) -> str:
        return UNITS[self.quantity]

    @property
    def order(self) -> int:
        """How many times the pose is differentiated."""
        return {"velocity": 1, "angular_velocity": 1, "acceleration": 2, "force": 2}.get(self.quantity, 0)

    @property
    def absolute(self) -> bool:
        """Whether the base's own acceleration is read though nothing moves on it."""
        return self.quantity == "force" or (self.quantity == "acceleration" and self.relative_to == "absolute")

    @property
    def across(self) -> bool:
        """Whether it is read on a body that moves sideways alone, without turning."""
        of_points = ("displacement", "velocity", "acceleration", "force")
        return self.quantity in of_points and self.direction in ("x", "across")

    @property
    def meaning(self) -> str:
        """In words, for a label."""
        of = f"{self.quantity.replace('_', ' ')} of body {self.body}"
        if self.quantity in ("rotation", "angular_velocity"):
            return f"{of}, clockwise positive"
        if self.quantity in ("uplift", "compression"):
            return f"{self.quantity} of the joint under body {self.body} at x = {self.x:g} m"
        if self.quantity == "force":
            return f"force of the joint under body {self.body} on it, {self.direction}, less that at rest"
        relative = "" if self.relative_to == "absolute" else f", relative to the {self.relative_to.replace('_', ' ')}"
        return f"{of} at ({self.x:g}, {self.z:g}) m, {self.direction}{relative}"

    def read(self, poses: Poses, time_step: float, ground: tuple[FloatArray, FloatArray]) -> FloatArray:
        """Readings (..., samples); ``ground``: accelerations of the base (`ground_along`), that broadcast."""
        if self.across and f"acceleration_{self.body}_x" in poses:
            return self._read_across(poses, ground[0])
        theta = poses[f"rotation_{self.body}"]
        if self.quantity == "rotation":
            return theta
        if self.quantity == "angular_velocity":
            return first_difference(theta, time_step)
        if self.quantity in ("uplift", "compression"):
            opening = displaced(poses, self.body, self.x, 0.0, "body_below")[1]
            return opening if self.quantity == "uplift" else -opening
        if self.quantity == "force":
            return carried(poses, self.body, time_step, ground)[self.direction == "z"]
        moved = displaced(poses, self.body, self.x, self.z, self.relative_to)
        if self.order:
            differ = first_difference if self.order == 1 else second_difference
            moved = differ(moved[0], time_step), differ(moved[1], time_step)
        turns = self.direction in ("across", "along")
        rest = 0.0
        if self.quantity == "acceleration" and self.relative_to == "absolute":
            rest = GRAVITY if turns else 0.0
            moved = moved[0] + ground[0], moved[1] + ground[1] + rest
        if not turns:
            return moved[0] if self.direction == "x" else moved[1]
        sine, cosine = np.sin(theta), np.cos(theta)
        if self.direction == "across":
            return np.asarray(moved[0] * cosine - moved[1] * sine)
        return np.asarray(moved[0] * sine + moved[1] * cosine - rest)

    def _read_across(self, poses: Poses, base: FloatArray) -> FloatArray:
        """Readings of a body that moves sideways alone."""
        k = self.body
        if self.quantity == "displacement":
            below = poses[f"underside_{k - 1}_x"] if self.relative_to == "body_below" and k > 1 else 0.0
            return np.asarray(poses[f"underside_{k}_x"] - below)
        if self.quantity == "velocity":
            return poses[f"velocity_{k}_x"]
        if self.quantity == "acceleration":
            return np.asarray(poses[f"acceleration_{k}_x"] - (base if self.relative_to == "base" else 0.0))
        force = np.zeros_like(poses["acceleration_1_x"])
        while f"mass_{k}" in poses:
            force += poses[f"mass_{k}"] * poses[f"acceleration_{k}_x"]
            k += 1
        return force


def carried(
    poses: Poses, body: int, time_step: float, ground: tuple[FloatArray, FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Force (N) to the right and up by which the joint under a body acts on it, less that at rest."""
    across, up = np.zeros_like(poses[f"rotation_{body}"]), np.zeros_like(poses[f"rotation_{body}"])
    while f"mass_{body}" in poses:
        moved = _displaced(poses, body, poses[f"centre_{body}_x"], poses[f"centre_{body}_z"])
        mass = poses[f"mass_{body}"]
        across += mass * (second_difference(moved[0], time_step) + ground[0])
        up += mass * (second_difference(moved[1], time_step) + ground[1])
        body += 1
    return across, up


def displaced(poses: Poses, body: int, x: float, z: float, relative_to: str) -> tuple[FloatArray, FloatArray]:
    """Displacement (m) of a point of a body against the base, or in the axes of the body below against that."""
    here = _displaced(poses, body, x, z)
    if relative_to != "body_below" or body == 1:
        return here
    below = body - 1
    height = poses[f"underside_{body}_height"] - poses[f"underside_{below}_height"]
    there = _displaced(poses, below, x, z + height)
    turn = poses[f"rotation_{below}"]
    dx, dz, sine, cosine = here[0] - there[0], here[1] - there[1], np.sin(turn), np.cos(turn)
    return np.asarray(dx * cosine - dz * sine), np.asarray(dx * sine + dz * cosine)


def _displaced(poses: Poses, body: int, x: float | FloatArray, z: float | FloatArray) -> tuple[FloatArray, FloatArray]:
    theta = poses[f"rotation_{body}"]
    sine, less = np.sin(theta), 2.0 * np.sin(0.5 * theta) ** 2  # 1 - cos, without cancellation
    across = poses[f"underside_{body}_x"] + z * sine - x * less
    return np.asarray(across), np.asarray(poses[f"underside_{body}_z"] - x * sine - z * less)


def first_difference(values: FloatArray, time_step: float) -> FloatArray:
    """Central difference (..., samples) over two samples."""
    inner = (values[..., 2:] - values[..., :-2]) / (2.0 * time_step)
    return _with_ends(inner)


def second_difference(values: FloatArray, time_step: float) -> FloatArray:
    """Second difference (..., samples): the acceleration's mean under a triangle of one sample on either side."""
    inner = (values[..., 2:] - 2.0 * values[..., 1:-1] + values[..., :-2]) / time_step**2
    return _with_ends(inner)


def _with_ends(inner: FloatArray) -> FloatArray:
    return np.pad(inner, [(0, 0)] * (inner.ndim - 1) + [(1, 1)], mode="edge")


def ground_along(shaking: Shaking, first: NDArray[np.int64], samples: int) -> tuple[FloatArray, FloatArray]:
    """Accelerations (n, samples) of the base to the right and up from each of the samples ``first`` (n,) on.

    m s-2; whether the vertical one acts on the wall or not; 0 without one and beyond the end.
    """
    index = first[:, None] + np.arange(samples)
    inside, last = index < shaking.horizontal.size, shaking.horizontal.size - 1
    across = np.where(inside, shaking.horizontal[np.minimum(index, last)], 0.0)
    if shaking.vertical is None:
        return across, np.zeros_like(across)
    return across, np.where(inside, shaking.vertical[np.minimum(index, last)], 0.0)
