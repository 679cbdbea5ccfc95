"""The plain, slow route: scipy's DOP853 in each configuration, its dense events at the switches.

The rules of the switches are those of `models.interface_linear.equation`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, fminbound

from models.base import STATUS, FloatArray
from models.ground import Piece, pieces
from models.interface.declaration import CALM, STATES
from models.interface.layered import LayeredWall
from models.interface.observe import with_onset
from models.interface.reference.account import Account
from models.interface_linear import equation
from models.interface_linear.declaration import BRIEF
from models.interface_linear.lanes.run import fastest_rate
from models.interface_linear.reference.plain import Equation, Joint
from models.runs import Request, Run

TOUCH = 1e-12
"""A watched value (over its size at rest) counts as positive above this."""


def run(wall: LayeredWall, request: Request, rtol: float = 1e-10, brief: float = BRIEF) -> Run:
    """One wall (a `LayeredWall` of one lane) as requested, from the start of the shaking. Samples: q, q'."""
    body = _Run(wall, request.times, rtol, brief, may_rest=not request.history)
    rest = dict(zip(STATES, [*equation.rest(wall)[0], 0.0, 0.0, 0.0, 0.0], strict=True))
    body.begin(np.array([request.start.get(name, rest[name]) for name in STATES]))
    for piece in pieces(wall, request.shaking, float(request.scale[0]), request.until):
        body.advance(piece, shaken=piece.start < request.shaking.duration)
        if body.finished:
            break
    return body.result()


