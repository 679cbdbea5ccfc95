"""Whether the displacements of a recording are its accelerations, integrated twice.

Then both are one measurement: the acceleration less that of the base, high-passed and integrated, high-passed and
integrated again (`grids.instruments.integrated_displacement`), reproduces the displacement, at the corner of the
laboratory's filter better than at any other. Means over some hundredths of a second are compared: what is integrated
twice is slow.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from grids.instruments.integrated_displacement import high_passed
from grids.recordings.base import REQUIRED, FloatArray, Recording

LOWEST, HIGHEST, TRIED = 0.02, 0.5, 25
"""Hz; corners that are tried, evenly in the logarithm, before the best of them is refined."""
WIDER = 1.14
"""Factor about the best of them within which it is refined."""
STEP = 0.02
"""s, of the means that are compared at least."""
REPRODUCED = 0.03
"""Rms error over rms displacement under which the one is made of the other."""
SHARPER = 3.0
"""How much larger the error must be at half and at twice the corner: else nothing tells that there is a filter."""


@dataclass(frozen=True)
class Integrated:
    """``displacement`` is ``acceleration`` integrated: ``corner_hz`` of the filter, ``error`` of reproducing it."""

    displacement: str
    acceleration: str
    corner_hz: float
    error: float

    def __str__(self) -> str:
        return (
            f"{self.displacement} is {self.acceleration} less that of the base, integrated twice and high-passed at "
            f"{self.corner_hz:.3g} Hz before each integration (reproduced to {self.error:.1%} of its rms): one "
            "measurement"
        )


def integrated(recordings: Sequence[Recording], displacement: str, acceleration: str) -> Integrated | None:
    """Whether the displacements of all recordings that hold both channels are integrated; one corner for all.

    None where one of them is not, where no filter is seen, or no recording holds both. The error is the median over
    points of measurement, of the worst recording.
    """
    held = [r for r in recordings if displacement in r.channels and acceleration in r.channels]
    if not held:
        return None
    if any(0.5 / max(STEP, r.time_step) <= HIGHEST * WIDER for r in held):  # too coarse to tell a corner
        return None
    pairs = [_means(r, displacement, acceleration) for r in held]

    def error(corner: float) -> float:
        return max(_error(*pair, corner) for pair in pairs)

    corners = np.geomspace(LOWEST, HIGHEST, TRIED)
    best = float(corners[int(np.argmin([error(c) for c in corners]))])
    near = best * np.geomspace(1.0 / WIDER, WIDER, 13)
    errors = [error(c) for c in near]
    corner, least = float(near[int(np.argmin(errors))]), min(errors)
    blunt = min(error(0.5 * corner), error(min(2.0 * corner, HIGHEST))) < SHARPER * least
    if least > REPRODUCED or blunt or not LOWEST < best < HIGHEST:
        return None
    return Integrated(displacement, acceleration, corner, least)


def _means(recording: Recording, displacement: str, acceleration: str) -> tuple[FloatArray, FloatArray, float]:
    """Displacements and relative accelerations (points, n) as means over a step (s)."""
    size = max(1, round(STEP / recording.time_step))
    relative = recording.channels[acceleration] - recording.channels[REQUIRED]
    found = []
    for values in (recording.channels[displacement], relative):
        rows = np.atleast_2d(values)
        n = rows.shape[1] // size
        found.append(rows[:, : n * size].reshape(rows.shape[0], n, size).mean(axis=2))
    return found[0], found[1], size * recording.time_step


def _error(displacement: FloatArray, relative: FloatArray, step: float, corner: float) -> float:
    made = _area(high_passed(_area(high_passed(relative, corner, step), step), corner, step), step)
    rms = np.sqrt(np.mean(displacement**2, axis=1))
    error = np.sqrt(np.mean((made - displacement) ** 2, axis=1))
    return float(np.median(error / np.maximum(rms, 1e-300)))


def _area(values: FloatArray, step: float) -> FloatArray:
    """Integral from the first sample, by the trapezium rule."""
    pairs = 0.5 * step * (values[:, 1:] + values[:, :-1])
    return np.concatenate([np.zeros((values.shape[0], 1)), np.cumsum(pairs, axis=1)], axis=1)
