"""Energy that the layers of walls with effects would give back, and the contact that their forces know."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from models.base import FloatArray
from models.interface.effects import FROZEN_OVER, Effects
from models.interface.fibres import Fibres
from models.interface.landing import lengths
from models.interface.layered import LayeredWall
from models.rubber.layer import Hidden

Ends = tuple[FloatArray, FloatArray]


def in_contact(ends: Ends, z: FloatArray, s: FloatArray) -> Ends:
    """Of stretches (n,) the part on which z - x s < 0."""
    low, high = ends
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        root = np.where(s == 0.0, np.where(z < 0.0, -np.inf, np.inf), z / s)
    first = np.clip(np.where(s >= 0.0, root, low), low, high)
    return first, np.clip(np.where(s < 0.0, root, high), first, high)


def frozen_share(z: FloatArray, lift: FloatArray, static: FloatArray) -> FloatArray:
    """Of the half that lifts, the share that a frozen contact keeps: 1 closed, 0 open; ``lift`` = b |S|."""
    open_by = np.clip((z + lift) / (FROZEN_OVER * static), 0.0, 1.0)
    return np.asarray(1.0 - open_by * open_by * (3.0 - 2.0 * open_by))


def torn(effects: Effects, half: FloatArray, z: FloatArray, s: FloatArray, memory: Sequence[FloatArray]) -> Ends:
    """Ends (m) of what is bonded still at z, S, ``memory`` those so far; the first is the larger where nothing is."""
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        front = (z - effects.tearing) / s
    left = np.where(s > 0.0, np.maximum(memory[0], np.minimum(front, half)), memory[0])
    right = np.where(s < 0.0, np.minimum(memory[1], np.maximum(front, -half)), memory[1])
    return left, right


def _springs(k: FloatArray, z: FloatArray, s: FloatArray, ends: Ends) -> FloatArray:
    """k/2 times the integral of (z - x s)^2 (J)."""
    low, high = ends
    d1, d2, d3 = high - low, (high**2 - low**2) / 2.0, (high**3 - low**3) / 3.0
    return np.asarray(0.5 * k * (z * z * d1 - 2.0 * z * s * d2 + s * s * d3))


def _frozen(k: FloatArray, z: FloatArray, s: FloatArray, b: FloatArray, share: FloatArray) -> FloatArray:
    """Of a contact frozen at the half that presses and a ``share`` of the other one (J)."""
    lean = np.abs(s)
    return _springs(k, z, lean, (0.0 * b, b)) + share * _springs(k, z, lean, (-b, 0.0 * b))


def base_springs(wall: LayeredWall, z: FloatArray, s: FloatArray, memory: Sequence[FloatArray]) -> FloatArray:
    """Of the linear law at the base at z, S (J), (n,); ``memory``: closings and the ends of what is bonded."""
    e, b = wall.effects or Effects.none(wall.size), wall.base_half_width
    wear = wall.base_stiffness * e.wear(memory[0])
    share = frozen_share(z, b * np.abs(s), static_compressions(wall)[0])
    found = np.zeros(wall.size)
    for low, high, side in ((-b, 0.0 * b, e.left), (0.0 * b, b, e.right)):
        k = wear * side
        left, right = torn(e, b, z, s, memory[1:])
        held = np.clip(left, low, high), np.clip(right, low, high)
        held = held[0], np.maximum(held[0], held[1])
        exact = _springs(k, z, s, in_contact((low, high), z, s))
        exact += _springs(k, z, s, held) - _springs(k, z, s, in_contact(held, z, s))
        pressing = (low < 0.0) == (s < 0.0)
        half = _springs(k, z, s, (low, high)) * np.where(pressing, 1.0, share)
        found += (1.0 - e.frozen_base) * exact + e.frozen_base * half
    return found


def static_compressions(wall: LayeredWall) -> tuple[FloatArray, FloatArray]:
    """Compression (m) of both layers under their weight, as the linear law has it; 1 where bonded."""
    found = []
    for joint, mass, b, k in (
        ("base", wall.mass, wall.base_half_width, wall.base_stiffness),
        ("top", wall.mass_2, wall.top_half_width, wall.top_stiffness),
    ):
        there = joint in wall.rubber_joints
        found.append(mass * wall.gravity / (2.0 * b * k) if there else np.ones(wall.size))
    return found[0], found[1]


def stored(
    wall: LayeredWall,
    q: FloatArray,
    memory: Sequence[FloatArray],
    landed: FloatArray,
    hidden: Mapping[str, Hidden],
) -> FloatArray:
    """Energy (J) of the base and the top joint (n, 2) at q (n, 8): layers across and along, and the couples' spring.

    ``memory``: closings, ends of what is bonded; ``landed`` (n, 2, `CELLS`): slips at landing; ``hidden``: states of
    the laws by joint.
    """
    e, found = wall.effects or Effects.none(wall.size), np.zeros((wall.size, 2))
    t1, t2, z1, z2, x1, x2, tm, _ = q.T
    wear = e.wear(memory[0])
    if wall.joints != "top":
        b, s = wall.base_half_width, np.sin(t1)
        low, high = in_contact((-b, b), z1, s)
        along = np.where(np.isfinite(e.shear_base), e.shear_base, 0.0) * wall.base_stiffness
        sheared = np.sum(lengths(b, low, high) * (x1[:, None] - landed[:, 0]) ** 2, axis=1)
        found[:, 0] = base_springs(wall, z1, s, memory) + 0.5 * along * sheared
        found[:, 0] += 0.5 * e.couple_stiffness * np.maximum(np.abs(t1) - e.couple_gap, 0.0) ** 2
        if "base" in hidden:
            found[:, 0] += (1.0 - e.frozen_base) * Fibres(wall, "base").energy(z1, t1, hidden["base"], wear)
    if wall.joints != "base":
        b, turn = wall.top_half_width, t2 - tm
        s, k = np.sin(turn), wall.top_stiffness
        low, high = in_contact((-b, b), z2, s)
        share = frozen_share(z2, b * np.abs(s), static_compressions(wall)[1])
        found[:, 1] = (1.0 - e.frozen_top) * _springs(k, z2, s, (low, high))
        found[:, 1] += e.frozen_top * _frozen(k, z2, s, b, share)
        sheared = np.sum(lengths(b, low, high) * (x2[:, None] - landed[:, 1]) ** 2, axis=1)
        found[:, 1] += 0.5 * np.where(np.isfinite(e.shear_top), e.shear_top, 0.0) * k * sheared
        if "top" in hidden:
            found[:, 1] += (1.0 - e.frozen_top) * Fibres(wall, "top").energy(z2, turn, hidden["top"])
    return found
