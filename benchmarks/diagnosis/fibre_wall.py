"""A wall and a block on top on layers of fibres: a program apart from the models, from rest.

Coordinates q: the gaps under the left and the right end of either underside over what carries it, in the axes of that
(the ground, the wall). A fibre at the share s of an underside is stretched by (1 - s) w_left + s w_right, and a body
stands on the lower end of its underside, which does not move along. Layers that give way along the joints add the
slips x of both (`interface_shear`): a fibre that presses resists with ratio (k (x - m) + c x'), m the slip at which it
came to touch.

    J^T [ M (J q'' + J' q') + (m a, m G, 0) of both bodies ] = forces of the fibres + couples on the wall

J: derivatives of both mass centres and rotations, by differences; classical Runge-Kutta steps, the acceleration of the
base linear in between. Law of a fibre, with u = -w its compression (0 where w >= 0):

    f = max(0, s (1 - softening (1 - exp(-u_max/(strain e)))) + c u')
    s = k (a u + (1 - a) zeta) + k beta2 u (u/e)^2 + k_1 (u - v)

v, zeta: those of Maxwell's arm and of Bouc-Wen's hysteresis. Rest: every fibre relaxed under the static load.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.optimize import brentq, root

from benchmarks.diagnosis.elimination import solved
from benchmarks.diagnosis.open_laws import Law, nothing, still, unchanged

FloatArray = NDArray[np.float64]

FIBRES = 96
LONGEST = 1.25e-4
"""s, of a step."""
STABLE = 1.2
"""Step times the rate of the fastest mode: Runge and Kutta's fourth-order rule bears 2.78."""
SMALL, TURN = 1e-5, 1e-4
"""m, of the differences of J, and of those of J'."""
STILL = 1e-3
"""m s-2, of the ends of the undersides at rest."""
SLIDES = 5e-6
"""rad s-1 over which dry friction changes its sign: what it holds creeps so fast, and walls turn by less than 1e-3."""
NULLS = {
    "maxwell.arm_stiffness_ratio": 0.0,
    "maxwell.relaxation_time": 1.0,
    "hardening.beta2": 0.0,
    "mullins.softening": 0.0,
    "mullins.strain": 1.0,
    "bouc_wen.post_yield_ratio": 1.0,
    "bouc_wen.yield_compression": 1.0,
    "bouc_wen.exponent": 1.0,
    "pivot_inset.inset_over_half_width": 0.0,
    "one_sided_stiffness.right_over_left": 1.0,
    "tilt.tilt": 0.0,
    "eccentricity.offset_top": 0.0,
    "added_stiffness.couple_stiffness": 0.0,
    "added_stiffness.gap": 0.0,
    "viscous_damping.couple_damping": 0.0,
    "coulomb_damping.over_m_g_b": 0.0,
    "interface_shear.shear_over_normal": np.inf,
}
"""The mechanisms that this program knows, by parameter, each with the value that switches it off."""
GRAVITY = 9.80665


def run(
    wall: Mapping[str, float],
    acceleration: FloatArray,
    step: float,
    mechanisms: Mapping[str, float] | None = None,
    law: Law | None = None,
    numbers: Sequence[float] = (0.0,) * 7,
    largest: float = 1.0,
    fibres: int = FIBRES,
) -> FloatArray:
    """Rotations (2, n) in rad of wall and block at the steps (s) of ``acceleration`` (n,) in m s-2.

    ``wall``: parameters as specimens name them, stiffness and dashpot of both layers given. ``law``: a couple on the
    wall beyond the catalogue with its ``numbers`` (`open_laws`, where alpha is here ``largest``, the rotation (rad)
    without it, and p^2 what makes p^2 alpha that of the wall).
    """
    values = {**NULLS, **(mechanisms or {})}
    body, layers = _body(wall, values), _layers(wall, values)
    tilt, mass = values["tilt.tilt"], wall["wall_mass"] + wall["top_mass"]
    lever = _lever(wall)
    couples = np.array([
        values["added_stiffness.couple_stiffness"], values["added_stiffness.gap"],
        values["viscous_damping.couple_damping"],
        values["coulomb_damping.over_m_g_b"] * mass * GRAVITY * np.cos(tilt) * wall["wall_length"] / 2.0, lever[0],
    ])  # fmt: skip
    # p^2 alpha resists a wall that has uplifted as it does a block, but at its own, smaller rotations
    resists = lever[1] * np.arctan2(wall["wall_length"] / 2.0, lever[2])
    geometry = np.array([resists / largest, largest, GRAVITY, lever[3], largest])
    rate = sum(float(layer[1] * layer[3]) for layer in layers) * 2.0 / wall["wall_mass"]
    shears = np.isfinite(values["interface_shear.shear_over_normal"])
    rate *= max(1.0, values["interface_shear.shear_over_normal"]) if shears else 1.0
    rate = max(rate, float(couples[3]) / (lever[0] * SLIDES))
    per = max(1, int(np.ceil(step / LONGEST)), int(np.ceil(step * rate / STABLE)))
    couple, lean = law.couple if law else nothing, np.array([-GRAVITY * np.sin(tilt), GRAVITY * np.cos(tilt)])
    fixed = (body, *layers, couples, geometry, np.asarray(numbers, float), lean)
    rest = [_compression(layer, load) for layer, load in zip(layers, (mass, wall["top_mass"]), strict=True)]
    alone = (*fixed[:5], np.array([0.0, *numbers[1:]]), lean)  # the law of size 0
    begin = np.append(np.repeat(np.negative(rest), 2), np.zeros(2 if shears else 0))
    start = root(_unbalanced, begin, (couple, alone, fibres), tol=1e-10).x
    if np.max(np.abs(_unbalanced(start, couple, alone, fibres))) > STILL:
        raise RuntimeError("the wall does not stand")
    return np.asarray(_integrate(couple, np.asarray(acceleration, float), step, per, fixed, start, fibres))


