"""The kinematics of a wall with effects: two halves of the wall and the block on top, one after the other.

In the complex plane, x to the right and z up the imaginary axis, a rotation by t is a factor e^(-i t). With
q = (theta1, theta2, z1, z2, x1, x2, thetam, zm), H the wall's height, r = theta2 - thetam, e_t the top layer:

    P = X1 + x1 + i z1,  C = P + i H/2 e^(-i theta1)
    Ga = P + i H/4 e^(-i theta1),  Gb = C + i (H/4 + zm) e^(-i thetam)
    G2 = C + (Xr + x2 + i l) e^(-i thetam) + (d + i h2) e^(-i theta2),  l = H/2 + zm + e_t + z2
    X1 = sign(theta1) b1 (1 - cos theta1),  Xr = sign(r) bt (1 - cos r)     toe-held (0: midpoint-held)

x1, x2: slips of the base and of the top joint; thetam, zm: rotation of the wall's upper half and its distance from
the lower one, both halves rigid; d: the mass centre of the block beside the middle of its underside.
A wall that does not bend has thetam = theta1, zm = 0: with them its equations are those of the plain one.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from models.base import FloatArray
from models.interface.effects import Effects
from models.interface.layered import LayeredWall

SIZE = 8


class Chain(NamedTuple):
    """Places G (3, ...) in m, their Jacobians (3, 8, ...) and J' q' (3, ...), all x + i z; rotations R (3, 8)."""

    places: Any
    jacobians: Any
    bias: Any


ROTATIONS = np.zeros((3, SIZE))
ROTATIONS[0, 0] = ROTATIONS[1, 6] = ROTATIONS[2, 1] = 1.0
"""Angular velocities of the three bodies over q'."""


def masses(wall: Any) -> tuple[FloatArray, FloatArray]:
    """Masses (kg) and inertias (kg m2) of the three bodies, (3, ...)."""
    half = 0.5 * wall.mass_1
    inertia = 0.5 * wall.inertia_1 - wall.mass_1 * wall.height_1**2 / 32.0
    return np.array([half, half, wall.mass_2]), np.array([inertia, inertia, wall.inertia_2])


def chain(wall: Any, q: FloatArray, v: FloatArray) -> Chain:
    """At q, q' (8, ...) of one wall with plain floats in its fields, or of n."""
    t1, t2, z1, z2, x1, x2, tm, zm = q
    w1, w2, _, z2_rate, _, x2_rate, wm, zm_rate = v
    half, quarter, h2 = 0.5 * wall.height_1, 0.25 * wall.height_1, wall.centre_2
    turn, turn_rate, toe = t2 - tm, w2 - wm, 1.0 if wall.toe_held else 0.0
    b1, bt = toe * np.copysign(wall.base_half_width, t1), toe * np.copysign(wall.top_half_width, turn)
    e1, em, e2 = np.exp(-1j * t1), np.exp(-1j * tm), np.exp(-1j * t2)
    x1_d, x1_dd, xr_d, xr_dd = b1 * np.sin(t1), b1 * np.cos(t1), bt * np.sin(turn), bt * np.cos(turn)
    block, along = wall.effects.top_offset + 1j * h2, bt * (1.0 - np.cos(turn)) + x2
    level = half + zm + wall.top_thickness_in_height + z2
    upper = (along + 1j * level) * em
    low, high = 1j * quarter * e1, 1j * (quarter + zm) * em
    foot = b1 * (1.0 - np.cos(t1)) + x1 + 1j * z1
    cut = foot + 2.0 * low
    # d/dt of e^(-i t): a factor -i
    one, none = np.ones_like(e1), np.zeros_like(e1)
    jacobians = np.array(
        [
            [x1_d - 1j * low, none, 1j * one, none, one, none, none, none],
            [x1_d - 2j * low, none, 1j * one, none, one, none, -1j * high, 1j * em],
            [
                x1_d - 2j * low, xr_d * em - 1j * block * e2, 1j * one, 1j * em, one, em, -1j * upper - xr_d * em,
                1j * em,
            ],
        ]
    )  # fmt: skip
    at_foot = x1_dd * w1**2
    at_cut = at_foot - 2.0 * low * w1**2
    bias_high = at_cut - high * wm**2 + 2.0 * wm * zm_rate * em
    moving = xr_d * turn_rate + x2_rate + 1j * (zm_rate + z2_rate)
    bias_block = (
        at_cut - upper * wm**2 - 2j * wm * moving * em + xr_dd * turn_rate**2 * em - block * e2 * w2**2
    )  # fmt: skip
    return Chain(
        np.array([foot + low, cut + high, cut + upper + block * e2]),
        jacobians,
        np.array([at_foot - low * w1**2, bias_high, bias_block]),
    )


def free_coordinates(wall: LayeredWall, *, moving: bool = True) -> FloatArray:
    """P (8, k) of one wall: q = P p, p its coordinates that nothing holds; not ``moving``: dry friction holds, too."""
    effects = wall.effects or Effects.none(1)
    base, top = wall.joints != "top", wall.joints != "base"
    sheared = [np.isfinite(ratio.item()) for ratio in (effects.shear_base, effects.shear_top)]
    slides = (sheared[0] or (moving and np.isfinite(effects.friction.item()))) and base
    bends = bool(np.isfinite(effects.bending.item()))
    moves = [base, top, base, top, slides, sheared[1] and top, bends, bends]
    columns = []
    for k in range(SIZE):
        if not moves[k]:
            continue
        column = np.zeros(SIZE)
        column[k] = 1.0
        if k == 0 and not bends:
            column[6] = 1.0
        if (k == 6 or (k == 0 and not bends)) and not top:
            column[1] = 1.0
        columns.append(column)
    return np.array(columns).T
