"""Stuck samples: a logger that misses readings holds the last one, or a sensor hangs, while the body moves on.

Readings of a sensor with noise are hardly ever the same twice. Where one is held `FEWEST` times or more, and such runs
are the exception, the samples after the first are no measurement. The end of a range holds samples too: runs at the
largest and the smallest reading are left to `grids.recordings.flat_tops` and to the mechanism `saturation`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from grids.recordings.base import FloatArray
from grids.recordings.noise import WINDOW, noise_of

FEWEST, RARE = 5, 0.005
"""Samples of a run that no noise leaves, and the largest share of runs longer than one sample."""
JUMP, AHEAD = 6.0, 3.0
"""Deviations of the noise, and times the step after it, by which the reading jumps at the end: a body at rest without
noise, as in a simulation, moves on smoothly."""


def stuck(values: FloatArray) -> NDArray[np.intp]:
    """Which samples (n,) only repeat the one before them; none of a channel without noise, or of coarse digits."""
    if values.size < 2 * WINDOW + 2 or (sigma := noise_of(values).sigma) == 0.0:
        return np.zeros(0, np.intp)
    starts = np.flatnonzero(np.concatenate([[True], np.diff(values) != 0.0]))
    lengths = np.diff(np.append(starts, values.size))
    ends = (float(np.max(values)), float(np.min(values)))
    after = np.minimum(starts + lengths, values.size - 1)
    jump = np.abs(values[after] - values[starts])
    step = np.abs(values[np.minimum(after + 1, values.size - 1)] - values[after])
    long = (lengths >= FEWEST) & ~np.isin(values[starts], ends) & (jump > np.maximum(JUMP * sigma, AHEAD * step))
    if np.mean(lengths > 1) > RARE or not long.any():
        return np.zeros(0, np.intp)
    runs = [np.arange(first + 1, first + length) for first, length in zip(starts[long], lengths[long], strict=True)]
    return np.concatenate(runs)
