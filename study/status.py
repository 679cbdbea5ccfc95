"""What can become of a cell: the flags of the cube's ``status``.

A model writes these numbers (0 to 5 in this order); `not_run` marks the cells of a block that has
not been computed, `failed` those of a block that raised an error and single lanes a model gave up.
"""

from __future__ import annotations

from models.base import STATUS

NOT_RUN, REST, ROCKING, OVERTURNED, NOT_CONVERGED, FAILED = range(len(STATUS))
UNKNOWN = (NOT_RUN, NOT_CONVERGED, FAILED)
"""Flags of cells whose outputs say nothing."""
