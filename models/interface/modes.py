"""Small motions about rest in full contact: static state, natural frequencies, shapes, modal damping.

q = (theta1, theta2, z1, z2). Upright at rest z1 = -(m1+m2) g/(2 k_b b1), z2 = -m2 g/(2 k_t bt) under the linear law;
with l = 2 h1 + e_t + z2 the matrices are M, C = B(c_b, c_t), K = B(k_b, k_t) - diag(g (m1 h1 + m2 l), g m2 h2, 0, 0)
of full contact, k the slope of each layer's law on unloading from there; they equal the Jacobian of the full
equations with what has flowed in the rubber held, for either kinematics.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray
from models.interface import resting
from models.interface.layered import FREE, LayeredWall


def static_state(wall: LayeredWall) -> FloatArray:
    """q ``(n, 4)`` at rest under gravity, relaxed; nan where it cannot stand, 0 at a bonded joint."""
    return resting.at_rest(wall)[:, :4]


def tangents(wall: LayeredWall, rest: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Slope (N m-2) of the base and the top layer on unloading from ``rest`` (n, 4); k where no other law acts."""
    found = []
    for joint, z in (("base", rest[:, 2]), ("top", rest[:, 3])):
        layer = wall.layer(joint)
        found.append(layer.slope(-z, layer.relaxed(-z)))
    return found[0], found[1]


def uplift_rotation(wall: LayeredWall, rest: FloatArray) -> FloatArray:
    """theta (rad) at which the base begins to lift when turned slowly under its weight; W/(2 k b^2) if linear."""
    if "base" not in wall.rubber_joints:
        return np.full(wall.size, np.nan)
    load = wall.mass * wall.gravity / (2.0 * wall.base_half_width)
    layer = wall.layer("base")
    edge = layer.edge_at_uplift(load, -rest[:, 2]) if layer.laws else -2.0 * rest[:, 2]
    return np.asarray(edge / (2.0 * wall.base_half_width))


def mass_matrix(wall: LayeredWall, lever: FloatArray) -> FloatArray:
    """M ``(n, 4, 4)`` at zero rotation with the top joint ``lever`` (n,) above the wall's underside."""
    m = np.zeros((wall.size, 4, 4))
    m2, h2 = wall.mass_2, wall.centre_2
    m[:, 0, 0] = wall.inertia_1 + wall.mass_1 * wall.centre_1**2 + m2 * lever**2
    m[:, 0, 1] = m[:, 1, 0] = m2 * h2 * lever
    m[:, 1, 1] = wall.inertia_2 + m2 * h2**2
    m[:, 2, 2] = wall.mass
    m[:, 2, 3] = m[:, 3, 2] = m[:, 3, 3] = m2
    return m


def layer_matrix(wall: LayeredWall, base: FloatArray, top: FloatArray, sides: tuple[int, int] = (0, 0)) -> FloatArray:
    """B ``(n, 4, 4)`` for values ``base``, ``top`` (n,) per metre of contact.

    ``sides`` of base and top: 0 for full contact, +1 or -1 for the half of the joint at x > 0 or x < 0.
    """
    b = np.zeros((wall.size, 4, 4))
    base_share, top_share = (2.0 if side == 0 else 1.0 for side in sides)
    turn = top_share * top * wall.top_half_width**3 / 3.0
    b[:, 0, 0] = base_share * base * wall.base_half_width**3 / 3.0 + turn
    b[:, 0, 1] = b[:, 1, 0] = -turn
    b[:, 1, 1] = turn
    b[:, 2, 2] = base_share * base * wall.base_half_width
    b[:, 3, 3] = top_share * top * wall.top_half_width
    couple = sides[1] * top * wall.top_half_width**2 / 2.0
    b[:, 0, 2] = b[:, 2, 0] = -sides[0] * base * wall.base_half_width**2 / 2.0
    b[:, 0, 3] = b[:, 3, 0] = couple
    b[:, 1, 3] = b[:, 3, 1] = -couple
    return b


def gravity_matrix(wall: LayeredWall, lever: FloatArray) -> FloatArray:
    """What gravity takes from the stiffness: diag(g (m1 h1 + m2 l), g m2 h2, 0, 0)."""
    k = np.zeros((wall.size, 4, 4))
    k[:, 0, 0] = wall.gravity * (wall.mass_1 * wall.centre_1 + wall.mass_2 * lever)
    k[:, 1, 1] = wall.gravity * wall.mass_2 * wall.centre_2
    return k


@dataclass(frozen=True)
class Modes:
    """``squares`` omega^2 (n, m), ascending, negative where gravity tips the wall at rest; ``shapes``
    (n, 4, m), the largest component 1; ``damping`` ratios (n, m) from the diagonal of the modal C."""

    squares: FloatArray
    shapes: FloatArray
    damping: FloatArray

    @property
    def frequencies(self) -> FloatArray:
        """Natural frequencies in Hz, (n, m); nan where the wall is not stable at rest."""
        with np.errstate(invalid="ignore"):
            return np.sqrt(self.squares) / (2.0 * np.pi)


