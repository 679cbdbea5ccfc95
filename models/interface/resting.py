"""Where a wall stands under its own weight: closed form upright, Newton's rule where something makes it lean."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray
from models.interface.chain import SIZE, chain, free_coordinates, masses
from models.interface.effects import Effects
from models.interface.fibres import Fibres
from models.interface.layered import LayeredWall
from models.interface.stored import in_contact
from models.interface.table import TABLES, LawInTable
from models.lanes.tables import groups

ITERATIONS = 40
SMALL, FARTHEST = 1e-8, 0.05
"""Step (rad or m) of the differences that give Newton's rule its slopes, and the farthest that it goes at once."""
CLOSE = 1e-9
"""Unbalanced force over the weight at which a wall counts as at rest."""


def upright(wall: LayeredWall) -> FloatArray:
    """q ``(n, 4)`` at rest of walls that nothing makes lean; nan where a law cannot carry the load, 0 if bonded."""
    return wall.once(_upright)


def at_rest(wall: LayeredWall) -> FloatArray:
    """q ``(n, 8)`` (`models.interface.chain`) at rest under gravity, relaxed; nan where there is no such place."""
    return wall.once(_at_rest)


def _upright(wall: LayeredWall) -> FloatArray:
    state = np.zeros((wall.size, 4))
    for joint, column, mass, half, stiffness, thickness in (
        ("base", 2, wall.mass, wall.base_half_width, wall.base_stiffness, wall.base_thickness),
        ("top", 3, wall.mass_2, wall.top_half_width, wall.top_stiffness, wall.top_thickness),
    ):
        if joint in wall.rubber_joints:
            load, layer = mass * wall.gravity / (2.0 * half), wall.layer(joint)
            most = np.maximum(thickness, 4.0 * load / stiffness)
            state[:, column] = -layer.static_compression(load, most) if layer.laws else -load / stiffness
    return state


def leans(wall: LayeredWall) -> NDArray[np.bool_]:
    """Which walls (n,) do not stand upright and uncompressed along their axis."""
    found = wall.offset != 0.0
    if wall.effects is not None:
        e = wall.effects
        found = found | (e.top_offset != 0.0) | (e.left != 1.0) | (e.right != 1.0) | np.isfinite(e.bending)
        for name, _ in TABLES.rows if e.law else ():
            found = found | (e.law[name] != 0.0)
    return np.asarray(found)


def _at_rest(wall: LayeredWall) -> FloatArray:
    found = np.concatenate([upright(wall), np.zeros((wall.size, SIZE - 4))], axis=1)
    lanes = np.flatnonzero(leans(wall) & ~np.any(np.isnan(found), axis=1))
    if lanes.size:
        # walls of one kind stand alike, as the windows of a recording
        _, first, kind = np.unique(_numbers(wall.take(lanes)), axis=0, return_index=True, return_inverse=True)
        some = lanes[first]
        found[lanes] = _leaning_of_all_kinds(wall.take(some), found[some])[kind.reshape(-1)]
    return found


def _numbers(wall: LayeredWall) -> FloatArray:
    """All that describes n walls, (n, m)."""
    found = [value for value in vars(wall).values() if isinstance(value, np.ndarray)] + list(wall.laws.values())
    if wall.effects is not None:
        found += list(wall.effects.arrays.values())
    return np.stack(found, axis=1)


def _leaning_of_all_kinds(wall: LayeredWall, guess: FloatArray) -> FloatArray:
    """As `_leaning`, walls with the same free coordinates together."""
    effects = wall.effects or Effects.none(wall.size)
    wall, found = wall.with_effects(effects), np.full(guess.shape, np.nan)
    ratios = effects.shear_base, effects.shear_top, effects.friction, effects.bending
    for _, lanes in groups(*(np.isfinite(ratio) for ratio in ratios)):
        found[lanes] = _leaning(wall.take(lanes), guess[lanes])
    return found


def _leaning(wall: LayeredWall, guess: FloatArray) -> FloatArray:
    """q (n, 8) of walls with effects from where they would stand upright; nan of those that do not stand."""
    free, force = free_coordinates(wall.take([0]), moving=False), _unbalanced(wall)
    count, weight = free.shape[1], wall.mass * wall.gravity
    friction = np.full(wall.size, np.inf) if wall.effects is None else wall.effects.friction
    p = guess @ np.linalg.pinv(free).T
    probes = np.concatenate([np.zeros((count, 1)), SMALL * np.eye(count), -SMALL * np.eye(count)], axis=1)
    found = np.full(guess.shape, np.nan)
    for _ in range(ITERATIONS):
        near = np.tensordot(free, p.T[:, :, None] + probes[:, None, :], 1)
        whole = force(near)
        residual = np.tensordot(free.T, whole, 1)
        slopes = np.moveaxis(residual[:, :, 1 : count + 1] - residual[:, :, count + 1 :], 1, 0) / (2.0 * SMALL)
        there = np.max(np.abs(residual[:, :, 0]), axis=0) < CLOSE * weight
        # a balance that gives way is no place to rest
        firm = np.max(np.linalg.eigvals(slopes).real, axis=1) < 0.0
        firm &= np.abs(whole[4, :, 0]) < np.maximum(friction, CLOSE) * weight
        found[there & firm] = p[there & firm] @ free.T
        if np.all(there):
            break
        # a wall that has toppled over leaves no slope
        step = np.linalg.pinv(slopes) @ residual[:, :, 0].T[:, :, None]
        p = p - np.clip(step[:, :, 0], -FARTHEST, FARTHEST)
    return found


