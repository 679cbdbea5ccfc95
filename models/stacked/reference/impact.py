"""What an impact leaves of the velocities: projection in the kinetic metric.

The velocities q' = (theta_1', r') before an impact, about the old pivots, are projected onto the
motions that the pivots held afterwards allow: M q'_after = C q'_before, with M and C the kinetic
products of the motions about (new, new) and (new, old) pivots (`models.stacked.equation.products`).
What is held afterwards is chosen by `models.stacked.reference.choice`. A projection never adds energy. Limits:
m2 -> 0 gives Housner's e; as one body before and after gives the composite block's e.

A joint's restitution may be given instead: x, the rate of that joint (theta_1' or r'), is then

    x_after = f x_projected      or, with a given ratio e,      x_after = f e x_before

and the other joint's rate follows from the projection with x_after held. |x_after| is limited so
that the kinetic energy does not grow.
"""

from __future__ import annotations

import math

from models.stacked.configuration import BASE, TOP, State
from models.stacked.equation import System, held, products, vectors
from models.stacked.reference.choice import SIDES, Corners, choose
from models.stacked.stack import Stack


def impulses(stack: Stack, state: State, linear: bool) -> Corners:
    """M and C q' for any pivots held after ``state``."""
    place = (0.0, 0.0) if linear else state.q
    before = vectors(stack, *state.corners, place, False)
    v1, v2 = state.rate

    def system(c1: int, c2: int) -> System:
        after = vectors(stack, c1, c2, place, False)
        m11, m12, _, m22 = products(stack, after, after)
        c11, c12, c21, c22 = products(stack, after, before)
        return System(m11, m12, m22, c11 * v1 + c12 * v2, c21 * v1 + c22 * v2)

    return system


def kinetic_energy(stack: Stack, state: State, linear: bool) -> float:
    """In J."""
    m = impulses(stack, state, linear)(*state.corners)
    return float(0.5 * (state.rate[0] * m.r1 + state.rate[1] * m.r2))


def impact(stack: Stack, joint: int, state: State, linear: bool) -> State:
    """One wall after ``joint`` (`BASE` or `TOP`) has closed."""
    base, top = (0, state.sides[1]) if joint == BASE else (state.sides[0], 0)
    system = impulses(stack, state, linear)
    sides = choose(system, base, top)
    after = held(system(sides[0] or 1, sides[1] or 1), *sides)
    given = (stack.base_restitution, stack.top_restitution)[joint]
    factor = (stack.base_factor, stack.top_factor)[joint]
    wanted = float(factor * (after[joint] if math.isnan(float(given)) else given * state.rate[joint]))
    if wanted == after[joint]:
        return State(sides, state.q, (float(after[0]), float(after[1])))
    return _imposed(stack, joint, state, linear, wanted)


def closed(stack: Stack, joint: int, state: State, linear: bool) -> State:
    """One wall after ``joint`` has closed for good: what a bounce too small to follow ends in."""
    return _imposed(stack, joint, state, linear, 0.0)


def _imposed(stack: Stack, joint: int, state: State, linear: bool, wanted: float) -> State:
    """The rate of ``joint`` is ``wanted``, less where energy would grow; the other joint answers.

    One that is up stays so; one in contact opens about the corner, or stays closed, as the condition
    of `models.stacked.reference.choice` says with the rate of ``joint`` held.
    """
    energy = kinetic_energy(stack, state, linear)
    corners = impulses(stack, state, linear)
    side = (wanted > 0.0) - (wanted < 0.0)
    other = state.sides[TOP if joint == BASE else BASE]

    def system(s: int) -> System:
        """The unknown of ``joint`` comes first."""
        if joint == BASE:
            return corners(side or 1, s)
        m = corners(s, side or 1)
        return System(m.m22, m.m12, m.m11, m.r2, m.r1)

    found = []
    for s in (other,) if other else (*SIDES, 0):
        m = system(s or 1)
        stiff = m.m11 - m.m12 * m.m12 / m.m22 if s else m.m11
        spare = energy - 0.5 * m.r2 * m.r2 / m.m22 if s else energy
        rate = math.copysign(min(abs(wanted), math.sqrt(max(0.0, 2.0 * spare / stiff))), wanted)
        second = (m.r2 - m.m12 * rate) / m.m22 if s else 0.0
        pulls = [-c * (at.r2 - at.m12 * rate) / at.m22 for c in SIDES for at in (system(c),)]
        found.append((s * second if s else min(pulls), s, rate, second))
    _, s, rate, second = max(found)
    if joint == BASE:
        return State((side, s), state.q, (rate, second))
    return State((s, side), state.q, (second, rate))
