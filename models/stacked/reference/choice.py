"""Which configuration follows: the one whose motion and contacts are consistent.

At a closed joint three things may follow: the upper part turns about the right corner, about the
left one, or the joint stays closed. The candidates of all closed joints together (9 for two, 3 for
one) are held against one complementarity condition, the same for accelerations (x = q'', R = F)
and for the velocities after an impact (x = q', R the angular impulse):

    up about corner s    s x > 0
    closed               s (R - M x) <= 0 for both corners s: neither corner is pulled

with x = (theta_1, r) and M, R taken at the corners that the candidate names. Exactly one candidate
is admissible (checked on random geometries in the tests). At the very threshold between two the
one with the largest margin is taken.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from models.stacked.equation import System, held

Corners = Callable[[int, int], System]
"""The system for pivots s1, s2 (each 1 or -1)."""
SIDES = (1, -1)


def candidates(base: int, top: int) -> list[tuple[int, int]]:
    """The pairs that may follow; ``base``, ``top``: 0 in contact, else the corner of a joint already up."""
    bases = (base,) if base else (1, -1, 0)
    tops = (top,) if top else (1, -1, 0)
    return [(s1, s2) for s1 in bases for s2 in tops]


def margin(system: Corners, base: int, top: int, s1: int, s2: int) -> Any:
    """How far the candidate (s1, s2) is from inadmissible (< 0), in units of x; scalar or ``(n,)``."""
    margins = []
    for c1 in (s1,) if s1 else SIDES:
        for c2 in (s2,) if s2 else SIDES:
            at = system(c1, c2)
            x1, x2 = held(at, s1, s2)
            if base == 0:
                left = at.r1 - at.m12 * x2
                free = at.m11 - at.m12 * at.m12 / at.m22 if s2 else at.m11
                margins.append(s1 * x1 if s1 else -c1 * left / free)
            if top == 0:
                left = at.r2 - at.m12 * x1
                free = at.m22 - at.m12 * at.m12 / at.m11 if s1 else at.m22
                margins.append(s2 * x2 if s2 else -c2 * left / free)
    return np.min(margins, axis=0) if margins else np.inf


def choose(system: Corners, base: int, top: int, *, moving: bool = False) -> tuple[int, int]:
    """The admissible pair for one wall; ``moving`` leaves rest out (at the threshold itself)."""
    pairs = candidates(base, top)
    if moving:
        pairs.remove((0, 0))
    return max(pairs, key=lambda pair: float(margin(system, base, top, *pair)))
