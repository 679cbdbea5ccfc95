"""The plain, slow and exact route: scipy's DOP853 over every straight piece of the ground's motion."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
from scipy.integrate import solve_ivp

from models.base import FloatArray
from models.ground import PitchedPiece, pitched_pieces
from models.interface import modes, resting
from models.interface.chain import SIZE
from models.interface.declaration import CALM, STATES
from models.interface.effects import BENDS
from models.interface.effects import STATES as MORE
from models.interface.layered import LayeredWall
from models.interface.observe import with_onset
from models.interface.reference import watch
from models.interface.reference.account import Account
from models.interface.reference.effects import EffectsEquation
from models.interface.reference.equation import Equation, Switch
from models.runs import Request, Run

BEYOND = 100.0
"""Size (m or rad) of a coordinate that only a trial step of the solver can have."""


def run(wall: LayeredWall, request: Request, rtol: float = 1e-10) -> Run:
    """One wall (a `LayeredWall` of one lane) as requested, from the start of the shaking. Samples: q, q'."""
    body = _Run(wall, request.times, rtol, may_rest=not request.history)
    body.begin(request.start)
    e = wall.effects
    pitching = (0.0, math.inf) if e is None else (float(e.pitch[0]), float(e.pitch_low_pass[0]))
    for piece in pitched_pieces(wall, request.shaking, float(request.scale[0]), request.until, *pitching):
        body.advance(piece, shaken=piece.start < request.shaking.duration)
        if body.finished:
            break
    return body.result()


