"""What may be given out of a run: the numbers of lanes that have a valid answer, nothing of the others."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import MISSING, UNANSWERED, Quantity


def answers(
    declared: Iterable[Quantity], found: Mapping[str, NDArray[Any]], outputs: Sequence[str]
) -> dict[str, NDArray[Any]]:
    """The ``outputs`` (n,) as ``declared``, flags as int8.

    Where ``status`` is one of `UNANSWERED` every other output is nan, or `MISSING` for whole numbers and flags.
    """
    lost = np.isin(found["status"], UNANSWERED)
    kinds = {quantity.name: np.dtype(quantity.dtype) for quantity in declared}
    given = {}
    for name in outputs:
        values = np.asarray(found[name]).astype(np.int8 if kinds[name].kind == "b" else kinds[name], copy=False)
        missing = np.nan if values.dtype.kind == "f" else MISSING
        given[name] = values if name == "status" else np.where(lost, values.dtype.type(missing), values)
    return given
