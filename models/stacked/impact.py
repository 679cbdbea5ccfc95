"""What an impact leaves of the velocities: projection in the kinetic metric.

The velocities q' = (theta_1', r') before an impact, about the old pivots, are projected onto the
motions that the pivots held afterwards allow: M q'_after = C q'_before, with M and C the kinetic
products of the motions about (new, new) and (new, old) pivots (`models.stacked.equation.products`).
What is held afterwards is chosen by `models.stacked.choice`. A projection never adds energy. Limits:
m2 -> 0 gives Housner's e; as one body before and after gives the composite block's e.

A joint's restitution may be given instead: x, the rate of that joint (theta_1' or r'), is then

    x_after = f x_projected      or, with a given ratio e,      x_after = f e x_before

and the other joint's rate follows from the projection with x_after held. |x_after| is limited so
that the kinetic energy does not grow.
"""

from __future__ import annotations

import math

from models.stacked.choice import Corners, choose
from models.stacked.equation import Rotations, System, held, products, vectors
from models.stacked.stack import Stack

Landing = tuple[int, int, float, float]
"""s1, s2, theta_1', r' after an impact."""
BASE, TOP = 0, 1


def impulses(stack: Stack, s1: int, s2: int, q: Rotations, rate: Rotations, linear: bool) -> Corners:
    """M and C q' for any pivots held afterwards; (s1, s2) are those before (0: closed)."""
    place = (0.0 * q[0], 0.0 * q[1]) if linear else q
    # the rate of a closed joint is 0, so which of its corners is taken makes no difference
    before = vectors(stack, s1 or 1, s2 or 1, place, linear)

    def system(c1: int, c2: int) -> System:
        after = vectors(stack, c1, c2, place, linear)
        m11, m12, _, m22 = products(stack, after, after)
        c11, c12, c21, c22 = products(stack, after, before)
        return System(m11, m12, m22, c11 * rate[0] + c12 * rate[1], c21 * rate[0] + c22 * rate[1])

    return system


def kinetic_energy(stack: Stack, s1: int, s2: int, q: Rotations, rate: Rotations, linear: bool) -> float:
    """In J, about the pivots (s1, s2) of a configuration."""
    m = impulses(stack, s1, s2, q, rate, linear)(s1 or 1, s2 or 1)
    return float(0.5 * (rate[0] * m.r1 + rate[1] * m.r2))


def impact(
    stack: Stack, joint: int, s1: int, s2: int, q: Rotations, rate: Rotations, linear: bool
) -> Landing:
    """The velocities and pivots after ``joint`` (`BASE` or `TOP`) of one wall has closed."""
    base = 0 if joint == BASE else s1
    top = 0 if joint == TOP else s2
    system = impulses(stack, s1, s2, q, rate, linear)
    new = choose(system, base, top)
    after = held(system(new[0] or 1, new[1] or 1), *new)
    given = (stack.base_restitution, stack.top_restitution)[joint]
    factor = (stack.base_factor, stack.top_factor)[joint]
    wanted = factor * (after[joint] if math.isnan(given) else given * rate[joint])
    if wanted == after[joint]:
        return (*new, float(after[0]), float(after[1]))
    energy = kinetic_energy(stack, s1, s2, q, rate, linear)
    return _imposed(system, joint, float(wanted), top if joint == BASE else base, energy)


def closed(
    stack: Stack, joint: int, s1: int, s2: int, q: Rotations, rate: Rotations, linear: bool
) -> Landing:
    """The velocities after ``joint`` has closed for good: what a bounce too small to follow ends in."""
    system = impulses(stack, s1, s2, q, rate, linear)
    energy = kinetic_energy(stack, s1, s2, q, rate, linear)
    return _imposed(system, joint, 0.0, s2 if joint == BASE else s1, energy)


def _imposed(system: Corners, joint: int, wanted: float, other: int, energy: float) -> Landing:
    """The rate of ``joint`` is ``wanted``; the other joint is up about ``other``, or (0) in contact."""
    side = (wanted > 0.0) - (wanted < 0.0)
    found: list[tuple[float, int, float, float]] = []
    for s in (other,) if other else (1, -1, 0):
        at = _turned(system(*_order(joint, side or 1, s or 1)), joint)
        free, stiff = (at.r2 / at.m22, at.m11 - at.m12 * at.m12 / at.m22) if s else (0.0, at.m11)
        spare = energy - 0.5 * at.m22 * free * free
        rate = math.copysign(min(abs(wanted), math.sqrt(max(0.0, 2.0 * spare / stiff))), wanted)
        second = (at.r2 - at.m12 * rate) / at.m22 if s else 0.0
        found.append((_fits(system, joint, side, s, rate, second, other), s, rate, second))
    _, s, rate, second = max(found)
    return (*_order(joint, side, s), *_pair(joint, rate, second))


def _fits(
    system: Corners, joint: int, side: int, s: int, rate: float, second: float, other: int
) -> float:
    """The margin of the other joint's state ``s`` when the rate of ``joint`` is held."""
    if other:
        return 0.0
    if s:
        return s * second
    pulls = []
    for c in (1, -1):
        at = _turned(system(*_order(joint, side or 1, c)), joint)
        pulls.append(-c * (at.r2 - at.m12 * rate) / at.m22)
    return float(min(pulls))


def _turned(system: System, joint: int) -> System:
    """The system with the unknown of ``joint`` first."""
    if joint == BASE:
        return system
    return System(system.m22, system.m12, system.m11, system.r2, system.r1)


def _order(joint: int, first: int, second: int) -> tuple[int, int]:
    return (first, second) if joint == BASE else (second, first)


def _pair(joint: int, first: float, second: float) -> tuple[float, float]:
    return (first, second) if joint == BASE else (second, first)
