"""The paper's Eq. 6, corrected: linear in each configuration of the two joints.

q = (theta1, theta2, z1, z2), L = 2 h1 + e_t, r = theta2 - theta1:

    M q'' + C q' + K q = f,  C = B(c_b, c_t),  K = B(k_b, k_t) - diag(g (m1 h1 + m2 L), g m2 h2, 0, 0)
    f = -(a (m1 h1 + m2 L), a m2 h2, G (m1 + m2), G m2),  G = g + a_z

B is that of the full joint while its freer end is compressed, z + b |r| <= 0, else that of the half on the
side s = sign(r) that presses (`modes.layer_matrix`).

The force jumps at the switch, h = z + s b r = 0: by sigma d, d = (-s b^3/6, -b^2/2) on (r, z) and
sigma = s (k r + c r'). Where h'' > 0 in full and h'' < 0 in half contact, the two alternate faster and
faster; the limit (Filippov) holds h = 0 with a share mu/sigma of the jump, 0 <= mu <= sigma, such that
h'' = 0. So a joint has five states: full, half on either side, held at the switch on either side.
"""

from __future__ import annotations

import numpy as np

from models.base import FloatArray
from models.interface import modes, resting, standing
from models.interface.layered import FREE, LayeredWall

FULL, HALF_RIGHT, HALF_LEFT, HELD_RIGHT, HELD_LEFT = range(5)
"""States of a joint; right: the half at x > 0 presses (r > 0)."""
SIDE = (0, 1, -1, 1, -1)
STATES = 5
"""The configuration of both joints is ``STATES * base + top``."""

ACCELERATION, WATCH, KICK, N_ROWS = 0, 4, 8, 9
"""Rows of `systems`: q'' (4), two watched values a joint (base, top), and what stops h' (base 4, top 4)."""


def lever(wall: LayeredWall) -> FloatArray:
    """L = 2 h1 + e_t, (n,)."""
    return wall.height_1 + wall.top_thickness_in_height


