"""The arrays that lane kernels read and write."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Table = NDArray[np.float64]
Counts = NDArray[np.int64]


class Record(NamedTuple):
    """Channels of the base's motion at the ends of equal steps, with a quiet tail and a step or more to spare.

    ``samples`` (channels + 1, m): a and a_z (m s-2) and what else a kernel reads, then 1 for the steps of the
    shaking. ``extremes`` (channels, chunks): the largest size of each channel in every full chunk of
    `models.lanes.chunks.CHUNK` steps. ``step`` in s; the shaking ends at step ``shaken``, the tail at step ``end``.
    """

    samples: Table
    extremes: Table
    step: float
    shaken: int
    end: int


class Tables(NamedTuple):
    """What a kernel writes for n lanes: results (n, columns), states (n, samples, k), and a log of events.

    ``log`` (n, most, 3) holds time (s), kind and body of every event; ``length`` (n,) how many there were, those
    beyond the log's room included.
    """

    result: Table
    trace: Table
    log: Table
    length: Counts
