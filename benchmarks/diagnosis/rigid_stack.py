"""Two rigid blocks, one on the other, with mechanisms and laws of its own: a program apart from the models, from rest.

Unknown are the accelerations of both mass centres and rotations, x = (x_1, z_1, theta_1, x_2, z_2, theta_2), with the
forces that pin a corner of each joint and the couples that hold a closed one; at an impact velocities, with impulses:

    M x'' = loads + J^T forces,   J x'' = -J' x'      M (x'_after - x'_before) = J^T impulses,   J x'_after = 0

A joint that touches opens about the corner about which it then turns away from the other one, and stays closed where
this holds of neither. The rotations are integrated by classical Runge-Kutta steps on the grid given, which locate an
impact by bisection. A joint leaves it with ``factor_on_housner`` of the rate that the impulses leave, which gains no
energy. Rest: an impact slower than `CALM` p alpha that the forces let stay. Where impacts do not end in a step all that
follows is nan, as where a body falls.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.signal import butter, sosfiltfilt

from benchmarks.diagnosis.elimination import solved
from benchmarks.diagnosis.open_laws import Law, nothing, still, unchanged

FloatArray = NDArray[np.float64]

NULLS = {
    "restitution.factor_on_housner": 1.0,
    "pivot_inset.inset_over_half_width": 0.0,
    "tilt.tilt": 0.0,
    "eccentricity.offset_over_half_width": 0.0,
    "viscous_damping.rate": 0.0,
    "coulomb_damping.over_m_g_b": 0.0,
    "table_pitch.pitch_per_acceleration": 0.0,
    "table_pitch.low_pass_hz": 10.0,
}
"""The mechanisms that this program knows, by parameter, each with the value that switches it off."""
GRAVITY = 9.80665
CALM = 2e-3
SLIDES = 2e-4
"""rad s-1 over which dry friction changes its sign."""
MOST_IMPACTS = 100
"""In one step: a joint that hits as often hits without end."""
BASE, TOP = 0, 1
NONE = np.int64(2)
"""In the place of a joint: none is driven."""


def run(
    stack: Mapping[str, float],
    acceleration: FloatArray,
    step: float,
    mechanisms: Mapping[str, float] | None = None,
    law: Law | None = None,
    numbers: Sequence[float] = (0.0,) * 7,
    largest: float = 1.0,
    kicks: FloatArray | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Rotations (2, n) in rad and their rates at the steps (s) of ``acceleration`` (n,) in m s-2; nan once one falls.

    ``law``: a couple on the wall, or a ratio of the impacts at the base, beyond the catalogue with its ``numbers``
    (`open_laws`; inertia, p and alpha are those of both as one block, ``largest`` the rotation without the law).
    ``kicks``: scatter of the impacts at the base, the change of theta'_after over theta'_before.
    """
    values = {**NULLS, **(mechanisms or {})}
    b, h = stack["wall_length"] / 2.0, stack["wall_height"] / 2.0
    b_2, h_2 = min(stack["wall_length"], stack["top_length"]) / 2.0, stack["top_height"] / 2.0
    m, m_2 = stack["wall_mass"], stack["top_mass"]
    own, own_2 = (
        stack[f"{name}_mass"] * (stack[f"{name}_length"] ** 2 + stack[f"{name}_height"] ** 2) / 12.0
        for name in ("wall", "top")
    )
    inset, offset = 1.0 - values["pivot_inset.inset_over_half_width"], values["eccentricity.offset_over_half_width"]
    body = np.array([m, own, h, inset * b, offset * b, m_2, own_2, h_2, inset * b_2, offset * b_2])
    # both as one block about a corner of the base
    whole = own + own_2 + m * (b * b + h * h) + m_2 * (b * b + (2.0 * h + h_2) ** 2)
    centre = (m * h + m_2 * (2.0 * h + h_2)) / (m + m_2)
    radius = math.hypot(b, centre)
    squared = (m + m_2) * GRAVITY * radius / whole
    geometry = np.array([squared, math.atan2(b, centre), GRAVITY, radius, largest])
    tilt = values["tilt.tilt"]
    gravity = GRAVITY * math.cos(tilt)
    laws = np.array([
        values["restitution.factor_on_housner"], values["viscous_damping.rate"],
        values["coulomb_damping.over_m_g_b"] * (m + m_2) * gravity * b, whole,
    ])  # fmt: skip
    ground = np.zeros((acceleration.size, 3))  # a, G and the angular acceleration of the table
    ground[:, 0], ground[:, 1] = acceleration - GRAVITY * math.sin(tilt), gravity
    if pitch := values["table_pitch.pitch_per_acceleration"]:
        psi, turning = _pitch(acceleration, step, values["table_pitch.low_pass_hz"])
        ground[:, 0] -= gravity * pitch * psi
        ground[:, 2] = pitch * turning
    calm = CALM * math.sqrt(squared) * geometry[1]
    found = _integrate(
        law.couple if law else nothing, law.ratio if law else unchanged, ground, step, body, laws, geometry,
        np.asarray(numbers, float), calm, np.zeros(1) if kicks is None else kicks,
    )  # fmt: skip
    return found[:2], found[2:]


