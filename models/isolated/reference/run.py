"""The plain, slow and exact route: scipy's DOP853 over every straight piece of the ground's motion.

Where Payne's amplitude or the count of cycles changes, the integration stops and starts again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

from models.base import Event, FloatArray
from models.isolated import bearing
from models.isolated.account import energy, status
from models.isolated.chain import Chain
from models.isolated.declaration import CALM, MOST_LEVELS, STATES
from models.isolated.modes import modes, tridiagonal
from models.runs import Request, Run
from models.shaking import Shaking


def run(chain: Chain, request: Request, rtol: float = 1e-10) -> Run:
    """One building (a `Chain` of one lane) as requested, from the start of the shaking; samples as of the lanes."""
    shaking, until = request.shaking, request.until
    body = _Run(chain, shaking, float(request.scale[0]), until, request.start, rtol)
    step, count = shaking.time_step, shaking.horizontal.size
    knots = step * np.concatenate([[0], np.flatnonzero(np.diff(shaking.horizontal, n=2)) + 1, [count - 1]])
    for start, end in pairwise(
        knots[knots <= until].tolist() if knots[-1] <= until else [*knots[knots < until], until]
    ):
        body.through(start, end)
    body.quiet = True
    start = shaking.duration
    while start < until - 1e-12 and not (body.at_rest() and not request.history):
        end = min(start + body.period, until)
        body.through(start, end)
        start = end
    return body.result()


class _Run:
    """State of one run: y = (x, x', work of the shaking, hidden states of the laws)."""

    def __init__(
        self, chain: Chain, shaking: Shaking, scale: float, until: float, initial: Mapping[str, float], rtol: float
    ) -> None:
        self.chain, self.shaking, self.scale, self.rtol = chain, shaking, scale, rtol
        self.n = n = int(chain.levels[0])
        self.mass = chain.masses[0, :n]
        self.stiffness = tridiagonal(n, chain.stiffness, chain.storey_stiffness)[0]
        self.damping = tridiagonal(n, chain.damping, chain.storey_damping)[0]
        u, rate = (float(initial.get(name, 0.0)) for name in STATES)
        at_rest = bearing.relaxed(chain, np.array([u]))
        hidden = [float(h[0]) for h in at_rest.hidden]
        self.amplitude, self.crossings = float(at_rest.amplitude[0]), 0
        self.y = np.array([*[u] * n, *[rate] * n, 0.0, *hidden])
        self.side, self.way = np.sign(u), np.sign(rate)
        omega = modes(chain, n)[0][0]
        self.period = 2.0 * math.pi / float(omega[0])
        # sizes of the motion: of a static push by the peak, or the given state
        push = abs(scale) * shaking.pga / float(omega[0]) ** 2 + abs(u) + abs(rate) / float(omega[0])
        reach = max(push, 1e-9)
        work = float(self.mass.sum()) * (reach * float(omega[0])) ** 2
        fast = reach * float(omega[0])
        self.atol = rtol * np.array([*[reach] * n, *[fast] * n, work, *[reach] * len(hidden)])
        self.grid = shaking.time_step * np.arange(round(until / shaking.time_step) + 1)
        self.samples = np.zeros((self.grid.size, 2 * MOST_LEVELS + 1))
        self.written, self.time, self.quiet = 0, 0.0, False
        self.peaks, self.most, self.calm_since, self.rest_time = np.zeros(3), 0.0, 0.0, math.nan
        self.first = float(energy(chain, n, self.y[None, : 2 * n], at_rest)[0])

    def memory(self, hidden: FloatArray) -> bearing.Memory:
        """Of the hidden states alone, or of many along the last axis."""
        known = np.array([self.amplitude]), np.array([float(self.crossings)])
        return bearing.Memory(tuple(np.atleast_1d(h) for h in hidden), *known)

    def beyond(self, y: FloatArray) -> float:
        """What the bearings' force has beyond the linear one, in N."""
        u = y[:1]
        return float(
            bearing.spring_force(self.chain, u, self.memory(y[2 * self.n + 1 :]))[0] - self.chain.stiffness[0] * y[0]
        )

    def second(self, y: FloatArray, a: float) -> FloatArray:
        """Accelerations of the levels against the base."""
        n = self.n
        force = self.stiffness @ y[:n] + self.damping @ y[n : 2 * n]
        force[0] += self.beyond(y)
        return np.asarray(-a - force / self.mass)

    def ground(self, time: float) -> float:
        """Base acceleration; after the shaking there is none."""
        if self.quiet:
            return 0.0
        step, samples = self.shaking.time_step, self.shaking.horizontal
        k = min(int(time / step), samples.size - 2)
        return self.scale * float(samples[k] + (time / step - k) * (samples[k + 1] - samples[k]))

    def through(self, start: float, end: float) -> None:
        """One straight piece of the ground's motion."""
        n, chain = self.n, self.chain
        a0, a1 = self.ground(start), self.ground(end)

        def derivative(time: float, y: FloatArray) -> FloatArray:
            a = a0 + (a1 - a0) * (time - start) / (end - start)
            hidden = [np.atleast_1d(h) for h in y[2 * n + 1 :]]
            rates = [float(v[0]) for v in chain.layer.rates(y[:1], y[n : n + 1], hidden)]
            power = -a * float(self.mass @ y[n : 2 * n])
            return np.concatenate([y[n : 2 * n], self.second(y, a), [power], rates])

        # of what is zero, the sign is that of its rate
        self.way = self.way or np.sign(self.second(self.y, a0)[0] or a0 - a1)
        self.side = self.side or self.way
        self.time = start
        while self.time < end:
            solution = solve_ivp(
                derivative, (self.time, end), self.y, "DOP853", events=self._switches(), dense_output=True,
                rtol=self.rtol, atol=self.atol,
            )  # fmt: skip
            self._note(solution)
            self.time, self.y = float(solution.t[-1]), solution.y[:, -1].copy()
            reversal, crossing = (times.size > 0 for times in solution.t_events or ())
            if reversal:
                self.amplitude = abs(float(self.y[0]))
            if crossing:
                self.crossings += 1
            a = a0 + (a1 - a0) * (self.time - start) / (end - start)
            # at a switch the sign is that of the motion to come
            self.way = np.sign(self.second(self.y, a)[0] if reversal else self.y[n])
            self.side = np.sign(self.y[n] if crossing else self.y[0])

    def _switches(self) -> list[Callable[[float, FloatArray], float]]:
        """u' = 0 where Payne's law acts and u = 0 where the rubber wears, each from its present side."""
        wanted = (
            self.way * (self.chain.numbers("payne") is not None),
            self.side * (self.chain.numbers("degradation") is not None),
        )
        rows: tuple[int, int] = (self.n, 0)
        found: list[Callable[[float, FloatArray], float]] = []
        for row, side in zip(rows, wanted, strict=True):

            def switch(time: float, y: FloatArray, row: int = row, off: bool = side == 0.0) -> float:
                return 1.0 if off else float(y[row])

            switch.terminal, switch.direction = True, -side  # type: ignore[attr-defined]
            found.append(switch)
        return found

    def _note(self, solution: object) -> None:
        """Peaks at four points a step, and the samples of the grid."""
        nodes, dense = solution.t, solution.sol  # type: ignore[attr-defined]
        fine = np.interp(np.arange(4 * (nodes.size - 1) + 1) / 4.0, np.arange(nodes.size), nodes)
        n = self.n
        for time, y in zip(fine.tolist(), dense(fine).T, strict=True):
            acceleration = self.second(y, 0.0)
            drift = np.max(np.abs(np.diff(y[:n])), initial=0.0)
            self.peaks = np.maximum(self.peaks, [abs(y[0]), np.max(np.abs(acceleration)), drift])
            kinetic = float(self.mass @ y[n : 2 * n] ** 2)
            self.most = max(self.most, kinetic)
            if kinetic > CALM * self.most:
                self.calm_since = time
        stop = int(np.searchsorted(self.grid, nodes[-1] + 1e-12, side="right"))
        for k in range(self.written, stop):
            y = dense(min(self.grid[k], nodes[-1]))
            force = float(self.chain.stiffness[0] * y[0] + self.chain.damping[0] * y[n])
            self.samples[k, :n], self.samples[k, MOST_LEVELS : MOST_LEVELS + n] = y[:n], y[n : 2 * n]
            self.samples[k, -1] = force + self.beyond(y)
        self.written = max(self.written, stop)

    def at_rest(self) -> bool:
        """Whether the kinetic energy has been small for one period."""
        still = (
            self.time - max(self.calm_since, self.shaking.duration) >= self.period * (1.0 - 1e-9) or self.most == 0.0
        )
        if still and math.isnan(self.rest_time):
            self.rest_time = self.time
        return still

    def result(self) -> Run:
        n = self.n
        self.samples[self.written :] = self.samples[max(self.written - 1, 0)]
        left = float(energy(self.chain, n, self.y[None, : 2 * n], self.memory(self.y[2 * n + 1 :]))[0])
        names = ("peak_bearing_displacement", "peak_level_acceleration", "peak_drift")
        outputs = dict(zip(names, self.peaks.tolist(), strict=True))
        outputs["residual_displacement"] = float(self.y[0])
        outputs["dissipated_energy"] = self.first + float(self.y[2 * n]) - left
        outputs["status"] = float(status(np.array(False), np.array(self.peaks[0] > 0.0)))
        events = () if math.isnan(self.rest_time) else (Event(self.rest_time, "rest"),)
        return Run.of_one(outputs, self.samples, events)
