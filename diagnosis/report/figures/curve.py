"""Long curves with no more points than a page can show."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
MOST_POINTS = {False: 900, True: 400}
"""On the wide and on the narrow page."""


def thin(time: FloatArray, values: FloatArray, narrow: bool) -> tuple[FloatArray, FloatArray]:
    """The smallest and the largest sample of each bin, in their order; short curves as they are.

    nan stays nan where a whole bin is nan, so that gaps show.
    """
    most = MOST_POINTS[narrow]
    if values.size <= most:
        return time, values
    per_bin = -(-2 * values.size // most)
    count = -(-values.size // per_bin)
    padded = np.concatenate([values, np.full(count * per_bin - values.size, np.nan)]).reshape(count, per_bin)
    ends = [np.where(np.isnan(padded), fill, padded) for fill in (np.inf, -np.inf)]
    chosen = np.sort(np.stack([ends[0].argmin(axis=1), ends[1].argmax(axis=1)], axis=1), axis=1)
    flat = np.minimum((chosen + per_bin * np.arange(count)[:, None]).ravel(), values.size - 1)
    return time[flat], values[flat]