def knows(law: Law) -> bool:
    """Whether a law of one block has no freedom of its own: a couple on the wall, a ratio of impacts."""
    return law.hidden is still


def _pitch(acceleration: FloatArray, step: float, low_pass: float) -> tuple[FloatArray, FloatArray]:
    """Angle and angular acceleration of a table in phase with its own acceleration, per unit of it."""
    around = round(1.0 / step)
    quiet = np.pad(acceleration, around)
    smooth = sosfiltfilt(butter(2, low_pass, fs=1.0 / step, output="sos"), quiet)
    turning = CubicSpline(step * np.arange(quiet.size), smooth).derivative(2)(step * np.arange(quiet.size))
    return smooth[around:-around], turning[around:-around]


@njit
def _turned(x, z, angle):  # type: ignore[no-untyped-def]
    """A vector turned clockwise."""
    return x * math.cos(angle) + z * math.sin(angle), z * math.cos(angle) - x * math.sin(angle)


@njit
def _arms(theta, sides, body):  # type: ignore[no-untyped-def]
    """From the mass centres to the pins: of the wall to the base's, of the wall and of the block to the top's."""
    base, top = 1.0 if sides[BASE] >= 0 else -1.0, 1.0 if sides[TOP] >= 0 else -1.0
    return (
        _turned(base * body[3] - body[4], -body[2], theta[0]),
        _turned(top * body[8] - body[4], body[2], theta[0]),
        _turned(top * body[8] - body[9], -body[7], theta[1]),
    )


@njit
def _solve(theta, rate, sides, loads, driven, wanted, body):  # type: ignore[no-untyped-def]
    """x'' under ``loads`` (6,), or x' after the momenta ``loads`` at no ``rate``, of pinned and closed joints.

    The joint ``driven`` (or `NONE`) gets the relative rotation's rate ``wanted``, whatever couple it takes.
    """
    foot, below, above = _arms(theta, sides, body)
    count = 10 + (1 if sides[BASE] == 0 or driven == BASE else 0) + (1 if sides[TOP] == 0 or driven == TOP else 0)
    matrix, right = np.zeros((count, count)), np.zeros(count)
    for k, mass in enumerate((body[0], body[0], body[1], body[5], body[5], body[6])):
        matrix[k, k] = mass
    right[:6] = loads
    matrix[6, 0], matrix[6, 2] = 1.0, foot[1]
    matrix[7, 1], matrix[7, 2] = 1.0, -foot[0]
    matrix[8, 3], matrix[8, 5], matrix[8, 0], matrix[8, 2] = 1.0, above[1], -1.0, -below[1]
    matrix[9, 4], matrix[9, 5], matrix[9, 1], matrix[9, 2] = 1.0, -above[0], -1.0, below[0]
    first, second = rate[0] ** 2, rate[1] ** 2
    for i in range(2):
        right[6 + i], right[8 + i] = first * foot[i], second * above[i] - first * below[i]
    row = 10
    for joint in (BASE, TOP):
        if sides[joint] == 0 or driven == joint:
            matrix[row, 3 * joint + 2] = 1.0
            if joint == TOP:
                matrix[row, 2] = -1.0
            right[row] = wanted if driven == joint else 0.0
            row += 1
    matrix[:6, 6:] = -matrix[6:, :6].T
    return solved(matrix, right)[:6]


