"""What the record of the base tells of its accelerometer's zero, whatever stands on it.

A base that is shaken starts from rest and comes back to it, so over a recording of length T its acceleration has the
mean (v(T) - v(0))/T = 0, and a reading with a wrong zero has that zero. Records are cut, and a computed pulse may leave
the base with a velocity, so that may be anywhere in its range R about its trend at either end: the mean's standard
deviation is taken as `CUT` R/T.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from grids.recordings.base import REQUIRED, FloatArray, Recording

CUT = 0.5
"""Two velocities anywhere in a range differ by .41 of it (root mean square): records are cut where motion is strong."""
LEVEL = 0.01
"""m s-2; what an accelerometer's zero is known to at best: it drifts, and a table leans by a milliradian."""
NU = 4.0
"""Degrees of freedom: a record that is no whole motion, or was corrected, counts with its logarithm only."""


@dataclass(frozen=True)
class Zeros:
    """Of each recording (R,): ``mean`` of the reading and its standard ``deviation`` (m s-2), infinite if unknown."""

    mean: FloatArray
    deviation: FloatArray

    def rows(self, zero: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Residual r (R,) of zeros (R,) in m s-2, and its derivative: r^2 = NU log(1 + z^2/NU), z in deviations."""
        z = (self.mean - zero) / self.deviation
        size = np.sqrt(NU * np.log1p(z**2 / NU))
        slope = np.divide(np.abs(z), size, out=np.ones_like(z), where=size > 0.0) / (1.0 + z**2 / NU)
        return np.sign(z) * size, -slope / self.deviation


def zeros(recordings: Sequence[Recording]) -> Zeros:
    """Of the horizontal acceleration of the base; nothing is known of one that reads zero throughout."""
    found = np.array([_zero(r.channels[REQUIRED], r.time_step) for r in recordings]).reshape(-1, 2)
    return Zeros(found[:, 0], found[:, 1])


def _zero(base: FloatArray, time_step: float) -> tuple[float, float]:
    if not np.any(base):
        return 0.0, np.inf
    time = time_step * np.arange(base.size)
    velocity = time_step * np.cumsum(base)
    about = velocity - np.polyval(np.polyfit(time, velocity, 1), time)
    cut = CUT * float(np.ptp(about)) / (time_step * base.size)
    return float(np.mean(base)), float(np.hypot(cut, LEVEL))