def _unbalanced(wall: LayeredWall) -> Callable[[FloatArray], FloatArray]:
    """Generalised forces (8, n, m) on n walls with effects at rest at q (8, n, m), their rubber relaxed there."""
    one = wall.take((slice(None), None))  # columns, for many places of each wall
    effects: Any = one.effects
    mass = masses(one)[0]
    fibres = {joint: Fibres(wall, joint) for joint in wall.rubber_joints if wall.laws_at(joint)}
    law = LawInTable(one) if effects.law else None

    def laws(joint: str, z: FloatArray, angle: FloatArray) -> tuple[FloatArray, FloatArray]:
        force, moment = np.zeros(z.shape), np.zeros(z.shape)
        if joint in fibres:
            for k in range(z.shape[1]):
                still = fibres[joint].relaxed(z[:, k], angle[:, k])
                more = fibres[joint].difference((z[:, k], angle[:, k], 0.0, 0.0), still)
                force[:, k], moment[:, k] = more.force, more.moment
        return force, moment

    def force(q: FloatArray) -> FloatArray:
        at = chain(one, q, np.zeros_like(q))
        pull = mass * (one.offset + 1j * one.gravity)
        found = -np.sum((np.conj(at.jacobians) * pull[:, None]).real, axis=0)
        t1, t2, z1, z2, x1, x2, tm, zm = q
        over = np.maximum(np.abs(t1) - effects.couple_gap, 0.0)
        found[0] -= effects.couple_stiffness * np.copysign(over, t1)
        if law is not None:
            couple_b, couple_t, push = law.forces((t1, 0.0), (t2 - tm, 0.0), (at.places[2].real, 0.0), one.offset)
            found += push * at.jacobians[2].real
            found[0] += couple_b
            found[1] += couple_t
            found[6] -= couple_t
        if wall.joints != "top":
            b, k, s = one.base_half_width, one.base_stiffness, np.sin(t1)
            left, right = (
                _elastic((low, high), side * k, z1, s, effects.tearing > 0.0)
                for low, high, side in ((-b, 0.0 * b, effects.left), (0.0 * b, b, effects.right))
            )
            n, m = laws("base", z1, t1)
            found[0] -= (left[1] + right[1] + m) * np.cos(t1)
            found[2] += left[0] + right[0] + n
            found[4] -= _held(effects.shear_base) * k * (left[2] + right[2]) * x1
        if wall.joints != "base":
            b, k, turn = one.top_half_width, one.top_stiffness, t2 - tm
            normal, moment, length = _elastic((-b, b), k, z2, np.sin(turn), False)
            n, m = laws("top", z2, turn)
            couple = (moment + m) * np.cos(turn)
            found[1] -= couple
            found[6] += couple
            found[3] += normal + n
            found[5] -= _held(effects.shear_top) * k * length * x2
        b, k, bend = one.base_half_width, one.base_stiffness, _held(effects.bending)
        couple = bend * 2.0 / 3.0 * k * b**3 * (tm - t1)
        found[0] += couple
        found[6] -= couple
        found[7] -= bend * 2.0 * k * b * zm
        return np.asarray(found)

    return force


def _held(ratio: FloatArray) -> FloatArray:
    """Ratios of stiffness, 0 for coordinates that do not move."""
    return np.where(np.isfinite(ratio), ratio, 0.0)


def _elastic(
    ends: tuple[FloatArray, FloatArray], k: FloatArray, z: FloatArray, s: FloatArray, bonded: NDArray[np.bool_] | bool
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """N, M and the length of the elastic strip between its ends at z, S; ``bonded``: it pulls where it is open."""
    low, high = (np.broadcast_to(end, z.shape) for end in ends)
    first, last = in_contact((low, high), z, s)
    first, last = np.where(bonded, low, first), np.where(bonded, high, last)
    d1, d2, d3 = last - first, (last**2 - first**2) / 2.0, (last**3 - first**3) / 3.0
    return -k * (z * d1 - s * d2), -k * (z * d2 - s * d3), d1
