"""The slow plain route of the block: scipy's DOP853 with dense events, one lane at a time.

The equation of `models.housner.equation` is integrated afresh on every stretch on which all laws are
smooth: between samples of the record, between impacts, turning points and kinks of a law. Events are
located on the dense output to rounding. Everything else (kernels) is held against this route.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from models.base import Event, FloatArray
from models.housner.block import Block
from models.housner.declaration import REST_VELOCITY, STATUS
from models.housner.equation import MOST_INSET, Equation
from models.housner.ground import Piece, pieces
from models.housner.impact import restitution
from models.shaking import Shaking

REST_SHARE = 1e-6
"""A flexible joint rests when a crossing leaves less than this share of the largest crossing's energy."""
STUCK = 2000
"""More stretches than this within one smooth piece of the ground's motion: not converged."""


@dataclass(frozen=True)
class ReferenceResult:
    """Outputs by name (see ``OUTPUTS``), and the history at the shaking's time step: rad, rad s-1, s."""

    outputs: dict[str, float]
    time: FloatArray
    rotation: FloatArray
    rate: FloatArray
    events: tuple[Event, ...]


def run(
    block: Block,
    shaking: Shaking,
    scale: float = 1.0,
    *,
    tail: float = 10.0,
    linear: bool = False,
    initial: Mapping[str, float] | None = None,
    duration: float | None = None,
    follow: bool = False,
    rtol: float = 1e-10,
) -> ReferenceResult:
    """One block (a `Block` of one lane) under ``scale`` times the shaking.

    ``tail``: free motion after the record, at most, in s; ``duration`` replaces record plus tail.
    ``initial``: ``rotation_1`` (rad), ``rotation_rate_1`` (rad s-1), default at rest; and for laws with
    a memory ``peak_rotation_1`` (rad) and ``impacts`` before the run, default none.
    ``follow``: the history of a block that has overturned goes on to pi/2; outputs count to
    overturning all the same. ``rtol`` is that of DOP853, the absolute tolerance is rtol times
    (alpha, p alpha, M g R alpha^2).
    """
    until = shaking.duration + tail if duration is None else duration
    grid = shaking.time_step * np.arange(round(until / shaking.time_step) + 1, dtype=np.float64)
    body = _Run(Equation(block, linear), grid, rtol, follow)
    start = dict(initial or {})
    body.begin(start.get("rotation_1", 0.0), start.get("rotation_rate_1", 0.0))
    body.largest = max(body.largest, start.get("peak_rotation_1", 0.0))
    body.earlier = start.get("impacts", 0.0)
    for piece in pieces(block, shaking, scale, until):
        body.advance(piece, shaken=piece.start < shaking.duration)
        if body.finished:
            break
    return body.result()


