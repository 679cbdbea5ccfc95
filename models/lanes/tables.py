"""The tables that lane kernels read and write, and what becomes of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.base import Event, FloatArray
from models.runs import Index, Request


def filled(size: int, columns: int, values: Mapping[int, Any] | Iterable[tuple[int, Any]]) -> FloatArray:
    """A table ``(size, columns)`` with the given columns, each ``(size,)`` or one number."""
    table = np.zeros((size, columns))
    for column, column_values in dict(values).items():
        table[:, column] = column_values
    return table


def groups(*keys: NDArray[Any]) -> Iterator[tuple[tuple[Any, ...], NDArray[np.intp]]]:
    """The lanes that share all ``keys``, arrays ``(n,)``: the values shared, and the lanes, in order."""
    for shared in sorted(set(zip(*(key.tolist() for key in keys), strict=True))):
        yield shared, np.flatnonzero(np.all([key == value for key, value in zip(keys, shared, strict=True)], axis=0))


@dataclass(frozen=True)
class Tables:
    """What a kernel writes for n lanes: ``result`` (n, columns), ``trace`` (n, samples, k), and a log of events.

    ``log`` (n, most, 3) holds time, kind and body; ``count`` (n,) how many events there were.
    """

    result: FloatArray
    trace: FloatArray
    log: FloatArray
    count: Index = field(default_factory=lambda: np.zeros(0, np.int64))

    @classmethod
    def empty(cls, request: Request, columns: int, states: int) -> Tables:
        n = request.scale.size
        return cls(
            np.zeros((n, columns)), np.zeros((n, request.samples, states)), np.zeros((n, request.log, 3)),
            np.zeros(n, np.int64),
        )  # fmt: skip

    def put(self, lanes: NDArray[np.intp], part: Tables) -> None:
        """Take over what a kernel wrote for some of the lanes."""
        self.result[lanes], self.trace[lanes] = part.result, part.trace
        self.log[lanes], self.count[lanes] = part.log, part.count

    def events(self, kinds: Sequence[str]) -> tuple[tuple[Event, ...], ...]:
        """The logged events, lane by lane; ``kinds`` in the order of the kernel's numbers."""
        most = self.log.shape[1]
        return tuple(
            tuple(Event(float(time), kinds[int(kind)], int(body)) for time, kind, body in lane[: min(count, most)])
            for lane, count in zip(self.log, self.count.tolist(), strict=True)
        )