class _Run:
    """State of one run: y = (q, q', works of both layers)."""

    def __init__(self, wall: LayeredWall, grid: FloatArray, rtol: float, brief: float, *, may_rest: bool) -> None:
        self.equation = Equation(wall)
        self.grid, self.rtol, self.may_rest = grid, rtol, may_rest
        self.brief = brief / float(fastest_rate(wall)[0])
        self.history = np.zeros((8, grid.size))
        self.written, self.finished = 0, False
        self.time, self.calm_since, self.most = 0.0, math.nan, 0.0
        self.y, self.joints = np.zeros(10), (Joint(), Joint())
        fastest = math.sqrt(abs(float(equation.at_rest(wall).squares[0, 0])))
        sizes = np.array([float(wall.slenderness[0]), float(wall.slenderness_2[0]), *self.equation.compression])
        weight = float(wall.mass[0] * wall.gravity[0] * wall.base_half_width[0] * wall.slenderness[0])
        self.atol = rtol * np.concatenate([sizes, sizes * fastest, (weight, weight)])
        self.period = 2.0 * math.pi / fastest
        self.account = Account(self.equation.wall)

    def begin(self, state: FloatArray) -> None:
        self.y = np.concatenate([state, (0.0, 0.0)])
        for joint in self.equation.laid:
            turn = state[1] - state[0] if joint else state[0]
            if state[2 + joint] + self.equation.width[joint] * abs(turn) > 0.0:
                self._set(joint, Joint(1 if turn >= 0.0 else -1))

    def _set(self, joint: int, state: Joint) -> None:
        self.joints = (state, self.joints[1]) if joint == 0 else (self.joints[0], state)

    def advance(self, piece: Piece, shaken: bool) -> None:
        """Through one straight piece of the ground's motion; ``shaken`` is false after the record's end."""
        self.time = piece.start
        ends = [piece.end] if shaken else [*np.arange(piece.start + self.period, piece.end, self.period), piece.end]
        for end in ends:
            while self.time < end and not self.finished:
                self._run_until(end, piece)
            if not shaken and not self.finished and (self.time - self.calm_since >= self.period or self.most == 0.0):
                self.finished = self.may_rest
                self.account.rest(self.time)
            if self.finished:
                return

    def _run_until(self, end: float, piece: Piece) -> None:
        """To ``end``, or to the next switch before it."""
        joints, solved = self.joints, self.equation

        def derivative(time: float, y: FloatArray) -> FloatArray:
            q, v, ground = y[:4], y[4:8], piece.at(time)
            second, mu = solved.motion(joints, q, v, ground)
            return np.concatenate([v, second, solved.power(joints, q, v, mu)])

        def watch(joint: int, which: int) -> Callable[[float, FloatArray], float]:
            def value(time: float, y: FloatArray) -> float:
                return solved.watched(joints, joint, y[:4], y[4:8], piece.at(time))[which] - TOUCH

            value.terminal, value.direction = True, 1.0  # type: ignore[attr-defined]
            return value

        def fall(_: float, y: FloatArray) -> float:
            return float(np.max(np.abs(y[:2])) - math.pi / 2.0)

        fall.terminal = True  # type: ignore[attr-defined]
        for joint in solved.laid:
            now = solved.watched(joints, joint, self.y[:4], self.y[4:8], piece.at(self.time))
            if max(now) > TOUCH:
                self._switch(joint, now[1] > TOUCH, piece)
                return
        watches = [(joint, which) for joint in solved.laid for which in (0, 1)]
        solution = solve_ivp(
            derivative, (self.time, end), self.y, "DOP853", dense_output=True, rtol=self.rtol, atol=self.atol,
            events=[*(watch(*each) for each in watches), fall],
        )  # fmt: skip
        if not solution.success:
            self.account.failed = self.finished = True
            return
        dense: Any = solution.sol
        if (missed := self._missed(solution.t, dense, [watch(*each) for each in watches])) is not None:
            at, number = missed
            self._note(np.append(solution.t[solution.t < at], at), dense, piece)
            self.time, self.y = at, np.asarray(dense(at))
            self._switch(watches[number][0], watches[number][1] == 1, piece)
            return
        self._note(solution.t, dense, piece)
        self.time, self.y = float(solution.t[-1]), solution.y[:, -1]
        if solution.status == 1 and solution.t_events is not None:
            if solution.t_events[-1].size:
                self.account.fall(self.time, self.y[:2])
                self.finished = True
                return
            joint, which = next(each for each, times in zip(watches, solution.t_events[:-1], strict=True) if times.size)
            self._switch(joint, which == 1, piece)

    def _missed(
        self, nodes: FloatArray, dense: Any, watched: Sequence[Callable[[float, FloatArray], float]]
    ) -> tuple[float, int] | None:
        """Time and number of the first switch that came and went within a step, which its ends do not show."""
        times, found = _between(nodes, 4), []
        states = dense(times).T
        for number, watch in enumerate(watched):
            here = np.array([watch(t, y) for t, y in zip(times, states, strict=True)])
            left, middle, right = here[:-2], here[1:-1], here[2:]
            bend, slope = left - 2.0 * middle + right, 0.5 * (right - left)
            with np.errstate(divide="ignore", invalid="ignore"):
                top = middle - 0.5 * slope**2 / bend  # of the parabola through the three
            reached = top > bend  # within its error of zero
            hidden = (middle >= left) & (middle >= right) & (middle < 0.0) & (bend < 0.0) & reached
            for k in np.flatnonzero((left < 0.0) & ((middle > 0.0) | hidden)) + 1:

                def below(t: float, watch: Callable[[float, FloatArray], float] = watch) -> float:
                    return -watch(t, dense(t))

                highest = float(times[k])
                if here[k] < 0.0:
                    highest = float(fminbound(below, times[k - 1], times[k + 1], xtol=1e-12))
                if below(highest) < 0.0:
                    found.append((float(brentq(below, times[k - 1], highest, xtol=1e-15)), number))
                    break
        return min(found, default=None)

    def _switch(self, joint: int, second: bool, piece: Piece) -> None:
        """A joint changes its state, its watched value (the second one or the first) having become positive."""
        state, ground = self.joints[joint], piece.at(self.time)
        if state.held:
            self._settle(joint)
            self._set(joint, Joint(state.side) if second else Joint())
        elif second and state.side:
            self._set(joint, Joint(-state.side))
        else:
            side = state.side or (-1 if second else 1)
            q, v, opening = self.y[:4], self.y[4:8], []
            for trial in (Joint(), Joint(side)):
                self._set(joint, trial)
                opening.append(
                    float(self.equation.gap(joint, side) @ self.equation.motion(self.joints, q, v, ground)[0])
                )
            rate = abs(float(self.equation.gap(joint, side) @ v))
            after = abs(opening[1] if state.side == 0 else opening[0])
            if opening[0] > 0.0 > opening[1] and 2.0 * rate <= self.brief * after:
                self._set(joint, Joint(side, held=True))
                self._settle(joint)
            else:
                self._set(joint, Joint(side) if state.side == 0 else Joint())
        self.account.sample(self.time, self.equation.read(self.joints, self.y[:4], self.y[4:8], ground))

    def _settle(self, joint: int) -> None:
        """Put the state on h = h' = 0 of a joint that is held, by an impulse of mu d."""
        side, solved = self.joints[joint].side, self.equation
        turn = self.y[1] - self.y[0] if joint else self.y[0]
        self.y[2 + joint] = -side * solved.width[joint] * turn
        held = [k for k in solved.laid if self.joints[k].held]
        normal = np.array([solved.gap(k, self.joints[k].side) for k in held])
        push = np.array([equation.jump(solved.lanes, k, self.joints[k].side)[0] for k in held]).T
        free = solved.free
        moved = free @ np.linalg.solve(free.T @ solved.matrices(self.joints)[0] @ free, free.T @ push)
        self.y[4:8] -= moved @ np.linalg.solve(normal @ moved, normal @ self.y[4:8])

    def _note(self, nodes: FloatArray, dense: Any, piece: Piece) -> None:
        """Samples between ``nodes`` by their interpolant: outputs four a step, history at the grid's times."""
        fine = _between(nodes, 4)
        for time, y in zip(fine.tolist(), dense(fine).T, strict=True):
            reading = self.equation.read(self.joints, y[:4], y[4:8], piece.at(time))
            self.account.work = y[8:].tolist()
            self.account.sample(time, reading)
            self.most = max(self.most, self.account.kinetic)
            if self.account.kinetic >= CALM * self.most:
                self.calm_since = time
        stop = int(np.searchsorted(self.grid, nodes[-1], side="right"))
        if stop > self.written:
            self.history[:, self.written : stop] = dense(self.grid[self.written : stop])[:8]
            self.written = stop

    def result(self) -> Run:
        self.history[:, self.written :] = self.y[:8, None]
        if self.account.fallen:
            self.history[:4, self.written :] = np.clip(self.y[:4], -math.pi / 2.0, math.pi / 2.0)[:, None]
            self.history[4:, self.written :] = 0.0
        elif not self.account.failed:
            self.account.close(self.time, self.equation.toppled(self.y[:4], self.y[4:8]))
        outputs = self.account.outputs(self.y[:4])
        if outputs["minimum_contact"] == 0.0 and not self.account.failed:
            outputs["status"] = float(STATUS.index("outside_model"))
        return Run.of_one(outputs, self.history.T, *with_onset([tuple(self.account.events)]))


def _between(nodes: FloatArray, points: int) -> FloatArray:
    """Times at so many ``points`` of every step between ``nodes``."""
    return np.interp(np.arange(points * (nodes.size - 1) + 1) / points, np.arange(nodes.size), nodes)