class _Run:
    """State of one run: ``mode`` is rest, up (rocking) or held (by friction at a turning point)."""

    def __init__(self, equation: Equation, grid: FloatArray, rtol: float, follow: bool) -> None:
        self.equation, self.grid, self.rtol, self.follow = equation, grid, rtol, follow
        self.history = np.zeros((2, grid.size))
        self.written = 0
        eq = equation
        scale = eq.mass * float(eq.block.gravity[0]) * float(eq.block.radius[0]) * eq.alpha**2
        self.atol = rtol * np.array([eq.alpha, eq.frequency_parameter * eq.alpha, scale])
        self.events: list[Event] = []
        self.time = self.theta = self.rate = 0.0
        self.mode, self.side = "rest", 1
        self.largest = self.arc = self.crossing = self.lost = self.uplift = self.friction = 0.0
        self.impacts, self.earlier, self.onset, self.overturned = 0, 0.0, math.nan, math.nan
        self.failed = self.finished = False
        self.frozen: dict[str, float] | None = None

    def begin(self, theta: float, rate: float) -> None:
        self.theta, self.rate = theta, rate
        if theta != 0.0 or rate != 0.0:
            self.mode = "up"
            self.side = int(math.copysign(1.0, theta if theta != 0.0 else rate))
            self.largest = self.arc = abs(theta)

    def advance(self, piece: Piece, shaken: bool) -> None:
        """Through one piece of the ground's motion; ``shaken`` is false after the record's end."""
        self.time = piece.start
        for _ in range(STUCK):
            if self.time >= piece.end or self.finished:
                return
            if self.mode == "rest":
                self._wait(piece, shaken)
            elif self.mode == "held":
                self._hold(piece, shaken)
            else:
                self._rock(piece, shaken)
        self.failed = self.finished = True

    def _wait(self, piece: Piece, shaken: bool) -> None:
        def excess(time: float, side: int) -> float:
            return self.equation.excess(side, self.largest, piece.at(time))

        crossings = [(_first_positive(excess, s, self.time, piece.end), s) for s in (1, -1)]
        time, side = min(crossings)
        self._write(min(time, piece.end), None)
        self.time = min(time, piece.end)
        if math.isinf(time):
            self.finished = not shaken
            return
        self.mode, self.side, self.arc = "up", side, 0.0
        self.onset = time if math.isnan(self.onset) else self.onset
        self.events.append(Event(time, "onset"))

    def _hold(self, piece: Piece, shaken: bool) -> None:
        eq = self.equation

        def excess(time: float, direction: int) -> float:
            moment, _ = eq.moment(self.theta, 0.0, self.side, self.largest, piece.at(time))
            return direction * moment - eq.coulomb

        time = min(_first_positive(excess, d, self.time, piece.end) for d in (1, -1))
        end = min(time, piece.end)
        self._write(end, None)
        self.uplift += end - self.time
        self.time = end
        if math.isinf(time):
            self.finished = not shaken
        else:
            self.mode = "up"

    def _direction(self, piece: Piece) -> int:
        """Sign of the velocity, of the moment where there is none, 0 where friction holds the block."""
        if self.rate != 0.0:
            return 1 if self.rate > 0.0 else -1
        moment, _ = self.equation.moment(self.theta, 0.0, self.side, self.largest, piece.at(self.time))
        if self.theta == 0.0:
            return self.side
        if abs(moment) <= self.equation.coulomb:
            return 0
        return 1 if moment > 0.0 else -1

    def _kinks(self, direction: int) -> list[float]:
        """Angles |theta| ahead at which a law has a kink."""
        eq = self.equation
        angles = [eq.gap] if eq.stiffness != 0.0 else []
        if eq.crushing > 0.0:
            angles += [self.largest, MOST_INSET / eq.crushing]
        now, outward = abs(self.theta), direction == self.side
        return [a for a in angles if (a > now + 1e-12 if outward else 1e-12 < a < now - 1e-12)]

    def _rock(self, piece: Piece, shaken: bool) -> None:
        eq, side, largest = self.equation, self.side, self.largest
        direction = self._direction(piece)
        if direction == 0:
            self.mode = "held"
            return

        def derivative(time: float, y: FloatArray) -> tuple[float, float, float]:
            theta, rate, _ = y.tolist()
            second, power = eq.acceleration(theta, rate, side, direction, largest, piece.at(time))
            return rate, second, power

        def impact(time: float, y: FloatArray) -> float:
            return side * float(y[0])

        def turn(time: float, y: FloatArray) -> float:
            return direction * float(y[1])

        def fall(time: float, y: FloatArray) -> float:
            return side * float(y[0]) - math.pi / 2.0

        def topple(time: float, y: FloatArray) -> float:
            second = derivative(time, y)[1]
            return min(side * float(y[0]) - eq.alpha, side * float(y[1]), side * second)

        def kink(angle: float) -> Callable[[float, FloatArray], float]:
            return lambda time, y: side * float(y[0]) - angle

        start = np.array([self.theta, self.rate, 0.0])
        watch = not shaken and math.isnan(self.overturned)
        if watch and topple(self.time, start) >= 0.0:
            self._overturn()
            return
        named: list[tuple[str, Callable[[float, FloatArray], float], int]] = [
            ("impact", impact, -1),
            ("turn", turn, -1),
            ("fall", fall, 1),
        ]
        named += [("topple", topple, 1)] if watch else []
        named += [("kink", kink(a), 0) for a in self._kinks(direction)]
        for _, function, sense in named:
            function.terminal = True  # type: ignore[attr-defined]
            function.direction = sense  # type: ignore[attr-defined]
        most = 0.1 / eq.frequency_parameter
        solution = solve_ivp(
            derivative,
            (self.time, piece.end),
            start,
            "DOP853",
            events=[function for _, function, _ in named],
            dense_output=True,
            rtol=self.rtol,
            atol=self.atol,
            max_step=most,
            first_step=min(most, piece.end - self.time, self._hop(lambda time: derivative(time, start)[1], piece.end)),
        )
        end = float(solution.t[-1])
        self._write(end, solution.sol)
        self._demand(solution, piece, direction)
        self.uplift += end - self.time
        self.time, self.theta, self.rate = end, float(solution.y[0, -1]), float(solution.y[1, -1])
        self.lost += float(solution.y[2, -1])
        self.arc = max(self.arc, abs(self.theta))
        self.largest = max(self.largest, self.arc)
        if solution.status == 1:
            kind = next(n for (n, _, _), t in zip(named, solution.t_events or [], strict=True) if t.size)
            self._happen(kind, piece)

    def _hop(self, second: Callable[[float], float], end: float) -> float:
        """First step (s) short enough that a small hop off the ground is not stepped over."""
        if self.theta != 0.0:
            return math.inf
        now, later = self.side * second(self.time), self.side * second(end)
        if now > 0.0 and later < 0.0:
            return (end - self.time) * now / (now - later)
        if min(now, later) < 0.0 and self.rate != 0.0:
            return abs(self.rate) / -min(now, later)
        return math.inf

    def _happen(self, kind: str, piece: Piece) -> None:
        if kind == "turn":
            self.rate = 0.0
        elif kind == "impact":
            self._impact(piece)
        elif kind in ("fall", "topple"):
            self._overturn()
            self.finished = self.finished or kind == "fall"

    def _overturn(self) -> None:
        self.overturned = self.time
        self.events.append(Event(self.time, "overturned"))
        self.frozen = self._outputs()
        self.finished = not self.follow

    def _impact(self, piece: Piece) -> None:
        eq, block, before = self.equation, self.equation.block, self.rate
        old, new = eq.half_width(self.side, self.largest), eq.half_width(-self.side, self.largest)
        ratio = restitution(
            block,
            np.array([old]),
            np.array([new]),
            rate=np.array([before]),
            previous_peak=np.array([self.arc]),
            largest_peak=np.array([self.largest]),
            impacts=np.array([self.earlier + self.impacts]),
        )
        after = float(ratio[0]) * before
        inertia_old = eq.base_inertia + eq.mass * old**2
        inertia_new = eq.base_inertia + eq.mass * new**2
        self.lost += 0.5 * (inertia_old * before**2 - inertia_new * after**2)
        self.impacts += 1
        self.crossing = max(self.crossing, 0.5 * inertia_old * before**2)
        self.theta, self.rate, self.side, self.arc = 0.0, after, -self.side, 0.0
        self.events.append(Event(self.time, "impact"))
        left = 0.5 * inertia_new * after**2
        if eq.joint > 0.0:
            calm = left < REST_SHARE * self.crossing
        else:
            calm = abs(after) < REST_VELOCITY * eq.frequency_parameter * eq.alpha
        ground = piece.at(self.time)
        stays = all(eq.excess(s, self.largest, ground) <= 0.0 for s in (1, -1))
        if after == 0.0 or (calm and stays):
            self.lost += left
            self.rate, self.mode = 0.0, "rest"
            self.events.append(Event(self.time, "rest"))

    def _demand(self, solution: object, piece: Piece, direction: int) -> None:
        """Largest friction demand over eight points of every step just taken."""
        eq = self.equation
        nodes = solution.t  # type: ignore[attr-defined]
        fine = np.interp(np.linspace(0, nodes.size - 1, 8 * (nodes.size - 1) + 1), np.arange(nodes.size), nodes)
        for time, (theta, rate, _) in zip(fine.tolist(), solution.sol(fine).T.tolist(), strict=True):  # type: ignore[attr-defined]
            ground = piece.at(time)
            second, _ = eq.acceleration(theta, rate, self.side, direction, self.largest, ground)
            self.friction = max(self.friction, eq.friction_demand(theta, rate, second, self.side, self.largest, ground))

    def _write(self, end: float, dense: Callable[[FloatArray], FloatArray] | None) -> None:
        """History at the grid's times up to ``end`` (s); without ``dense`` the state stays."""
        stop = int(np.searchsorted(self.grid, end, side="right"))
        fresh = slice(self.written, stop)
        if stop > self.written:
            if dense is None:
                self.history[:, fresh] = [[self.theta], [self.rate]]
            else:
                self.history[:, fresh] = dense(self.grid[fresh])[:2]
            self.written = stop

    def _outputs(self) -> dict[str, float]:
        over, eq = not math.isnan(self.overturned), self.equation
        peak = math.pi / 2.0 if over else self.largest
        rocked = self.largest > 0.0 or not math.isnan(self.onset)
        status = "not_converged" if self.failed else "overturned" if over else "rocking" if rocked else "rest"
        return {
            "peak_rotation": peak,
            "peak_rotation_ratio": peak / eq.alpha,
            "uplift_duration": self.uplift,
            "onset_time": self.onset,
            "overturned": float(over),
            "overturning_time": self.overturned,
            "impacts": float(self.impacts),
            "residual_rotation": math.copysign(math.pi / 2.0, self.theta) if over else self.theta,
            "dissipated_energy": self.lost,
            "needed_friction": self.friction,
            "status": float(STATUS.index(status)),
        }

    def result(self) -> ReferenceResult:
        outputs = self.frozen or self._outputs()
        end = math.copysign(math.pi / 2.0, self.theta) if outputs["overturned"] else self.theta
        self.history[:, self.written :] = [[end], [0.0]]
        return ReferenceResult(outputs, self.grid, self.history[0], self.history[1], tuple(self.events))


def _first_positive(function: Callable[[float, int], float], side: int, start: float, end: float) -> float:
    """First time in [start, end) at which ``function`` is positive, inf when it is not (monotone)."""
    if function(start, side) > 0.0:
        return start
    if not function(end, side) > 0.0:
        return math.inf
    root = float(brentq(function, start, end, args=(side,), xtol=1e-14 * max(1.0, end)))
    return root if end - root > 1e-9 * (end - start) else math.inf
