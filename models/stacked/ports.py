"""Where forces that the model lacks may act on two stacked blocks, and which bodies an impulse there moves.

An impulse of the generalised forces Q on theta_1 and r = theta_2 - theta_1 changes their rates by M^-1 Q, M about the
pivots of the moment (`models.stacked.equation`); a closed joint takes its row and column out: as one body, the block
alone, or nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from models.base import FloatArray
from models.identification import Port
from models.stacked.equation import Vectors, products, vectors
from models.stacked.stack import Stack

Seen = Mapping[str, FloatArray]


def _jumps(stack: Stack, at: Seen, force: Any) -> dict[str, FloatArray]:
    """Changes of both angular velocities by an impulse that resists; ``force(v)``: Q of a unit, from the vectors v."""
    theta, r = at["rotation_1"], at["rotation_2"] - at["rotation_1"]
    s1, s2 = np.sign(theta), np.sign(r)
    one = stack.one()
    v = vectors(one, np.where(s1 == 0.0, 1.0, s1), np.where(s2 == 0.0, 1.0, s2), (theta, r), False)
    m11, m12, _, m22 = products(one, v, v)
    base, top = s1 != 0.0, s2 != 0.0
    q1, q2 = force(v)
    q1, q2, m12 = np.where(base, q1, 0.0), np.where(top, q2, 0.0), np.where(base & top, m12, 0.0)
    determinant = m11 * m22 - m12**2
    lower = -(m22 * q1 - m12 * q2) / determinant
    return {"rotation_rate_1": lower, "rotation_rate_2": lower - (m11 * q2 - m12 * q1) / determinant}


def _in_the_base(v: Vectors) -> tuple[float, float]:
    return 1.0, 0.0


def _in_the_top_joint(v: Vectors) -> tuple[float, float]:
    return 0.0, 1.0


def _on_the_block(v: Vectors) -> tuple[Any, Any]:
    return v.dz, v.cz


BASE = Port("base", lambda seen: seen["rotation_1"], lambda stack, at: _jumps(stack, at, _in_the_base))
TOP = Port(
    "top", lambda seen: seen["rotation_2"] - seen["rotation_1"], lambda stack, at: _jumps(stack, at, _in_the_top_joint)
)
BLOCK = Port("block", lambda seen: seen["displacement_2_x"], lambda stack, at: _jumps(stack, at, _on_the_block))
"""A couple in either joint (N m s), a horizontal force on the upper block (N s)."""
