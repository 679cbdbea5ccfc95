"""What a run of the plain reference gathers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from models.base import Event, FloatArray
from models.ground import PitchedPiece
from models.stacked import account as acc
from models.stacked.configuration import State, index
from models.stacked.equation import reactions, vectors
from models.stacked.stack import Stack


class Ledger:
    """What a run gathers: the account, the events, the history at the times of ``grid``."""

    def __init__(self, grid: FloatArray) -> None:
        self.grid = grid
        self.history = np.zeros((4, grid.size))
        self.written = 0
        self.events: list[Event] = []
        self.account = acc.blank(1)[0]
        self.frozen: FloatArray | None = None

    def mark_configuration(self, sides: tuple[int, int]) -> None:
        self.account[acc.VISITED] = int(self.account[acc.VISITED]) | 1 << index(*sides)

    def add_time(self, sides: tuple[int, int], time: float) -> None:
        self.account[acc.TIME_IN + index(*sides)] += time

    def peaks(self, states: Iterable[Sequence[float]]) -> None:
        for y in states:
            self.account[acc.PEAK_1] = max(self.account[acc.PEAK_1], abs(y[0]))
            self.account[acc.PEAK_2] = max(self.account[acc.PEAK_2], abs(y[0] + y[1]))

    def demand(
        self, stack: Stack, state: State, solution: Any, derivative: Callable[..., list[float]], piece: PitchedPiece,
        linear: bool,
    ) -> None:  # fmt: skip
        """Largest friction demand over eight points of every step of a stretch."""
        nodes = solution.t
        places = np.linspace(0, nodes.size - 1, 8 * (nodes.size - 1) + 1)
        fine = np.interp(places, np.arange(nodes.size), nodes)
        y = solution.sol(fine)
        second = np.array([derivative(t, y[:, k])[2:4] for k, t in enumerate(fine.tolist())]).T
        a, gravity, turning = np.array([piece.at(t) for t in fine.tolist()]).T
        v = vectors(stack, *state.corners, (y[0], y[1]), linear)
        base_h, base_n, top_h, top_n = reactions(stack, v, (y[2], y[3]), (second[0], second[1]), (a, gravity, turning))
        for column, h, n in ((acc.FRICTION_BASE, base_h, base_n), (acc.FRICTION_TOP, top_h, top_n)):
            ratio = np.where(n > 0.0, np.abs(h) / np.where(n > 0.0, n, 1.0), acc.BOUNDLESS)
            self.account[column] = max(self.account[column], float(np.max(ratio)))

    def write(self, end: float, dense: Callable[[FloatArray], FloatArray] | None) -> None:
        """History up to ``end`` (s); without a dense output the stack is at rest."""
        stop = int(np.searchsorted(self.grid, end, side="right"))
        if stop > self.written:
            fresh = slice(self.written, stop)
            self.history[:, fresh] = dense(self.grid[fresh])[:4] if dense else 0.0
            self.written = stop

    def overturn(self, body: int, time: float, state: State) -> None:
        """A body has overturned; with the wall overturns what stands on it. The account ends here."""
        self.account[acc.OVERTURNED_2] = time
        if body == 1:
            self.account[acc.OVERTURNED_1] = time
        self.events.append(Event(time, "overturned", body))
        self.frozen = self._line(state)

    def _line(self, state: State) -> FloatArray:
        line: FloatArray = self.account.copy()
        line[acc.END_1], line[acc.END_2] = state.theta
        return line

    def closed(self, state: State) -> FloatArray:
        """The account of the run; the history stays where the run has ended."""
        self.history[:, self.written :] = np.array([[*state.q, 0.0, 0.0]]).T
        return self._line(state) if self.frozen is None else self.frozen