@njit
def _opening(x, joint):  # type: ignore[no-untyped-def]
    """Of the rotations' rates (or accelerations) in ``x`` (6,) that of a joint."""
    return x[5] - x[2] if joint == TOP else x[2]


@njit
def _second(couple, theta, rate, sides, way, t, ground, body, laws, geometry, numbers):  # type: ignore[no-untyped-def]
    """x'' at time t (s) of a wall that turns, or is about to turn, the ``way``."""
    a, gravity, turning = ground
    height = 2.0 * body[2] + body[7]
    loads = np.array([
        -body[0] * (a + body[2] * turning), -body[0] * gravity, -body[1] * turning,
        -body[5] * (a + height * turning), -body[5] * gravity, -body[6] * turning,
    ])  # fmt: skip
    if sides[BASE] != 0:
        arm, arm_2 = sides[BASE] * body[3] - body[4], sides[BASE] * body[3] - body[9]
        corner = body[1] + body[0] * (body[2] ** 2 + arm**2) + body[6] + body[5] * (height**2 + arm_2**2)
        at = theta[0] if theta[0] != 0.0 else 1e-12 * way
        slides = math.tanh(rate[0] / SLIDES) if rate[0] != 0.0 else way
        loads[2] -= laws[1] * corner * rate[0] + laws[2] * slides
        loads[2] += laws[3] * couple(t, at, rate[0], 0.0, 0.0, a, numbers, geometry)
    return _solve(theta, rate, sides, loads, NONE, 0.0, body)


@njit
def _best(openings, sides):  # type: ignore[no-untyped-def]
    """The sides that follow: where a joint of ``sides`` is closed it opens about a corner, or about neither.

    ``openings`` (3, 3, 2): of both joints by the sides (-1, 0, 1) of both. With forces, impulses or a joint driven one
    choice alone is consistent; at the threshold between two it is the clearer one.
    """
    best, most = sides.copy(), -np.inf
    for first in range(3):
        for second in range(3):
            if (sides[BASE] != 0 and sides[BASE] != first - 1) or (sides[TOP] != 0 and sides[TOP] != second - 1):
                continue
            clear = np.inf
            for c in (-1, 1):
                if sides[BASE] == 0 and first - 1 in (0, c):
                    away = c * openings[c + 1, second, BASE]
                    clear = min(clear, away if first != 1 else -away)
                if sides[TOP] == 0 and second - 1 in (0, c):
                    away = c * openings[first, c + 1, TOP]
                    clear = min(clear, away if second != 1 else -away)
            if clear > most:
                best, most = np.array([first - 1, second - 1]), clear
    return best


@njit
def _settled(couple, theta, rate, sides, t, ground, body, laws, geometry, numbers):  # type: ignore[no-untyped-def]
    """What the closed joints of ``sides`` do under the forces."""
    openings = np.zeros((3, 3, 2))
    for first in range(-1, 2):
        for second in range(-1, 2):
            trial = np.array([first, second])
            if np.any((sides != 0) & (sides != trial)):
                continue
            x = _second(couple, theta, rate, trial, float(first), t, ground, body, laws, geometry, numbers)
            openings[first + 1, second + 1] = _opening(x, BASE), _opening(x, TOP)
    return _best(openings, sides)