def knows(law: Law) -> bool:
    """Whether a law of one block is a couple alone, that may act on the wall."""
    return law.hidden is still and law.ratio is unchanged


def _body(wall: Mapping[str, float], values: Mapping[str, float]) -> FloatArray:
    """Half lengths and heights, masses and inertias of wall and block, their contacts and the block's offset."""
    inset = 1.0 - values["pivot_inset.inset_over_half_width"]
    b, top = wall["wall_length"] / 2.0, min(wall["wall_length"], wall["top_length"]) / 2.0
    inertias = [
        wall[f"{p}_mass"] * (wall[f"{p}_length"] ** 2 + wall[f"{p}_height"] ** 2) / 12.0 for p in ("wall", "top")
    ]
    return np.array([
        inset * b, wall["wall_height"] / 2.0, wall["wall_mass"], inertias[0], top, wall["top_height"] / 2.0,
        wall["top_mass"], inertias[1], wall["wall_height"] + wall["layer_thickness"], values["eccentricity.offset_top"],
    ])  # fmt: skip


def _layers(wall: Mapping[str, float], values: Mapping[str, float]) -> list[FloatArray]:
    """Of both: k, half contact, e, c, k_1/k, tau, beta2, softening, strain, a, u_y, n, factors by side, shear."""
    along = values["interface_shear.shear_over_normal"]
    ratio = values["one_sided_stiffness.right_over_left"]
    halves = {"base": wall["wall_length"], "top": min(wall["wall_length"], wall["top_length"])}
    found = []
    for joint, inset, sides in (
        ("base", 1.0 - values["pivot_inset.inset_over_half_width"], (2.0 / (1.0 + ratio), 2.0 * ratio / (1.0 + ratio))),
        ("top", 1.0, (1.0, 1.0)),
    ):
        found.append(np.array([
            wall[f"{joint}_stiffness"], inset * halves[joint] / 2.0, wall["layer_thickness"], wall[f"{joint}_damping"],
            values["maxwell.arm_stiffness_ratio"], values["maxwell.relaxation_time"], values["hardening.beta2"],
            values["mullins.softening"], values["mullins.strain"], values["bouc_wen.post_yield_ratio"],
            values["bouc_wen.yield_compression"], values["bouc_wen.exponent"], *sides,
            along if np.isfinite(along) else 0.0,
        ]))  # fmt: skip
    return found


def _lever(wall: Mapping[str, float]) -> tuple[float, float, float, float]:
    """Of both bodies as one about the toe: inertia, M g R over it, height and distance of the mass centre."""
    b, h = wall["wall_length"] / 2.0, wall["wall_height"] / 2.0
    high = wall["wall_height"] + wall["layer_thickness"] + wall["top_height"] / 2.0
    low, up = wall["wall_mass"], wall["top_mass"]
    inertia = sum(
        m * ((length**2 + height**2) / 12.0 + b * b + z * z)
        for m, length, height, z in (
            (low, wall["wall_length"], wall["wall_height"], h), (up, wall["top_length"], wall["top_height"], high),
        )
    )  # fmt: skip
    centre = (low * h + up * high) / (low + up)
    distance = float(np.hypot(b, centre))
    return inertia, (low + up) * GRAVITY * distance / inertia, centre, distance


def _compression(layer: FloatArray, mass: float) -> float:
    """Of a layer (m) that carries ``mass`` (kg) in its middle, at rest."""
    e = float(layer[2])

    def excess(u: float) -> float:
        force = _at_rest(-u, -u, 0.0, layer, 1)[0][0]
        return float(force - 0.5 * mass * GRAVITY)

    return float(brentq(excess, 0.0, 5.0 * e, xtol=1e-14))


