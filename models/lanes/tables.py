"""Tables of lane kernels: filled before a run, read after it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import Event, FloatArray
from models.lanes.arrays import Tables
from models.runs import Request


def filled(size: int, columns: int, values: Mapping[int, Any] | Iterable[tuple[int, Any]]) -> FloatArray:
    """A table ``(size, columns)`` with the given columns, each ``(size,)`` or one number."""
    table = np.zeros((size, columns))
    for column, numbers in dict(values).items():
        table[:, column] = numbers
    return table


def groups(*keys: NDArray[Any]) -> Iterator[tuple[tuple[Any, ...], NDArray[np.intp]]]:
    """The lanes that share all ``keys``, arrays ``(n,)``: the values shared, and the lanes, in order."""
    if keys[0].size and all(np.all(key == key[0]) for key in keys):
        yield tuple(key[0].item() for key in keys), np.arange(keys[0].size)
        return
    for shared in sorted(set(zip(*(key.tolist() for key in keys), strict=True))):
        yield shared, np.flatnonzero(np.all([key == value for key, value in zip(keys, shared, strict=True)], axis=0))


def empty(request: Request, columns: int, states: int) -> Tables:
    """Tables for the lanes of ``request``: results of ``columns`` numbers, ``states`` numbers a sample."""
    n = request.scale.size
    return Tables(
        np.zeros((n, columns)), np.zeros((n, request.samples, states)), np.zeros((n, request.log, 3)),
        np.zeros(n, np.int64),
    )  # fmt: skip


def put(whole: Tables, lanes: NDArray[np.intp], found: Tables) -> None:
    """Take over what a kernel wrote for some of the lanes."""
    for table, rows in zip(whole, found, strict=True):
        table[lanes] = rows


def part(whole: Tables, lanes: slice) -> Tables:
    """The tables of some of the lanes, to write in."""
    return Tables(whole.result[lanes], whole.trace[lanes], whole.log[lanes], whole.length[lanes])


def logged(tables: Tables, kinds: Sequence[str]) -> tuple[tuple[Event, ...], ...]:
    """The events, lane by lane; ``kinds`` in the order of the kernel's numbers."""
    most = tables.log.shape[1]
    if not most:
        return ((),) * len(tables.log)
    return tuple(
        tuple(Event(float(time), kinds[int(kind)], int(body)) for time, kind, body in lane[: min(length, most)])
        for lane, length in zip(tables.log, tables.length.tolist(), strict=True)
    )