def at_rest(wall: LayeredWall) -> Modes:
    """Undamped modes in full contact, gravity included, with l as in the static state."""
    return wall.once(_at_rest)


def _at_rest(wall: LayeredWall) -> Modes:
    rest = static_state(wall)
    return modes(wall, mass_matrix(wall, _lever(wall, rest)), _stiffness(wall, rest))


def stable(wall: LayeredWall, rest: FloatArray) -> NDArray[np.bool_]:
    """Whether gravity leaves the wall stiffness in every direction at ``rest`` (n, 4): all omega^2 positive."""
    free = FREE[wall.joints]
    stiffness = free.T @ _stiffness(wall, rest) @ free
    with np.errstate(invalid="ignore"):
        minors = [np.linalg.det(stiffness[:, :k, :k]) > 0.0 for k in range(1, free.shape[1] + 1)]
    return np.asarray(np.all(minors, axis=0))


def _lever(wall: LayeredWall, rest: FloatArray) -> FloatArray:
    """l (m) at rest."""
    return np.asarray(wall.height_1 + wall.top_thickness_in_height + rest[:, 3])


def _stiffness(wall: LayeredWall, rest: FloatArray) -> FloatArray:
    """K (n, 4, 4) in full contact, gravity and an added couple without a gap included."""
    found = layer_matrix(wall, *tangents(wall, rest)) - gravity_matrix(wall, _lever(wall, rest))
    if wall.effects is not None:
        found[:, 0, 0] += np.where(wall.effects.couple_gap == 0.0, wall.effects.couple_stiffness, 0.0)
    return np.asarray(found)


def modes(wall: LayeredWall, mass: FloatArray, stiffness: FloatArray) -> Modes:
    """Modes of given matrices ``(n, 4, 4)`` in the coordinates that the wall's joints leave free; nan of nan."""
    free = FREE[wall.joints]
    unknown = np.asarray(np.any(np.isnan(mass + stiffness), axis=(1, 2)))
    mass, stiffness = (np.where(unknown[:, None, None], np.eye(4), matrix) for matrix in (mass, stiffness))

    def reduced(matrix: FloatArray) -> FloatArray:
        return np.asarray(free.T @ matrix @ free)

    root = np.linalg.cholesky(reduced(mass))
    inverse = np.linalg.inv(root)
    transposed = np.swapaxes(inverse, 1, 2)
    squares, vectors = np.linalg.eigh(inverse @ reduced(stiffness) @ transposed)
    squares[unknown] = np.nan
    normal = transposed @ vectors
    damping = reduced(layer_matrix(wall, wall.base_damping, wall.top_damping))
    with np.errstate(invalid="ignore"):
        ratios = np.einsum("nik,nij,njk->nk", normal, damping, normal) / (2.0 * np.sqrt(squares))
    shapes = free @ normal
    largest = np.take_along_axis(shapes, np.argmax(np.abs(shapes), axis=1)[:, None], axis=1)
    return Modes(squares, shapes / largest, ratios)


def derived(wall: LayeredWall, found: Modes, rest: FloatArray) -> dict[str, FloatArray]:
    """The declared derived quantities, arrays ``(n,)``, of q at ``rest`` (n, 4); nan for modes without a coordinate."""
    missing = np.full((wall.size, 4), np.nan)
    frequencies, damping, shapes = missing.copy(), missing.copy(), np.full((wall.size, 4, 4), np.nan)
    count = found.squares.shape[1]
    frequencies[:, :count], damping[:, :count] = found.frequencies, found.damping
    # rotations times b_1, so that all components are lengths
    lengths = (
        found.shapes
        * np.stack([wall.base_half_width, wall.base_half_width, *np.ones((2, wall.size))], axis=1)[:, :, None]
    )
    largest = np.take_along_axis(lengths, np.argmax(np.abs(lengths), axis=1)[:, None], axis=1)
    shapes[:, :, :count] = lengths / largest
    result = {
        "alpha": wall.slenderness,
        "alpha_2": wall.slenderness_2,
        "static_compression_base": 0.0 - rest[:, 2],
        "static_compression_top": 0.0 - rest[:, 3],
        "uplift_rotation": uplift_rotation(wall, rest),
        "base_damping_used": wall.base_damping,
        "top_damping_used": wall.top_damping,
    }
    names = ("rotation_1", "rotation_2", "compression_base", "compression_top")
    for k in range(4):
        result[f"frequency_{k + 1}"] = frequencies[:, k]
        result[f"modal_damping_{k + 1}"] = damping[:, k]
        result |= {f"mode_{k + 1}_{name}": shapes[:, j, k] for j, name in enumerate(names)}
    return result
