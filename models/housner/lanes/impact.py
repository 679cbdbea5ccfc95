"""What happens at an impact, one lane: the ratio of angular velocities and the change of pivot."""

from __future__ import annotations

import math

from models.housner.lanes import rows as r
from models.housner.lanes.equation import MOST_INSET
from models.housner.lanes.table import IMPACT, of_given
from models.lanes.arrays import Table
from models.lanes.compiler import inlined


@inlined
def pivot(given: Table, w: Table, lane: int, slot: int, side: float) -> float:
    """b of a side at theta = 0: crushed by the peak so far, less the corner's radius."""
    half = given[lane, r.Q_RIGHT] if side > 0.0 else given[lane, r.Q_LEFT]
    inset = min(MOST_INSET, w[r.CRUSH, slot] * w[r.PEAK, slot])
    return float(half * (1.0 - inset) - given[lane, r.Q_RHO])


@inlined
def restitution(given: Table, result: Table, w: Table, lane: int, slot: int, side: float, omega: float) -> float:
    """theta'_after / theta'_before when the block leaves ``side``; the law of `models.housner.reference.impact`."""
    mass, height, inertia = given[lane, r.Q_MASS], given[lane, r.Q_HEIGHT], given[lane, r.Q_INERTIA]
    old = pivot(given, w, lane, slot, side)
    new = pivot(given, w, lane, slot, -side)
    e = given[lane, r.Q_RESTITUTION]
    if not e == e:
        e = (inertia + mass * (height * height - old * new)) / (inertia + mass * (height * height + new * new))
    e *= given[lane, r.Q_FACTOR]
    e *= 1.0 - given[lane, r.Q_ASPECT]
    exponent = given[lane, r.Q_EXPONENT]
    if exponent != 0.0 and result[lane, r.R_PEAK] > 0.0:
        e *= (result[lane, r.R_SWING] / result[lane, r.R_PEAK]) ** exponent
    e *= 1.0 - given[lane, r.Q_SLOPE] * abs(omega) / (given[lane, r.Q_P] * given[lane, r.Q_ALPHA])
    e *= max(given[lane, r.Q_FLOOR], 1.0 - given[lane, r.Q_LOSS] * result[lane, r.R_IMPACTS])
    if given.shape[1] > r.N_GIVEN:
        e *= 1.0 + of_given(given, r.N_GIVEN, IMPACT, lane, omega * given[lane, r.N_GIVEN + 1])
    square = inertia + mass * height * height
    neutral = math.sqrt((square + mass * old * old) / (square + mass * new * new))
    return float(min(max(e, 0.0), neutral))


@inlined
def kinetic_energy(given: Table, w: Table, lane: int, slot: int, side: float, omega: float) -> float:
    """Kinetic energy at theta = 0 about the pivot of ``side``, in J."""
    b = pivot(given, w, lane, slot, side)
    h = given[lane, r.Q_HEIGHT]
    return float(0.5 * (given[lane, r.Q_INERTIA] + given[lane, r.Q_MASS] * (h * h + b * b)) * omega * omega)
