"""What happens at an impact, one lane: the ratio of angular velocities and the change of pivot."""

from __future__ import annotations

import math
from typing import Any

from models.housner.lanes.equation import MOST_INSET
from models.housner.lanes.rows import (
    CRUSH,
    PEAK,
    Q_ALPHA,
    Q_ASPECT,
    Q_EXPONENT,
    Q_FACTOR,
    Q_FLOOR,
    Q_HEIGHT,
    Q_INERTIA,
    Q_LEFT,
    Q_LOSS,
    Q_MASS,
    Q_P,
    Q_RESTITUTION,
    Q_RHO,
    Q_RIGHT,
    Q_SLOPE,
    R_IMPACTS,
    R_PEAK,
    R_SWING,
    W,
)  # fmt: skip
from models.lanes.compiler import inlined

Table = Any


@inlined
def pivot(given: Table, w: Table, lane: int, slot: int, side: float) -> float:
    """b of a side at theta = 0: crushed by the peak so far, less the corner's radius."""
    half = given[lane, Q_RIGHT] if side > 0.0 else given[lane, Q_LEFT]
    inset = min(MOST_INSET, w[CRUSH * W + slot] * w[PEAK * W + slot])
    return float(half * (1.0 - inset) - given[lane, Q_RHO])


@inlined
def restitution(given: Table, result: Table, w: Table, lane: int, slot: int, side: float, omega: float) -> float:
    """theta'_after / theta'_before when the block leaves ``side``; the law of `models.housner.impact`."""
    mass, height, inertia = given[lane, Q_MASS], given[lane, Q_HEIGHT], given[lane, Q_INERTIA]
    old = pivot(given, w, lane, slot, side)
    new = pivot(given, w, lane, slot, -side)
    e = given[lane, Q_RESTITUTION]
    if not e == e:
        e = (inertia + mass * (height * height - old * new)) / (inertia + mass * (height * height + new * new))
    e *= given[lane, Q_FACTOR]
    e *= 1.0 - given[lane, Q_ASPECT]
    exponent = given[lane, Q_EXPONENT]
    if exponent != 0.0 and result[lane, R_PEAK] > 0.0:
        e *= (result[lane, R_SWING] / result[lane, R_PEAK]) ** exponent
    e *= 1.0 - given[lane, Q_SLOPE] * abs(omega) / (given[lane, Q_P] * given[lane, Q_ALPHA])
    e *= max(given[lane, Q_FLOOR], 1.0 - given[lane, Q_LOSS] * result[lane, R_IMPACTS])
    square = inertia + mass * height * height
    neutral = math.sqrt((square + mass * old * old) / (square + mass * new * new))
    return float(min(max(e, 0.0), neutral))


@inlined
def kinetic_energy(given: Table, w: Table, lane: int, slot: int, side: float, omega: float) -> float:
    """Kinetic energy at theta = 0 about the pivot of ``side``, in J."""
    b = pivot(given, w, lane, slot, side)
    h = given[lane, Q_HEIGHT]
    return float(0.5 * (given[lane, Q_INERTIA] + given[lane, Q_MASS] * (h * h + b * b)) * omega * omega)
