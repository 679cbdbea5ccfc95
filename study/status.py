"""What can become of a cell: the flags of the cube's ``status``.

A model writes these numbers, in the order of `models.base.STATUS`; ``not_run`` marks the cells of a block that has
not been computed, ``failed`` those of a block that raised an error.
"""

from __future__ import annotations

from models.base import STATUS, UNANSWERED

NOT_RUN, REST, ROCKING, OVERTURNED, OUTSIDE_MODEL, NOT_CONVERGED, FAILED = range(len(STATUS))
UNKNOWN = (NOT_RUN, *UNANSWERED)
"""Flags of cells without a valid result."""
