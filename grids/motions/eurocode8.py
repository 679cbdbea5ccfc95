"""Horizontal elastic response spectrum of Eurocode 8, EN 1998-1:2004, 3.2.2.2."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

LONGEST = 4.0
"""s: the spectrum of 3.2.2.2 is defined up to this period."""


@dataclass(frozen=True)
class Ground:
    """Soil factor S and the periods (s) at which the spectrum's branches meet."""

    soil_factor: float
    rise_end: float
    plateau_end: float
    velocity_end: float


GROUNDS: Mapping[int, Mapping[str, Ground]] = {
    1: {  # Table 3.2: surface-wave magnitude above 5.5
        "A": Ground(1.0, 0.15, 0.4, 2.0),
        "B": Ground(1.2, 0.15, 0.5, 2.0),
        "C": Ground(1.15, 0.20, 0.6, 2.0),
        "D": Ground(1.35, 0.20, 0.8, 2.0),
        "E": Ground(1.4, 0.15, 0.5, 2.0),
    },
    2: {  # Table 3.3: up to 5.5
        "A": Ground(1.0, 0.05, 0.25, 1.2),
        "B": Ground(1.35, 0.05, 0.25, 1.2),
        "C": Ground(1.5, 0.10, 0.25, 1.2),
        "D": Ground(1.8, 0.10, 0.30, 1.2),
        "E": Ground(1.6, 0.05, 0.25, 1.2),
    },
}
"""Recommended values by spectrum type and ground type (a National Annex may hold others)."""


@dataclass(frozen=True)
class ElasticSpectrum:
    """S_e(T) by Eqs 3.2 to 3.5, anchored at the peak ground acceleration ``pga`` = a_g S (m s-2)."""

    type: int
    ground: str
    pga: float
    damping: float = 0.05

    @property
    def damping_correction(self) -> float:
        """eta = sqrt(10/(5 + xi)) >= 0.55, xi in per cent (Eq. 3.6)."""
        return max(float(np.sqrt(10.0 / (5.0 + 100.0 * self.damping))), 0.55)

    def __call__(self, periods: FloatArray) -> FloatArray:
        """Pseudo-acceleration (n,) in m s-2 at ``periods`` (n,) in s; beyond 4 s the last branch goes on."""
        ground = GROUNDS[self.type][self.ground]
        plateau = 2.5 * self.damping_correction
        rise = 1.0 + periods / ground.rise_end * (plateau - 1.0)
        with np.errstate(divide="ignore"):
            fall = plateau * ground.plateau_end / periods
        shape = np.select(
            [periods <= ground.rise_end, periods <= ground.plateau_end, periods <= ground.velocity_end],
            [rise, np.full_like(periods, plateau), fall],
            fall * (ground.velocity_end / np.maximum(periods, ground.velocity_end)),
        )
        return np.asarray(self.pga * shape)
