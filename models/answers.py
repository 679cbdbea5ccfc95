"""What may be given out of a run: the numbers of lanes that have a valid answer, nothing of the others."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import MISSING, STATUS, UNANSWERED, Event, Quantity
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


def missing(quantity: Quantity) -> float:
    """What stands for an output that a run without a valid answer does not have."""
    return np.nan if np.dtype(quantity.dtype).kind == "f" else MISSING


def unanswered(declared: Iterable[Quantity], size: int, samples: int, states: int) -> Run:
    """Of lanes that cannot be run: ``status`` not_converged, other outputs nan or `MISSING`, states nan."""
    found: dict[str, NDArray[Any]] = {
        quantity.name: np.full(size, missing(quantity), np.float64) for quantity in declared
    }
    found["status"][:] = STATUS.index("not_converged")
    return Run(found, np.full((size, samples, states), np.nan), ((),) * size)


def among(declared: Iterable[Quantity], size: int, lanes: NDArray[np.intp], part: Run) -> Run:
    """The run of ``size`` lanes of which only ``lanes`` can be run, as ``part``; the others `unanswered`."""
    others = np.setdiff1d(np.arange(size), lanes)
    rest = unanswered(declared, others.size, *part.samples.shape[1:])
    outputs: dict[str, NDArray[Any]] = {}
    for name, values in part.outputs.items():
        outputs[name] = np.empty(size)
        outputs[name][lanes], outputs[name][others] = values, rest.outputs[name]
    samples = np.empty((size, *part.samples.shape[1:]))
    samples[lanes], samples[others] = part.samples, np.nan
    events: list[tuple[Event, ...]] = [()] * size
    for lane, own in zip(lanes.tolist(), part.events, strict=True):
        events[lane] = own
    return Run(outputs, samples, tuple(events), part.steps)
