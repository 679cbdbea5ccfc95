"""Measures of a record by which a set of motions is sorted, and how they grow when the record is scaled.

A motion multiplied by s has PGA, PGV, PGD and Sa(T) s times, Arias intensity s^2 times as large; durations and
PGV/PGA stay. The values are those of the record as read, before any scaling.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grids.motions.base import Motion
from grids.motions.intensity import high_pass_of, intensity_measures, velocity_and_displacement
from grids.motions.spectrum import response_spectrum
from models.errors import InputError

DAMPING = 0.05
PERIODS = (0.1, 0.2, 0.3, 0.5, 1.0, 2.0, 4.0)
"""s: periods of the pseudo-accelerations that are kept."""


@dataclass(frozen=True)
class Measure:
    """``power``: the measure of a motion scaled by s is s^power times the record's; ``stretch``: under a time
    scale t it is t^stretch times as large, None where it does not follow from the record's value."""

    name: str
    symbol: str
    unit: str
    meaning: str
    power: float
    stretch: float | None


_FILTER = "after the high-pass rule of grids.motions.intensity"
MEASURES = (
    Measure("pga", "PGA", "m s-2", "peak horizontal acceleration of the record", 1.0, 0.0),
    Measure("pgv", "PGV", "m s-1", f"peak horizontal velocity of the record, {_FILTER}", 1.0, 1.0),
    Measure("pgd", "PGD", "m", f"peak horizontal displacement of the record, {_FILTER}", 1.0, 2.0),
    Measure(
        "velocity_range",
        "max v - min v",
        "m s-1",
        f"largest impulse of any interval of the record, {_FILTER}",
        1.0,
        1.0,
    ),
    Measure(
        "displacement_range", "max d - min d", "m", f"range of the displacement of the record, {_FILTER}", 1.0, 2.0
    ),
    Measure("arias", "I_A", "m s-1", "Arias intensity of the record, pi/(2 g) int a^2 dt", 2.0, 1.0),
    Measure("duration", "D_5-95", "s", "time from 5 to 95 % of the Arias intensity of the record", 0.0, 1.0),
    Measure("pgv_over_pga", "PGV/PGA", "s", "peak velocity over peak acceleration of the record", 0.0, 1.0),
    *(
        Measure(
            f"sa_{period:g}s",
            f"Sa({period:g} s)",
            "m s-2",
            f"pseudo-acceleration of the record at {period:g} s and {DAMPING:.0%} damping",
            1.0,
            None,
        )
        for period in PERIODS
    ),
)
PREFIX = "record_"
"""A cube's coordinate of a measure is called by this and its name."""


def measures_of(motion: Motion) -> dict[str, float]:
    """Value of every measure of the horizontal component, by name; nan where a silent or short record has none."""
    try:
        found = intensity_measures(motion)
    except InputError:
        return {measure.name: motion.pga if measure.name == "pga" else np.nan for measure in MEASURES}
    corner = high_pass_of(motion)
    velocity, displacement = velocity_and_displacement(motion.horizontal, motion.time_step, corner)
    spectrum = response_spectrum(motion.horizontal, motion.time_step, PERIODS, DAMPING)
    return {
        "pga": found.pga,
        "pgv": found.pgv,
        "pgd": found.pgd,
        "velocity_range": float(np.ptp(velocity)),
        "displacement_range": float(np.ptp(displacement)),
        "arias": found.arias,
        "duration": found.significant_duration,
        "pgv_over_pga": found.pgv / found.pga,
        **{f"sa_{t:g}s": float(sa) for t, sa in zip(PERIODS, spectrum.pseudo_acceleration, strict=True)},
    }
