"""What may be given out of a run: the numbers of lanes that have a valid answer, nothing of the others."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import MISSING, STATUS, UNANSWERED, Quantity
from models.runs import Run


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


def unanswered(declared: Iterable[Quantity], size: int, samples: int, states: int) -> Run:
    """Of lanes that cannot be run: ``status`` not_converged, other outputs nan or `MISSING`, states nan."""
    found: dict[str, NDArray[Any]] = {
        quantity.name: np.full(size, np.nan if np.dtype(quantity.dtype).kind == "f" else MISSING, np.float64)
        for quantity in declared
    }
    found["status"][:] = STATUS.index("not_converged")
    return Run(found, np.full((size, samples, states), np.nan), ((),) * size)


def among(whole: Run, lanes: NDArray[np.intp], part: Run) -> Run:
    """``whole`` with the outputs, states and events of ``lanes`` as those of ``part``."""
    outputs, samples, events = dict(whole.outputs), whole.samples.copy(), list(whole.events)
    for name, values in outputs.items():
        outputs[name] = values.copy()
        outputs[name][lanes] = part.outputs[name]
    samples[lanes] = part.samples
    for lane, own in zip(lanes.tolist(), part.events, strict=True):
        events[lane] = own
    return Run(outputs, samples, tuple(events), part.steps)
