"""What the wall under way holds while the lane kernel runs it: one table each, used again for the next wall."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from models.lanes.arrays import Counts, Table


class Work(NamedTuple):
    """State, readings and propagators of one wall; rows as in `models.interface_linear.lanes.rows`."""

    place: Counts
    """Configuration, level of the next step (0: the whole), switches since the sample, body that has fallen (4,)."""
    x: Table
    """State now (`N_STATE`,)."""
    to: Table
    """State at the end of the step under way."""
    before: Table
    """Reading of the state now (`N_READING`,)."""
    after: Table
    """Reading at the end of the step under way."""
    gathered: Table
    """(`N_GATHERED`,)."""
    propagators: Table
    """By configuration and level (25, levels, 12, 8); see `models.interface_linear.lanes.propagate.build`."""
    built: NDArray[np.bool_]
    """Configurations whose propagators are at hand (25,)."""
    motion: Table
    """Taylor series of the state (15, 8)."""
    watched: Table
    """Taylor series of the watched values (4, 15)."""
    powers: Table
    """Scratch of the propagators' series (12, 8), as is the next."""
    sums: Table