@njit
def _placed(q, body):  # type: ignore[no-untyped-def]
    """Mass centres (x, z) and rotations of wall and block."""
    first, second = np.arcsin((q[0] - q[1]) / (2.0 * body[0])), np.arcsin((q[2] - q[3]) / (2.0 * body[4]))
    low = body[0] if q[1] < q[0] else -body[0]
    x, z = _turned(-low, 0.0, first)
    foot_x, foot_z = low + x, min(q[0], q[1]) + z
    toe = body[4] if q[3] < q[2] else -body[4]
    along, upper = _turned(-toe, 0.0, second)
    along, upper = _turned(toe + along, body[8] + min(q[2], q[3]) + upper, first)
    x1, z1 = _turned(0.0, body[1], first)
    x2, z2 = _turned(body[9], body[5], first + second)
    if q.size > 4:
        slid, lifted = _turned(q[5], 0.0, first)
        foot_x, along, upper = foot_x + q[4], along + slid, upper + lifted
    return np.array([foot_x + x1, foot_z + z1, first, foot_x + along + x2, foot_z + upper + z2, first + second])


@njit
def _turned(x, z, angle):  # type: ignore[no-untyped-def]
    """A vector turned clockwise."""
    return x * np.cos(angle) + z * np.sin(angle), z * np.cos(angle) - x * np.sin(angle)


@njit
def _fibres(left, right, slip, left_rate, right_rate, slip_rate, layer, memory, change, count):  # type: ignore[no-untyped-def]
    """Forces on both ends of an underside and along it; ``change`` gets the rates of the fibres' memories (v, zeta)."""
    k, half, e, c, arm, tau, beta2, softening, strain, a, u_y, n = layer[:12]
    at_left = at_right = sheared = 0.0
    for i in range(count):
        s = (i + 0.5) / count
        w, rate = (1.0 - s) * left + s * right, (1.0 - s) * left_rate + s * right_rate
        u, speed = (-w, -rate) if w < 0.0 else (0.0, 0.0)
        stiffness = k * (layer[12] if s < 0.5 else layer[13])
        v, zeta, most = memory[i, 0], memory[i, 1], max(memory[i, 2], u)
        change[i, 0] = (u - v) / tau
        power = abs(zeta) ** (n - 1.0)
        change[i, 1] = speed - (abs(speed) * power * zeta + speed * power * abs(zeta)) / (2.0 * u_y**n)
        if w >= 0.0:
            continue
        stress = stiffness * (a * u + (1.0 - a) * zeta + beta2 * u * (u / e) ** 2 + arm * (u - v))
        stress = stress * (1.0 - softening * (1.0 - np.exp(-most / (strain * e)))) + c * speed
        force = max(0.0, stress) * 2.0 * half / count
        at_left += (1.0 - s) * force
        at_right += s * force
        if force > 0.0:
            sheared -= layer[14] * (k * (slip - memory[i, 3]) + c * slip_rate) * 2.0 * half / count
    return at_left, at_right, sheared


@njit
def _at_rest(left, right, slip, layer, count):  # type: ignore[no-untyped-def]
    """Forces on both ends of an underside whose fibres have been held for ever, and the fibres' memories."""
    memory = np.zeros((count, 4))
    u_y = layer[10]
    for i in range(count):
        s = (i + 0.5) / count
        u = max(0.0, -(1.0 - s) * left - s * right)
        memory[i, 0] = memory[i, 2] = u
        memory[i, 1] = u_y * (1.0 - np.exp(-u / u_y)) if layer[11] == 1.0 else u_y * np.tanh(u / u_y)
    return _fibres(left, right, slip, 0.0, 0.0, 0.0, layer, memory, np.zeros((count, 2)), count), memory


@njit
def _unbalanced(q, couple, fixed, count):  # type: ignore[no-untyped-def]
    """Accelerations q'' of a wall that is held at q until all has come to rest."""
    still = np.zeros((count, 2))
    low, high = _at_rest(q[0], q[1], 0.0, fixed[1], count)[1], _at_rest(q[2], q[3], 0.0, fixed[2], count)[1]
    return _change(couple, 0.0, q, np.zeros(q.size), 0.0, fixed, low, high, still, still.copy())


