"""The equations of motion of two stacked blocks, in the coordinates theta_1 and r = theta_2 - theta_1.

Clockwise positive, Rot(t)(x, z) = (x cos t + z sin t, -x sin t + z cos t); s1, s2 = +-1 name the
pivots of the base and of the top joint. With u = s1 b1 - d1, w = s2 b2 - d1, v = s2 b2 - d2 (d1, d2
the shifts of the mass centres from the middle) the vectors

    A = Rot(theta_1)(-u, h1)          base pivot to G1
    B = Rot(theta_1)(w - u, 2 h1)     base pivot to the top joint's pivot
    C = Rot(theta_2)(-v, h2)          that pivot to G2;    D = B + C

turn into A_t = (A_z, -A_x) when differentiated by their angle, so Lagrange's equations M q'' = F,
q = (theta_1, r), are

    M11 = I1 + m1 A.A + I2 + m2 D.D      M12 = I2 + m2 D.C      M22 = I2 + m2 C.C
    F1 = m2 X (theta_2'^2 - theta_1'^2) + G (m1 A_x + m2 D_x) - a (m1 A_z + m2 D_z) - c theta_1' - C d - K1 psi''
    F2 = -m2 X theta_1'^2 + m2 (G C_x - a C_z) - K2 psi'',          X = B_z C_x - B_x C_z

(Psycharis, Earthquake Engng Struct. Dyn. 19, 1990; Spanos, Roussis, Politis, Soil Dyn. Earthquake
Engng 21, 2001, have them for each configuration.) A closed joint takes its row and column out.

C is the couple of dry friction between block 1 and the base, d the sign of theta_1'. Where theta_1' = 0 friction is
one more contact: it holds the wall, upright or not, as long as -C <= F1 - M12 r'' <= C (F1 without it), and the wall
that gets away goes the way d of what exceeds C. So it raises the threshold at which the base opens too.

A base that pitches by psi pushes with a - G psi in the place of a and, as its frame turns, with the couples K psi''
of both bodies upright, K1 = I1 + m1 h1^2 + I2 + m2 (2 h1 + h2)^2, K2 = I2 + m2 (2 h1 + h2) h2 (`models.pitch`).

Linear formulation: M at theta_1 = theta_2 = 0, A_x = -u + h1 theta_1, A_z = h1 and so on in F, and no
squares of velocities.

The functions take a `Stack` of arrays or of floats (`Stack.one`) and states of the same kind.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from models.stacked.stack import Stack

Real = Any
"""A float, or an array that broadcasts to the stack's lanes."""
Rotations = tuple[Real, Real]
"""theta_1 and r, or their rates."""
Ground = tuple[Real, Real, Real]
"""a - G psi, G (m s-2) and psi'' (rad s-2)."""


@dataclass(frozen=True)
class Vectors:
    """A, C and D of the module's docstring, each as x and z, in m."""

    ax: Real
    az: Real
    cx: Real
    cz: Real
    dx: Real
    dz: Real


@dataclass(frozen=True)
class System:
    """M x = R in two unknowns: x is q'' and R a force, or x is q' and R an impulse."""

    m11: Real
    m12: Real
    m22: Real
    r1: Real
    r2: Real


def vectors(stack: Stack, s1: Real, s2: Real, q: Rotations, linear: bool) -> Vectors:
    """The vectors for rotations ``q`` about the pivots ``s1`` and ``s2``."""
    left = -(s1 * stack.base_pivot - stack.shift_1)
    joint = left + s2 * stack.top_pivot - stack.shift_1
    right = -(s2 * stack.top_pivot - stack.shift_2)
    sine_1, cosine_1 = _sine_cosine(q[0], linear)
    sine_2, cosine_2 = _sine_cosine(q[0] + q[1], linear)
    # in the linear formulation only gravity's lever arms turn
    lift = 0.0 if linear else 1.0
    cx = right * cosine_2 + stack.centre_2 * sine_2
    cz = stack.centre_2 * cosine_2 - lift * right * sine_2
    return Vectors(
        left * cosine_1 + stack.centre_1 * sine_1,
        stack.centre_1 * cosine_1 - lift * left * sine_1,
        cx,
        cz,
        joint * cosine_1 + stack.height_1 * sine_1 + cx,
        stack.height_1 * cosine_1 - lift * joint * sine_1 + cz,
    )