@njit
def _freed(theta, momenta, sides, driven, wanted, body):  # type: ignore[no-untyped-def]
    """Sides and x' after an impact with these ``momenta`` (6,) before it, closed joints of ``sides`` free to open."""
    openings, still = np.zeros((3, 3, 2)), np.zeros(2)
    for first in range(-1, 2):
        for second in range(-1, 2):
            trial = np.array([first, second])
            if np.any((sides != 0) & (sides != trial)):
                continue
            x = _solve(theta, still, trial, momenta, driven, wanted, body)
            openings[first + 1, second + 1] = _opening(x, BASE), _opening(x, TOP)
    chosen = _best(openings, sides)
    return chosen, _solve(theta, still, chosen, momenta, driven, wanted, body)


@njit
def _energy(x, body):  # type: ignore[no-untyped-def]
    """Twice the kinetic energy."""
    linear = body[0] * (x[0] ** 2 + x[1] ** 2) + body[5] * (x[3] ** 2 + x[4] ** 2)
    return linear + body[1] * x[2] ** 2 + body[6] * x[5] ** 2


@njit
def _velocities(theta, rate, sides, body):  # type: ignore[no-untyped-def]
    """x' of these rotations about the pins."""
    foot, below, above = _arms(theta, sides, body)
    x, z = -rate[0] * foot[1], rate[0] * foot[0]
    along, up = x + rate[0] * below[1] - rate[1] * above[1], z - rate[0] * below[0] + rate[1] * above[0]
    return np.array([x, z, rate[0], along, up, rate[1]])


@njit
def _impact(theta, rate, sides, joint, ratio, kick, body):  # type: ignore[no-untyped-def]
    """Sides and x' after ``joint`` has closed, its rate ``ratio`` times that by impulses and ``kick`` times before."""
    before, closed = _velocities(theta, rate, sides, body), sides.copy()
    momenta = before * np.array([body[0], body[0], body[1], body[5], body[5], body[6]])
    closed[joint] = 0
    after, x = _freed(theta, momenta, closed, NONE, 0.0, body)
    own = _opening(x, joint)
    wanted = ratio * own + (kick * _opening(before, joint) if own != 0.0 else 0.0)
    if wanted == own:
        return after, x
    closed[joint] = int(np.sign(wanted))
    driven = NONE if wanted == 0.0 else joint
    after, x = _freed(theta, momenta, closed, driven, wanted, body)
    # the energy is least without that rate, and grows with its square
    least = _energy(_solve(theta, np.zeros(2), after, momenta, joint, 0.0, body), body)
    most, found = _energy(before, body), _energy(x, body)
    if found > most:
        wanted *= math.sqrt(max(0.0, most - least) / (found - least))
        after, x = _freed(theta, momenta, closed, driven, wanted, body)
    return after, x


@njit
def _landed(couple, theta, rate, sides, joint, kept, kick, calm, t, ground, body, laws, geometry, numbers):  # type: ignore[no-untyped-def]
    """Sides and rates after an impact at ``joint``; a slow one that the forces hold closes it for good."""
    after, x = _impact(theta, rate, sides, joint, kept, kick, body)
    if after[joint] != 0 and abs(_opening(x, joint)) < calm:
        closed = after.copy()
        closed[joint] = 0
        y = _solve(
            theta, np.zeros(2), closed,
            _velocities(theta, rate, sides, body) * np.array([body[0], body[0], body[1], body[5], body[5], body[6]]),
            NONE, 0.0, body,
        )  # fmt: skip
        slow = np.array([y[2], y[5]])
        if _settled(couple, theta, slow, closed, t, ground, body, laws, geometry, numbers)[joint] == 0:
            return closed, slow
    return after, np.array([x[2], x[5]])