@njit
def _change(couple, t, q, v, a, fixed, low, high, by_low, by_high):  # type: ignore[no-untyped-def]
    """Accelerations q'' at time t under the base acceleration a, and the rates of the memories of all fibres."""
    body, base, top, couples, geometry, numbers, lean = fixed
    n = q.size
    jacobian = np.empty((6, n))
    for i in range(n):
        moved = q.copy()
        moved[i] += SMALL
        up = _placed(moved, body)
        moved[i] -= 2.0 * SMALL
        jacobian[:, i] = (up - _placed(moved, body)) / (2.0 * SMALL)
    speed = np.sqrt(np.sum(v**2))
    turn = np.zeros(6)
    if speed > 0.0:
        ahead = q + TURN / speed * v
        behind = q - TURN / speed * v
        turn = (_placed(ahead, body) - 2.0 * _placed(q, body) + _placed(behind, body)) * (speed / TURN) ** 2
    masses = np.array([body[2], body[2], body[3], body[6], body[6], body[7]])
    loads = np.array(
        [-body[2] * (a + lean[0]), -body[2] * lean[1], 0.0, -body[6] * (a + lean[0]), -body[6] * lean[1], 0.0]
    )
    theta, rate = np.arcsin((q[0] - q[1]) / (2.0 * body[0])), 0.0
    for i in range(n):
        rate += jacobian[2, i] * v[i]
    beyond = max(0.0, abs(theta) - couples[1]) * np.sign(theta)
    loads[2] -= couples[0] * beyond + couples[2] * rate + couples[3] * np.tanh(rate / SLIDES)
    loads[2] += couples[4] * couple(t, theta, rate, 0.0, 0.0, a, numbers, geometry)
    count = low.shape[0]
    slips, slip_rates = np.zeros(2), np.zeros(2)
    for i in range(4, n):
        slips[i - 4], slip_rates[i - 4] = q[i], v[i]
    one = _fibres(q[0], q[1], slips[0], v[0], v[1], slip_rates[0], base, low, by_low, count)
    two = _fibres(q[2], q[3], slips[1], v[2], v[3], slip_rates[1], top, high, by_high, count)
    forces, inertia = np.array([one[0], one[1], two[0], two[1], one[2], two[2]])[:n], np.zeros((n, n))
    for i in range(n):
        for k in range(6):
            forces[i] += jacobian[k, i] * (loads[k] - masses[k] * turn[k])
            for j in range(n):
                inertia[i, j] += jacobian[k, i] * masses[k] * jacobian[k, j]
    return solved(inertia, forces)


@njit
def _integrate(couple, acceleration, step, per, fixed, start, count):  # type: ignore[no-untyped-def]
    q, v = start.copy(), np.zeros(start.size)
    low = _at_rest(q[0], q[1], 0.0, fixed[1], count)[1]
    body, high = fixed[0], _at_rest(q[2], q[3], 0.0, fixed[2], count)[1]
    found = np.zeros((2, acceleration.size))
    h = step / per
    shares, weights = (0.0, 0.5, 0.5, 1.0), (1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0)
    for n in range(acceleration.size - 1):
        for part in range(per):
            to_q, to_v = np.zeros(q.size), np.zeros(q.size)
            to_low, to_high = np.zeros((count, 2)), np.zeros((count, 2))
            by_q, by_v = np.zeros(q.size), np.zeros(q.size)
            by_low, by_high = np.zeros((count, 2)), np.zeros((count, 2))
            for stage in range(4):
                ahead = shares[stage] * h
                at_q, at_v, at_low, at_high = q + ahead * by_q, v + ahead * by_v, low.copy(), high.copy()
                at_low[:, :2] += ahead * by_low
                at_high[:, :2] += ahead * by_high
                along = (part + shares[stage]) / per
                a = (1.0 - along) * acceleration[n] + along * acceleration[n + 1]
                by_low, by_high = np.zeros((count, 2)), np.zeros((count, 2))
                second = _change(couple, (n + along) * step, at_q, at_v, a, fixed, at_low, at_high, by_low, by_high)
                by_q, by_v = at_v, second
                to_q += weights[stage] * by_q
                to_v += weights[stage] * by_v
                to_low += weights[stage] * by_low
                to_high += weights[stage] * by_high
            q, v = q + h * to_q, v + h * to_v
            low[:, :2] += h * to_low
            high[:, :2] += h * to_high
            for i in range(count):
                s = (i + 0.5) / count
                under, over = (1.0 - s) * q[0] + s * q[1], (1.0 - s) * q[2] + s * q[3]
                low[i, 2], high[i, 2] = max(low[i, 2], -under), max(high[i, 2], -over)
                if q.size > 4:
                    low[i, 3] = q[4] if under >= 0.0 else low[i, 3]
                    high[i, 3] = q[5] if over >= 0.0 else high[i, 3]
        placed = _placed(q, body)
        found[0, n + 1], found[1, n + 1] = placed[2], placed[5]
        if not abs(placed[2]) < 1.5 or not abs(placed[5]) < 1.5:
            found[:, n + 1 :] = np.nan
            break
    return found