class _Run:
    """State of one run: y = (p, p', works of both strips, hidden states), p the free coordinates."""

    def __init__(self, wall: LayeredWall, grid: FloatArray, rtol: float, *, may_rest: bool) -> None:
        self.equation = Equation(wall) if wall.effects is None else EffectsEquation(wall)
        self.size = self.equation.size
        self.free = self.equation.free
        self.half = self.free.shape[1]
        self.grid, self.rtol, self.may_rest = grid, rtol, may_rest
        self.history = np.zeros((2 * self.size, grid.size))
        self.written, self.finished = 0, False
        self.time, self.calm_since, self.most = 0.0, math.nan, 0.0
        self.y = np.zeros(2 * self.half + 2)
        self.pick = [int(np.flatnonzero(column)[0 if self.size == SIZE else -1]) for column in self.free.T]
        lean, lean_2 = float(wall.slenderness[0]), float(wall.slenderness_2[0])
        scale = np.abs(resting.upright(wall)[0, 2:])
        free_sizes = np.array([lean, lean_2, *scale, max(scale), max(scale), lean, max(scale)])[self.pick]
        fastest = math.sqrt(abs(float(modes.at_rest(wall).squares[0, 0])))
        weight = float(wall.mass[0] * wall.gravity[0] * wall.base_half_width[0] * wall.slenderness[0])
        hidden = np.full(self.equation.hidden, float(np.max(scale)))
        self.atol = rtol * np.concatenate([free_sizes, free_sizes * fastest, (weight, weight), hidden])
        self.period = 2.0 * math.pi / fastest
        self.account = Account(self.equation.wall)

    def begin(self, start: Mapping[str, float]) -> None:
        """From the state ``start`` by name; what is left out is as at rest."""
        names, rest = STATES + MORE, np.zeros(2 * SIZE)
        at_rest = self.equation.rest[0]
        rest[:4], rest[8 : 4 + at_rest.size] = at_rest[:4], at_rest[4:]
        rest[names.index("bend")] -= rest[0]
        state = np.array([start.get(name, value) for name, value in zip(names, rest.tolist(), strict=True)])
        for name, lower in BENDS.items():
            state[names.index(name)] += state[names.index(lower)]
        q, v = np.append(state[:4], state[8:12])[: self.size], np.append(state[4:8], state[12:])[: self.size]
        hidden = self.equation.begun(q.tolist(), v.tolist(), start)
        self.y = np.concatenate([q[self.pick], v[self.pick], (0.0, 0.0), hidden])

    def spread(self, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """q and q' of the free coordinates."""
        return self.free @ y[: self.half], self.free @ y[self.half : 2 * self.half]

    def advance(self, piece: PitchedPiece, shaken: bool) -> None:
        """Through one straight piece of the ground's motion; ``shaken`` is false after the record's end."""
        self.time = piece.start
        change, works = np.empty(self.y.size), 2 * self.half

        def derivative(time: float, y: FloatArray) -> FloatArray:
            if not np.max(np.abs(y[: self.half])) < BEYOND:
                return np.full(y.size, np.nan)  # the solver takes a shorter step
            q, v = (part.tolist() for part in self.spread(y))
            ground = piece.at(time)
            base, top, rates = self.equation.strips(q, v, y[works + 2 :])
            change[: self.half] = y[self.half : works]
            change[self.half : works] = self.equation.accelerated(q, v, ground, (base, top))[self.pick]
            change[works : works + 2] = self.equation.power((base, top), q, v, ground)
            change[works + 2 :] = rates
            return change.copy()

        def fall(time: float, y: FloatArray) -> float:
            q, _ = self.spread(y)
            return float(np.max(np.abs(q[:2])) - math.pi / 2.0)

        def watched(switch: Switch) -> Callable[[float, FloatArray], float]:
            def value(time: float, y: FloatArray) -> float:
                q, v = (part.tolist() for part in self.spread(y))
                return switch.value(q, v, y[works + 2 :], piece.at(time))

            value.terminal, value.direction = True, -1.0  # type: ignore[attr-defined]
            return value

        q, v = (part.tolist() for part in self.spread(self.y))
        self.equation.let_go(q, v, self.y[works + 2 :], piece.at(piece.start))
        fall.terminal = True  # type: ignore[attr-defined]
        # without shaking, look at the motion now and then: it may have come to rest
        ends = [piece.end] if shaken else [*np.arange(piece.start + self.period, piece.end, self.period), piece.end]
        for end in ends:
            while self.time < end:
                switches = self.equation.switches()
                solution = solve_ivp(
                    derivative, (self.time, end), self.y, "DOP853", events=[fall, *map(watched, switches)],
                    dense_output=True, rtol=self.rtol, atol=self.atol,
                )  # fmt: skip
                if not solution.success or solution.t_events is None:
                    self.account.failed, self.finished = True, True
                    return
                self._note(solution, piece)
                self.time, self.y = float(solution.t[-1]), solution.y[:, -1]
                if solution.t_events[0].size:
                    q, _ = self.spread(self.y)
                    self.account.fall(self.time, q)
                    self.finished = True
                    return
                for switch, times in zip(switches, solution.t_events[1:], strict=True):
                    if times.size:
                        q, v = (part.tolist() for part in self.spread(self.y))
                        self.equation.switched(switch.name, q, v, self.y[works + 2 :], piece.at(self.time))
            if not shaken and self._at_rest():
                self.finished = self.may_rest
                self.account.rest(self.time)
                if self.finished:
                    return

    def _note(self, solution: object, piece: PitchedPiece) -> None:
        """Samples of the steps just taken: outputs at four points a step, history at the grid's times."""
        nodes, dense = solution.t, solution.sol  # type: ignore[attr-defined]
        fine = np.interp(np.arange(4 * (nodes.size - 1) + 1) / 4.0, np.arange(nodes.size), nodes)
        for time, y in zip(fine.tolist(), dense(fine).T, strict=True):
            q, v = self.spread(y)
            works = 2 * self.half
            self.account.work = y[works : works + 2].tolist()
            reading = watch.read(self.equation, q.tolist(), v.tolist(), y[works + 2 :], piece.at(time))
            self.account.sample(time, reading)
            self.most = max(self.most, self.account.kinetic)
            if self.account.kinetic >= CALM * self.most:
                self.calm_since = time
        stop = int(np.searchsorted(self.grid, nodes[-1], side="right"))
        if stop > self.written:
            y = dense(self.grid[self.written : stop])
            self.history[:, self.written : stop] = self._ordered(
                self.free @ y[: self.half], self.free @ y[self.half : 2 * self.half]
            )
            self.written = stop

    @staticmethod
    def _ordered(q: FloatArray, v: FloatArray) -> FloatArray:
        """q and q' in the order of a sample: those of the plain wall first."""
        return np.concatenate([q[:4], v[:4], q[4:], v[4:]])

    def _at_rest(self) -> bool:
        return self.time - self.calm_since >= self.period or self.most == 0.0

    def result(self) -> Run:
        q, v = self.spread(self.y)
        self.history[:, self.written :] = self._ordered(q, v)[:, None]
        if self.account.fallen:
            self.history[:4, self.written :] = np.clip(q[:4], -math.pi / 2.0, math.pi / 2.0)[:, None]
            self.history[4:8, self.written :] = 0.0
        elif not self.account.failed:
            self.account.close(self.time, watch.toppled(self.equation, q.tolist(), v.tolist()))
        return Run.of_one(self.account.outputs(q), self.history.T, *with_onset([tuple(self.account.events)]))