def matrices(
    wall: LayeredWall, sides: tuple[int, int], at: FloatArray | None = None
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """M, C, K ``(n, 4, 4)`` with the joints in full (side 0) or half contact (+-1), ``at`` in place of L."""
    height = lever(wall) if at is None else at
    damping = modes.layer_matrix(wall, wall.base_damping, wall.top_damping, sides)
    stiffness = modes.layer_matrix(wall, wall.base_stiffness, wall.top_stiffness, sides)
    return modes.mass_matrix(wall, height), damping, stiffness - modes.gravity_matrix(wall, height)


def rest(wall: LayeredWall) -> FloatArray:
    """q ``(n, 4)`` at rest under gravity, relaxed: K q = f of full contact; where that opens a joint see `lifted`."""
    found = resting.upright(wall).copy()
    if (lanes := np.flatnonzero(wall.offset)).size:
        some, free = wall.take(lanes), FREE[wall.joints]
        force = loads(some) @ np.stack([some.offset, some.gravity], axis=1)[:, :, None]
        stiffness = matrices(some, (0, 0))[2]
        found[lanes] = (free @ np.linalg.solve(free.T @ stiffness @ free, free.T @ force))[:, :, 0]
    return found


def lifted(wall: LayeredWall) -> standing.Unable:
    """Walls that lean so far that a joint is open at rest, (n,), and a sentence: no rest of full contact."""
    state = rest(wall)
    up = [
        np.einsum("nk,nk->n", gap(wall, joint, side), state) > 0.0
        for joint, name in enumerate(("base", "top"))
        for side in (1, -1)
        if name in wall.rubber_joints
    ]
    return np.any(up, axis=0), "the base leans so far that a joint is open at rest: less tilt, or a longer wall"


def at_rest(wall: LayeredWall) -> modes.Modes:
    """Undamped modes in full contact."""
    mass, _, stiffness = matrices(wall, (0, 0))
    return modes.modes(wall, mass, stiffness)


def loads(wall: LayeredWall) -> FloatArray:
    """f ``(n, 4, 2)`` for a = 1 and for G = 1."""
    found = np.zeros((wall.size, 4, 2))
    found[:, 0, 0] = -(wall.mass_1 * wall.centre_1 + wall.mass_2 * lever(wall))
    found[:, 1, 0] = -wall.mass_2 * wall.centre_2
    found[:, 2, 1] = -wall.mass
    found[:, 3, 1] = -wall.mass_2
    return found


def joint_axes(joint: int) -> tuple[FloatArray, FloatArray]:
    """r and z of a joint (0 base, 1 top) as rows on q."""
    turn = np.array([[1.0, 0.0, 0.0, 0.0], [-1.0, 1.0, 0.0, 0.0]])[joint]
    return turn, np.eye(4)[2 + joint]


def half_width(wall: LayeredWall, joint: int) -> FloatArray:
    return wall.top_half_width if joint else wall.base_half_width


def gap(wall: LayeredWall, joint: int, side: int) -> FloatArray:
    """h = z + s b r as a row on q, ``(n, 4)``."""
    turn, z = joint_axes(joint)
    return z + side * half_width(wall, joint)[:, None] * turn


def jump(wall: LayeredWall, joint: int, side: int) -> FloatArray:
    """d ``(n, 4)``: what half contact adds to the force at the switch, for sigma = 1."""
    turn, z = joint_axes(joint)
    b = half_width(wall, joint)[:, None]
    return -side * b**3 / 6.0 * turn - b**2 / 2.0 * z


def strain_rows(wall: LayeredWall, joint: int, side: int) -> FloatArray:
    """sigma = s (k r + c r') as a row on (q, q', a, G), ``(n, 10)``."""
    turn, _ = joint_axes(joint)
    k = wall.top_stiffness if joint else wall.base_stiffness
    c = wall.top_damping if joint else wall.base_damping
    still = np.zeros((wall.size, 2))
    return side * np.concatenate([k[:, None] * turn, c[:, None] * turn, still], axis=1)


def sizes(wall: LayeredWall) -> tuple[FloatArray, FloatArray]:
    """Compression (m) and sigma (N m-2) of both joints at the uplift under their weight, ``(n, 2)``; 1 if bonded."""
    compression = -rest(wall)[:, 2:]
    compression = np.where(compression > 0.0, compression, 1.0)
    width = np.stack([wall.base_half_width, wall.top_half_width], axis=1)
    k = np.stack([wall.base_stiffness, wall.top_stiffness], axis=1)
    return compression, np.where(k > 0.0, k * compression / width, 1.0)


def systems(wall: LayeredWall) -> FloatArray:
    """Every configuration as rows on (q, q', a, G), ``(n, 25, N_ROWS, 10)``.

    A joint leaves its state where one of its two watched values becomes positive: full: h of the right,
    of the left half; half: -h, and -s r (it turns to the other side); held: -mu, mu - sigma. They are
    divided by `sizes`. Zero for a bonded joint: it stays as it is.
    """
    n = wall.size
    free = FREE[wall.joints]
    mass = matrices(wall, (0, 0))[0]
    mobility = free @ np.linalg.inv(free.T @ mass @ free) @ free.T
    load, (compression, sigma) = loads(wall), sizes(wall)
    laid = [wall.joints in ("both", name) for name in ("base", "top")]
    found = np.zeros((n, STATES**2, N_ROWS, 10))
    for configuration in range(STATES**2):
        state = divmod(configuration, STATES)
        held = [joint for joint in (0, 1) if state[joint] >= HELD_RIGHT]
        if not all(laid[joint] for joint in (0, 1) if state[joint] != FULL):
            continue
        sides = tuple(0 if joint in held else SIDE[state[joint]] for joint in (0, 1))
        _, damping, stiffness = matrices(wall, (sides[0], sides[1]))
        rows = found[:, configuration]
        free_motion = mobility @ np.concatenate([-stiffness, -damping, load], axis=2)
        multiplier = np.zeros((n, 0, 10))
        if held:
            normal = np.stack([gap(wall, joint, SIDE[state[joint]]) for joint in held], axis=1)
            push = mobility @ np.stack([jump(wall, joint, SIDE[state[joint]]) for joint in held], axis=2)
            response = normal @ push
            multiplier = -np.linalg.solve(response, normal @ free_motion)
            free_motion = free_motion + push @ multiplier
            stop = push @ np.linalg.inv(response)
            for index, joint in enumerate(held):
                rows[:, KICK, 4 * joint : 4 * joint + 4] = stop[:, :, index]
        rows[:, ACCELERATION : ACCELERATION + 4] = free_motion
        for joint in (0, 1):
            if not laid[joint]:
                continue
            first, second = WATCH + 2 * joint, WATCH + 2 * joint + 1
            side, unit = SIDE[state[joint]], compression[:, joint, None]
            if state[joint] == FULL:
                rows[:, first, :4] = gap(wall, joint, 1) / unit
                rows[:, second, :4] = gap(wall, joint, -1) / unit
            elif joint in held:
                mu = multiplier[:, held.index(joint)]
                rows[:, first] = -mu / sigma[:, joint, None]
                rows[:, second] = (mu - strain_rows(wall, joint, side)) / sigma[:, joint, None]
            else:
                rows[:, first, :4] = -gap(wall, joint, side) / unit
                rows[:, second, :4] = -side * half_width(wall, joint)[:, None] * joint_axes(joint)[0] / unit
    return found
