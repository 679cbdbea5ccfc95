"""What happens at an impact, one lane: the ratio of angular velocities and the change of pivot."""

from __future__ import annotations

from typing import Any

from models.housner.lanes.equation import MOST_INSET
from models.housner.lanes.rows import (
    CRUSH, PEAK, Q_ALPHA, Q_ASPECT, Q_EXPONENT, Q_FACTOR, Q_FLOOR, Q_HEIGHT, Q_INERTIA, Q_LEFT, Q_LOSS,
    Q_MASS, Q_P, Q_RESTITUTION, Q_RHO, Q_RIGHT, Q_SLOPE, R_IMPACTS, R_PEAK, R_SWING, W,
)  # fmt: skip
from models.lanes.compiler import called

Table = Any


@called
def pivot(given: Table, w: Table, lane: int, slot: int, side: float) -> float:
    """b of a side at theta = 0: crushed by the peak so far, less the corner's radius."""
    half = given[Q_RIGHT, lane] if side > 0.0 else given[Q_LEFT, lane]
    inset = min(MOST_INSET, w[CRUSH * W + slot] * w[PEAK * W + slot])
    return float(half * (1.0 - inset) - given[Q_RHO, lane])


@called
def restitution(given: Table, result: Table, w: Table, lane: int, slot: int, side: float, omega: float) -> float:
    """theta'_after / theta'_before when the block leaves ``side``; the law of `models.housner.impact`."""
    mass, height, inertia = given[Q_MASS, lane], given[Q_HEIGHT, lane], given[Q_INERTIA, lane]
    old = pivot(given, w, lane, slot, side)
    new = pivot(given, w, lane, slot, -side)
    e = given[Q_RESTITUTION, lane]
    if not e == e:
        e = (inertia + mass * (height * height - old * new)) / (inertia + mass * (height * height + new * new))
    e *= given[Q_FACTOR, lane]
    e *= 1.0 - given[Q_ASPECT, lane]
    exponent = given[Q_EXPONENT, lane]
    if exponent != 0.0 and result[R_PEAK, lane] > 0.0:
        e *= (result[R_SWING, lane] / result[R_PEAK, lane]) ** exponent
    e *= 1.0 - given[Q_SLOPE, lane] * abs(omega) / (given[Q_P, lane] * given[Q_ALPHA, lane])
    e *= max(given[Q_FLOOR, lane], 1.0 - given[Q_LOSS, lane] * result[R_IMPACTS, lane])
    return float(max(e, 0.0))


@called
def kinetic_energy(given: Table, w: Table, lane: int, slot: int, side: float, omega: float) -> float:
    """Kinetic energy at theta = 0 about the pivot of ``side``, in J."""
    b = pivot(given, w, lane, slot, side)
    h = given[Q_HEIGHT, lane]
    return float(0.5 * (given[Q_INERTIA, lane] + given[Q_MASS, lane] * (h * h + b * b)) * omega * omega)
