"""What is read off a state of one wall: uplift of the joints, forces across them, who has toppled."""

from __future__ import annotations

import math
from collections.abc import Sequence

from models.base import FloatArray
from models.interface.reference.account import Pair, Reading
from models.interface.reference.equation import Equation, Ground


def read(equation: Equation, q: Sequence[float], v: Sequence[float], hidden: FloatArray, ground: Ground) -> Reading:
    """What the account of a run takes from a state, with the ``hidden`` state of what remembers."""
    base, top, _ = equation.strips(q, v, hidden)
    second = equation.accelerated(q, v, ground, (base, top)).tolist()
    return Reading(
        rotations=(q[0], q[1]),
        heights=uplift(equation, q, v),
        friction=friction(equation, q, v, second, ground),
        shares=(base.share, top.share),
        edges=edges(equation, q),
        stored=equation.stored(q, hidden),
        kinetic=equation.kinetic(q, v),
    )


def edges(equation: Equation, q: Sequence[float]) -> Pair:
    """Compression (m) of the more compressed end of each joint."""
    wall = equation.wall
    (z1, base), (z2, top) = (equation.at_joint(joint, q) for joint in ("base", "top"))
    return wall.base_half_width * abs(math.sin(base)) - z1, wall.top_half_width * abs(math.sin(top)) - z2


def uplift(equation: Equation, q: Sequence[float], v: Sequence[float]) -> tuple[float, float]:
    """Height (m) by which each joint's freer end is from carrying compression; negative: full contact.

    max over both ends of w, and under dashpot law B of (k w + c w')/k; -inf for a bonded joint.
    """
    wall = equation.wall
    found = []
    for joint in ("base", "top"):
        (z, angle), (z_rate, rate) = equation.at_joint(joint, q), equation.at_joint(joint, v)
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
    equation: Equation, q: Sequence[float], v: Sequence[float], second: Sequence[float], ground: Ground
) -> tuple[float, float]:
    """|H|/N along and across each joint's lower face; inf for N <= 0, 0 for a bonded joint."""
    joints, pulls = equation.wall.joints, equation.pulls(q, v, second, ground)
    block = pulls[-1]
    lean = q[0] - (equation.at_joint("top", q)[1] - (q[1] - q[0]))
    sine, cosine = math.sin(lean), math.cos(lean)
    along, across = block[0] * cosine - block[1] * sine, block[0] * sine + block[1] * cosine
    base = _ratio(sum(p[0] for p in pulls), sum(p[1] for p in pulls)) if joints != "top" else 0.0
    return base, _ratio(along, across) if joints != "base" else 0.0


def _ratio(along: float, across: float) -> float:
    return abs(along) / across if across > 0.0 else math.inf


def toppled(equation: Equation, q: Sequence[float], v: Sequence[float]) -> tuple[bool, bool]:
    """Whether the mass centre over each joint is past the joint's toe and moves outwards: base, top."""
    wall = equation.wall
    (centre, outward), (over, outward_2) = equation.leaning(q, v)
    side = math.copysign(1.0, q[0])
    # the toe lies at b1 where it is held, else at b1 cos(theta1)
    toe = wall.base_half_width * (1.0 if wall.toe_held else math.cos(q[0]))
    base = wall.joints != "top" and side * centre > toe and side * outward > 0.0
    side = math.copysign(1.0, equation.at_joint("top", q)[1])
    top = wall.joints != "base" and side * over > wall.top_half_width and side * outward_2 > 0.0
    return base, top
