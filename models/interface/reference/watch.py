"""What is read off a state of one wall: uplift of the joints, forces across them, who has toppled."""

from __future__ import annotations

import math
import operator
from collections.abc import Sequence

from models.base import FloatArray
from models.interface.reference.account import Pair, Reading
from models.interface.reference.equation import Equation


def read(
    equation: Equation, q: Sequence[float], v: Sequence[float], hidden: FloatArray, a: float, gravity: float
) -> Reading:
    """What the account of a run takes from a state under a and G, with the laws' ``hidden`` state."""
    base, top, _ = equation.strips(q, v, hidden)
    second = equation.acceleration(q, v, a, gravity, (base, top)).tolist()
    return Reading(
        rotations=(q[0], q[1]),
        heights=uplift(equation, q, v),
        friction=friction(equation, q, v, second, a, gravity),
        shares=(base.share, top.share),
        edges=edges(equation, q),
        stored=equation.stored(q, hidden),
        kinetic=equation.kinetic(q, v),
    )


def edges(equation: Equation, q: Sequence[float]) -> Pair:
    """Compression (m) of the more compressed end of each joint."""
    wall = equation.wall
    turn = q[1] - q[0]
    base = wall.base_half_width * abs(math.sin(q[0])) - q[2]
    return base, wall.top_half_width * abs(math.sin(turn)) - q[3]


def uplift(equation: Equation, q: Sequence[float], v: Sequence[float]) -> tuple[float, float]:
    """Height (m) by which each joint's freer end is from carrying compression; negative: full contact.

    max over both ends of w, and under dashpot law B of (k w + c w')/k; -inf for a bonded joint.
    """
    wall = equation.wall
    found = []
    for joint, z, angle, z_rate, rate in (
        ("base", q[2], q[0], v[2], v[0]),
        ("top", q[3], q[1] - q[0], v[3], v[1] - v[0]),
    ):
        if wall.joints not in ("both", joint):
            found.append(-math.inf)
            continue
        b = wall.base_half_width if joint == "base" else wall.top_half_width
        k = wall.base_stiffness if joint == "base" else wall.top_stiffness
        c = wall.base_damping if joint == "base" else wall.top_damping
        s, s_rate = math.sin(angle), math.cos(angle) * rate
        height = z + b * abs(s)
        if wall.clip:
            height = max(height, z + c / k * z_rate + b * abs(s + c / k * s_rate))
        found.append(height)
    return found[0], found[1]


def friction(
    equation: Equation, q: Sequence[float], v: Sequence[float], second: Sequence[float], a: float, gravity: float
) -> tuple[float, float]:
    """|H|/N along and across each joint's lower face; inf for N <= 0, 0 for a bonded joint."""
    wall, at = equation.wall, equation.kinematics(q, v)
    ground = (a, gravity)
    pull_1, pull_2 = (
        [sum(map(operator.mul, row, second)) + b + f for row, b, f in zip(rows, bias, ground, strict=True)]
        for rows, bias in ((at.jacobian_1, at.bias_1), (at.jacobian_2, at.bias_2))
    )
    total = [wall.mass_1 * p + wall.mass_2 * r for p, r in zip(pull_1, pull_2, strict=True)]
    sine, cosine = math.sin(q[0]), math.cos(q[0])
    along = wall.mass_2 * (pull_2[0] * cosine - pull_2[1] * sine)
    across = wall.mass_2 * (pull_2[0] * sine + pull_2[1] * cosine)
    base = _ratio(total[0], total[1]) if wall.joints != "top" else 0.0
    return base, _ratio(along, across) if wall.joints != "base" else 0.0


def _ratio(along: float, across: float) -> float:
    return abs(along) / across if across > 0.0 else math.inf


def toppled(equation: Equation, q: Sequence[float], v: Sequence[float]) -> tuple[bool, bool]:
    """Whether the mass centre over each joint is past the joint's toe and moves outwards: base, top."""
    wall, at = equation.wall, equation.kinematics(q, v)
    mass = wall.mass_1 + wall.mass_2
    rate_1, rate_2 = (sum(map(operator.mul, rows[0], v)) for rows in (at.jacobian_1, at.jacobian_2))
    side = math.copysign(1.0, q[0])
    centre = (wall.mass_1 * at.centre_1[0] + wall.mass_2 * at.centre_2[0]) / mass
    outward = (wall.mass_1 * rate_1 + wall.mass_2 * rate_2) / mass
    # the toe lies at b1 where it is held, else at b1 cos(theta1)
    toe = wall.base_half_width * (1.0 if wall.toe_held else math.cos(q[0]))
    base = wall.joints != "top" and side * centre > toe and side * outward > 0.0
    turn = q[1] - q[0]
    side = math.copysign(1.0, turn)
    # from the toe of body 2 to its centre: half the joint back along its underside, h2 up
    lean = -wall.top_half_width * math.cos(q[1]) + side * wall.centre_2 * math.sin(q[1])
    top = wall.joints != "base" and lean > 0.0 and side * (v[1] - v[0]) > 0.0
    return base, top