def _sine_cosine(angle: Real, linear: bool) -> tuple[Real, Real]:
    if linear:
        return angle, 1.0
    if isinstance(angle, float):
        return math.sin(angle), math.cos(angle)
    return np.sin(angle), np.cos(angle)


def products(stack: Stack, after: Vectors, before: Vectors) -> tuple[Real, Real, Real, Real]:
    """Kinetic products of the motions about two sets of pivots: C11, C12, C21, C22 (M if they agree)."""
    m1, m2, i2 = stack.mass_1, stack.mass_2, stack.inertia_2
    return (
        stack.inertia_1
        + m1 * (after.ax * before.ax + after.az * before.az)
        + i2
        + m2 * (after.dx * before.dx + after.dz * before.dz),
        i2 + m2 * (after.dx * before.cx + after.dz * before.cz),
        i2 + m2 * (after.cx * before.dx + after.cz * before.dz),
        i2 + m2 * (after.cx * before.cx + after.cz * before.cz),
    )


def motion(
    stack: Stack, s1: Real, s2: Real, q: Rotations, rate: Rotations, ground: Ground, linear: bool, way: Real = 0.0
) -> System:
    """M q'' = F about the pivots ``s1``, ``s2`` (1 or -1); dry friction acts against ``way`` (1, -1, 0: not at all)."""
    v = vectors(stack, s1, s2, q, linear)
    a, gravity, turning = ground
    frame_1, frame_2 = stack.frame_inertia
    m1, m2 = stack.mass_1, stack.mass_2
    f1 = gravity * (m1 * v.ax + m2 * v.dx) - a * (m1 * v.az + m2 * v.dz)
    f2 = m2 * (gravity * v.cx - a * v.cz)
    still = vectors(stack, s1, s2, (0.0, 0.0), linear) if linear else v
    if not linear:
        w1, w2 = rate[0] * rate[0], (rate[0] + rate[1]) * (rate[0] + rate[1])
        cross = m2 * (v.dz * v.cx - v.dx * v.cz)
        f1, f2 = f1 + cross * (w2 - w1), f2 - cross * w1
    f1 = f1 - stack.viscous * stack.corner_inertia(s1) * rate[0] - stack.coulomb * way - frame_1 * turning
    f2 = f2 - frame_2 * turning
    m11, m12, _, m22 = products(stack, still, still)
    return System(m11, m12, m22, f1, f2)


def held(system: System, s1: int, s2: int) -> tuple[Real, Real]:
    """x of ``system`` in a configuration: 0 names a closed joint, whose row and column are left out."""
    if s1 and s2:
        determinant = system.m11 * system.m22 - system.m12 * system.m12
        return (
            (system.m22 * system.r1 - system.m12 * system.r2) / determinant,
            (system.m11 * system.r2 - system.m12 * system.r1) / determinant,
        )
    if s1:
        return system.r1 / system.m11, 0.0 * system.r1
    if s2:
        return 0.0 * system.r2, system.r2 / system.m22
    return 0.0 * system.r1, 0.0 * system.r2


def reactions(
    stack: Stack, v: Vectors, rate: Rotations, second: Rotations, ground: Ground
) -> tuple[Real, Real, Real, Real]:
    """H and N (N) at the base, then at the top joint: what the lower part does to the upper."""
    a, gravity, turning = ground
    bx, bz = v.dx - v.cx, v.dz - v.cz
    w1, w2 = rate[0] * rate[0], (rate[0] + rate[1]) * (rate[0] + rate[1])
    q1, q2 = second[0], second[0] + second[1]
    top_h = stack.mass_2 * (a + stack.height_2 * turning + q1 * bz + q2 * v.cz - w1 * bx - w2 * v.cx)
    top_n = stack.mass_2 * (gravity - q1 * bx - q2 * v.cx - w1 * bz - w2 * v.cz)
    base_h = top_h + stack.mass_1 * (a + stack.centre_1 * turning + q1 * v.az - w1 * v.ax)
    base_n = top_n + stack.mass_1 * (gravity - q1 * v.ax - w1 * v.az)
    return base_h, base_n, top_h, top_n
