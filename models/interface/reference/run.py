"""The plain, slow and exact route: scipy's DOP853 over every straight piece of the ground's motion."""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import solve_ivp

from models.base import FloatArray
from models.ground import Piece, pieces
from models.interface import modes
from models.interface.declaration import CALM, STATES
from models.interface.layered import LayeredWall
from models.interface.observe import with_onset
from models.interface.reference import watch
from models.interface.reference.account import Account
from models.interface.reference.equation import Equation, power
from models.runs import Request, Run


def run(wall: LayeredWall, request: Request, rtol: float = 1e-10) -> Run:
    """One wall (a `LayeredWall` of one lane) as requested, from the start of the shaking. Samples: q, q'."""
    body = _Run(wall, request.times, rtol, may_rest=not request.history)
    rest = dict(zip(STATES, [*modes.static_state(wall)[0], 0.0, 0.0, 0.0, 0.0], strict=True))
    body.begin(np.array([request.start.get(name, rest[name]) for name in STATES]))
    for piece in pieces(wall, request.shaking, float(request.scale[0]), request.until):
        body.advance(piece, shaken=piece.start < request.shaking.duration)
        if body.finished:
            break
    return body.result()


class _Run:
    """State of one run: y = (p, p', works of both strips, hidden states), p the free coordinates."""

    def __init__(self, wall: LayeredWall, grid: FloatArray, rtol: float, *, may_rest: bool) -> None:
        self.equation = Equation(wall)
        self.free = self.equation.free
        self.half = self.free.shape[1]
        self.grid, self.rtol, self.may_rest = grid, rtol, may_rest
        self.history = np.zeros((8, grid.size))
        self.written, self.finished = 0, False
        self.time, self.calm_since, self.most = 0.0, math.nan, 0.0
        self.y = np.zeros(2 * self.half + 2)
        self.pick = [int(np.flatnonzero(column)[-1]) for column in self.free.T]
        scale = np.abs(modes.static_state(wall)[0])
        free_sizes = np.array([float(wall.slenderness[0]), float(wall.slenderness_2[0]), *scale[2:]])[self.pick]
        fastest = math.sqrt(abs(float(modes.at_rest(wall).squares[0, 0])))
        weight = float(wall.mass[0] * wall.gravity[0] * wall.base_half_width[0] * wall.slenderness[0])
        hidden = np.full(self.equation.relaxed().size, float(np.max(scale)))
        self.atol = rtol * np.concatenate([free_sizes, free_sizes * fastest, (weight, weight), hidden])
        self.period = 2.0 * math.pi / fastest
        self.account = Account(self.equation.wall)

    def begin(self, state: FloatArray) -> None:
        self.y = np.concatenate(
            [state[:4][self.pick], state[4:][self.pick], (0.0, 0.0), self.equation.relaxed(state[:4].tolist())]
        )

    def spread(self, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """q and q' of the free coordinates."""
        return self.free @ y[: self.half], self.free @ y[self.half : 2 * self.half]

    def advance(self, piece: Piece, shaken: bool) -> None:
        """Through one straight piece of the ground's motion; ``shaken`` is false after the record's end."""
        self.time = piece.start
        change, works = np.empty(self.y.size), 2 * self.half

        def derivative(time: float, y: FloatArray) -> FloatArray:
            q, v = (part.tolist() for part in self.spread(y))
            base, top, rates = self.equation.strips(q, v, y[works + 2 :])
            change[: self.half] = y[self.half : works]
            change[self.half : works] = self.equation.acceleration(q, v, *piece.at(time), (base, top))[self.pick]
            change[works : works + 2] = power((base, top), q, v)
            change[works + 2 :] = rates
            return change.copy()

        def fall(time: float, y: FloatArray) -> float:
            q, _ = self.spread(y)
            return float(np.max(np.abs(q[:2])) - math.pi / 2.0)

        fall.terminal = True  # type: ignore[attr-defined]
        # without shaking, look at the motion now and then: it may have come to rest
        ends = [piece.end] if shaken else [*np.arange(piece.start + self.period, piece.end, self.period), piece.end]
        for end in ends:
            solution = solve_ivp(
                derivative, (self.time, end), self.y, "DOP853", events=fall, dense_output=True, rtol=self.rtol,
                atol=self.atol,
            )  # fmt: skip
            if not solution.success:
                self.account.failed, self.finished = True, True
                return
            self._note(solution, piece)
            self.time, self.y = float(solution.t[-1]), solution.y[:, -1]
            if solution.status == 1:
                q, _ = self.spread(self.y)
                self.account.fall(self.time, q)
                self.finished = True
                return
            if not shaken and self._at_rest():
                self.finished = self.may_rest
                self.account.rest(self.time)
                if self.finished:
                    return

    def _note(self, solution: object, piece: Piece) -> None:
        """Samples of the steps just taken: outputs at four points a step, history at the grid's times."""
        nodes, dense = solution.t, solution.sol  # type: ignore[attr-defined]
        fine = np.interp(np.arange(4 * (nodes.size - 1) + 1) / 4.0, np.arange(nodes.size), nodes)
        for time, y in zip(fine.tolist(), dense(fine).T, strict=True):
            q, v = self.spread(y)
            works = 2 * self.half
            self.account.work = y[works : works + 2].tolist()
            reading = watch.read(self.equation, q.tolist(), v.tolist(), y[works + 2 :], *piece.at(time))
            self.account.sample(time, reading)
            self.most = max(self.most, self.account.kinetic)
            if self.account.kinetic >= CALM * self.most:
                self.calm_since = time
        stop = int(np.searchsorted(self.grid, nodes[-1], side="right"))
        if stop > self.written:
            y = dense(self.grid[self.written : stop])
            self.history[:4, self.written : stop] = self.free @ y[: self.half]
            self.history[4:, self.written : stop] = self.free @ y[self.half : 2 * self.half]
            self.written = stop

    def _at_rest(self) -> bool:
        return self.time - self.calm_since >= self.period or self.most == 0.0

    def result(self) -> Run:
        q, v = self.spread(self.y)
        self.history[:, self.written :] = np.concatenate([q, v])[:, None]
        if self.account.fallen:
            self.history[:4, self.written :] = np.clip(q, -math.pi / 2.0, math.pi / 2.0)[:, None]
            self.history[4:, self.written :] = 0.0
        elif not self.account.failed:
            self.account.close(self.time, watch.toppled(self.equation, q.tolist(), v.tolist()))
        return Run.of_one(self.account.outputs(q), self.history.T, *with_onset([tuple(self.account.events)]))