@njit
def _step(couple, theta, rate, sides, t, h, ground, slope, body, laws, geometry, numbers):  # type: ignore[no-untyped-def]
    """Rotations and rates after a step ``h`` (s), the motion of the ground linear."""
    to_theta, to_rate, by_theta, by_rate = np.zeros(2), np.zeros(2), np.zeros(2), np.zeros(2)
    for share, weight in ((0.0, 1.0 / 6.0), (0.5, 1.0 / 3.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 6.0)):
        ahead = share * h
        at_theta, at_rate, now = theta + ahead * by_theta, rate + ahead * by_rate, ground + ahead * slope
        x = _second(
            couple, at_theta, at_rate, sides, float(sides[BASE]), t + ahead, now, body, laws, geometry, numbers
        )  # fmt: skip
        by_theta, by_rate = at_rate, np.array([x[2], x[5]])
        to_theta += weight * by_theta
        to_rate += weight * by_rate
    return _together(theta + h * to_theta, rate + h * to_rate, sides)


@njit
def _together(theta, rate, sides):  # type: ignore[no-untyped-def]
    """The same, closed joints without a rotation of their own to the last digit."""
    if sides[BASE] == 0:
        theta[0] = rate[0] = 0.0
    if sides[TOP] == 0:
        theta[1], rate[1] = theta[0], rate[0]
    return theta, rate


@njit
def _crossed(theta, sides):  # type: ignore[no-untyped-def]
    """The joint whose open corner would go through what it stands on, or `NONE`."""
    if sides[BASE] * theta[0] < 0.0:
        return BASE
    return TOP if sides[TOP] * (theta[1] - theta[0]) < 0.0 else NONE


@njit
def _integrate(couple, ratio, motion, step, body, laws, geometry, numbers, calm, kicks):  # type: ignore[no-untyped-def]
    count = motion.shape[0]
    found = np.zeros((4, count))
    theta, rate, sides, impacts = np.zeros(2), np.zeros(2), np.zeros(2, np.int64), 0
    for k in range(count - 1):
        slope, gone, hits = (motion[k + 1] - motion[k]) / step, 0.0, 0
        while hits < MOST_IMPACTS:
            t, left, ground = k * step + gone, step - gone, motion[k] + gone * slope
            if sides[BASE] == 0 or sides[TOP] == 0:
                sides = _settled(couple, theta, rate, sides, t, ground, body, laws, geometry, numbers)
            if sides[BASE] == 0 and sides[TOP] == 0:
                break
            new = _step(couple, theta, rate, sides, t, left, ground, slope, body, laws, geometry, numbers)
            joint = _crossed(new[0], sides)
            if joint == NONE:
                theta, rate = new
                break
            low, high = 0.0, left
            for _ in range(50):
                middle = 0.5 * (low + high)
                new = _step(couple, theta, rate, sides, t, middle, ground, slope, body, laws, geometry, numbers)
                first = _crossed(new[0], sides)
                if first == NONE:
                    low = middle
                else:
                    high, joint = middle, first
            theta, rate = _step(couple, theta, rate, sides, t, high, ground, slope, body, laws, geometry, numbers)
            gone += high
            if joint == BASE:
                theta -= theta[BASE]
            else:
                theta[1] = theta[0]
            t, kept, kick = k * step + gone, laws[0], 0.0
            if joint == BASE:
                kept *= ratio(t, -float(sides[BASE]), numbers)
                kick, impacts = kicks[impacts % kicks.size], impacts + 1
            sides, rate = _landed(
                couple, theta, rate, sides, joint, kept, kick, calm, t, motion[k] + gone * slope, body, laws, geometry,
                numbers,
            )  # fmt: skip
            theta, rate = _together(theta, rate, sides)
            hits += 1
            if step - gone <= 1e-15:
                break
        found[:2, k + 1], found[2:, k + 1] = theta, rate
        if hits == MOST_IMPACTS or not abs(theta[0]) < 1.5 or not abs(theta[1]) < 1.5:
            found[:, k + 1 :] = np.nan
            break
    return found
