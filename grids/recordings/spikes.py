"""Spikes: one or two samples of a rotation or displacement that stand alone, as a loose plug or a lost bit leaves them.

A cubic through two samples on either side foretells what a body that moves would have read. Where a rotation turns at
an impact its slope jumps, and the cubic is off by less than half the steps beside. A spike is off by many of them, and
by many deviations of the noise, and once it is bridged by the cubic nothing near it is off: so it is not in swings of
few samples, nor at wider gaps.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from grids.recordings.base import FloatArray
from grids.recordings.noise import MAD_TO_SIGMA, WINDOW, noise_of

LEAST, STEEP, OF_PEAK, QUANTA = 12.0, 3.0, 0.01, 3.0
"""Deviations of the noise, steps beside it, share of the largest reading and digits that a spike exceeds."""
LEFT, NEAR = 0.2, 8
"""Share of a spike that may be left anywhere within so many samples of it once it is bridged."""
WIDEST, BESIDE, AROUND = 2, 4, 65
MOST = 0.01
"""Share of the samples beyond which they are no spikes but what the channel is like."""


def spikes(values: FloatArray) -> NDArray[np.intp]:
    """Which samples (n,) of a position are spikes."""
    if values.size < 2 * WINDOW + 2:
        return np.zeros(0, np.intp)
    steps = np.diff(np.unique(values))
    least = max(
        LEAST * noise_of(values).sigma, OF_PEAK * float(np.max(np.abs(values))),
        QUANTA * float(np.min(steps, initial=np.inf)) if steps.size else np.inf,
    )  # fmt: skip
    found: set[int] = set()
    while len(found) <= MOST * values.size:
        left = bridged(values, np.array(sorted(found), np.intp))
        runs = sorted((run for width in range(1, WIDEST + 1) for run in _alone(left, width, least)), reverse=True)
        taken: list[int] = []  # the samples beside a spike are off too, by less
        for _, first, width in runs:
            if found.isdisjoint(range(first, first + width)) and all(abs(first - one) > BESIDE for one in taken):
                taken.append(first)
                found.update(range(first, first + width))
        if not taken:
            return np.array(sorted(found), np.intp)
    return np.zeros(0, np.intp)


def _alone(x: FloatArray, width: int, least: float) -> Iterator[tuple[float, int, int]]:
    """Runs of this ``width`` that are off what both sides foretell, to one side: by how much, first sample, width."""
    from scipy.ndimage import median_filter

    last = x.size - width - 2
    first = np.arange(2, last + 1)
    beside = np.stack([x[first - 2], x[first - 1], x[first + width], x[first + width + 1]])
    off = np.stack([x[first + k] - _weights(width, k) @ beside for k in range(width)])
    steep = STEEP * np.maximum(np.abs(beside[1] - beside[0]), np.abs(beside[3] - beside[2]))
    size = np.min(np.abs(off), axis=0)
    usual = LEAST * MAD_TO_SIGMA * median_filter(np.abs(off[0]), AROUND)  # noise may grow with the rotation
    clear = (size > np.maximum(np.maximum(least, steep), usual)) & (np.abs(np.sum(np.sign(off), axis=0)) == width)
    for at in np.flatnonzero(clear).tolist():
        if _even(x, int(first[at]), width, LEFT * float(size[at])):
            yield float(size[at]), int(first[at]), width


def _even(x: FloatArray, first: int, width: int, least: float) -> bool:
    """Whether all around is as foretold, within ``least``, once a run is bridged."""
    low, high = max(first - NEAR, 0), min(first + width + NEAR, x.size)
    near = bridged(x[low:high], np.arange(first - low, first - low + width))
    off = near[2:-2] - _weights(1, 0) @ np.stack([near[:-4], near[1:-3], near[3:-1], near[4:]])
    return float(np.max(np.abs(off))) < least


def _weights(width: int, k: int) -> FloatArray:
    """Of the cubic through samples at -2, -1, ``width``, ``width`` + 1 at the place ``k``."""
    places = np.array([-2.0, -1.0, width, width + 1.0])
    return np.array([np.prod([(k - o) / (p - o) for o in places if o != p]) for p in places])


def bridged(values: FloatArray, at: NDArray[np.intp]) -> FloatArray:
    """The samples with those ``at`` in runs on the cubic through two on either side of each run."""
    found = values.copy()
    for run in np.split(at, np.flatnonzero(np.diff(at) > 1) + 1) if at.size else ():
        first, width = int(run[0]), run.size
        beside = found[[first - 2, first - 1, first + width, first + width + 1]]
        for k in range(width):
            found[first + k] = _weights(width, k) @ beside
    return found
