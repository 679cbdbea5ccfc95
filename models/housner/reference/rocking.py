"""One run of the reference: phases between events, each integrated by scipy's DOP853 with dense output.

The equation of `models.housner.reference.equation` is integrated afresh on every stretch on which all laws are
smooth: between samples of the record, between impacts, turning points and kinks of a law. Events are
located on the dense output to rounding.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from models.base import STATUS, Event, FloatArray
from models.ground import PitchedPiece
from models.housner.declaration import REST_VELOCITY
from models.housner.reference.equation import MOST_INSET, Equation
from models.housner.reference.impact import restitution
from models.runs import Run

Named = list[tuple[str, Callable[[float, FloatArray], float], int]]
REST_SHARE = 1e-6
"""A flexible joint rests when a crossing leaves less than this share of the largest crossing's energy."""
STUCK = 2000
"""More stretches than this within one smooth piece of the ground's motion: not converged."""


class Rocking:
    """State of one run: ``mode`` is rest, up (rocking) or held (by friction at a turning point).

    ``extra`` holds the degrees of freedom that a subclass adds while the block rocks, with their
    absolute tolerances over rtol in ``extra_scale``.
    """

    extra: tuple[float, ...] = ()
    extra_scale: tuple[float, ...] = ()

    def __init__(self, equation: Equation, grid: FloatArray, rtol: float, follow: bool) -> None:
        self.equation, self.grid, self.rtol, self.follow = equation, grid, rtol, follow
        self.history = np.zeros((3, grid.size))
        self.written = 0
        eq = equation
        scale = eq.mass * float(eq.block.gravity[0]) * float(eq.block.radius[0]) * eq.alpha**2
        self.atol = rtol * np.array([eq.alpha, eq.frequency_parameter * eq.alpha, scale, *self.extra_scale])
        self.longest = 0.1 / eq.frequency_parameter
        self.events: list[Event] = []
        self.time = self.theta = self.rate = 0.0
        self.mode, self.side, self.released = "rest", 1, 0
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

    def advance(self, piece: PitchedPiece, shaken: bool) -> None:
        """Through one piece of the ground's motion; ``shaken`` is false after the record's end."""
        self.time = piece.start
        for _ in range(STUCK):
            if self.time >= piece.end or self.finished:
                return
            self._go(piece, shaken)
        self.failed = self.finished = True

    def _go(self, piece: PitchedPiece, shaken: bool) -> None:
        """On to the next event, in the present mode."""
        if self.mode == "rest":
            self._wait(piece, shaken)
        elif self.mode == "held":
            self._hold(piece, shaken)
        else:
            self._rock(piece, shaken)

    def _wait(self, piece: PitchedPiece, shaken: bool) -> None:
        def excess(time: float, side: int) -> float:
            return self.equation.excess(side, self.largest, piece.at(time))

        crossings = [(first_positive(excess, s, self.time, piece.end), s) for s in (1, -1)]
        time, side = min(crossings)
        self._write(min(time, piece.end), None)
        self.time = min(time, piece.end)
        if math.isinf(time):
            self.finished = not shaken
            return
        self._lift(side)

    def _lift(self, side: int) -> None:
        self.mode, self.side, self.arc = "up", side, 0.0
        self.onset = self.time if math.isnan(self.onset) else self.onset
        self.events.append(Event(self.time, "onset"))

    def _hold(self, piece: PitchedPiece, shaken: bool) -> None:
        def excess(time: float, direction: int) -> float:
            return self.equation.push(self.theta, direction, self.side, self.largest, piece.at(time))

        time, way = min((first_positive(excess, d, self.time, piece.end), d) for d in (1, -1))
        end = min(time, piece.end)
        self._write(end, None)
        self.uplift += end - self.time
        self.time = end
        if math.isinf(time):
            self.finished = not shaken
        else:
            self.mode, self.released = "up", way

    def _direction(self, piece: PitchedPiece) -> int:
        """Sign of the velocity, of the moment where there is none, 0 where friction holds the block."""
        released, self.released = self.released, 0
        if self.rate != 0.0:
            return 1 if self.rate > 0.0 else -1
        if self.theta == 0.0:
            return self.side
        ground = piece.at(self.time)
        ahead, back = (self.equation.push(self.theta, d, self.side, self.largest, ground) for d in (1, -1))
        if max(ahead, back) <= 0.0:
            # where friction has just let go the moment is its couple, to rounding
            return released
        return 1 if self._rates(self.time, self._state(), 1 if ahead > back else -1, piece)[1] > 0.0 else -1

    def _state(self) -> FloatArray:
        """theta (rad), theta' (rad s-1), energy lost since (J), and the extra degrees of freedom."""
        return np.array([self.theta, self.rate, 0.0, *self.extra])

    def _rates(self, time: float, y: FloatArray, direction: int, piece: PitchedPiece) -> tuple[float, ...]:
        """Time derivative of `_state` while the block rocks; ``direction`` is the sign of theta'."""
        theta, rate, _ = y.tolist()
        second, power = self.equation.acceleration(theta, rate, self.side, direction, self.largest, piece.at(time))
        return rate, second, power

    def _more_events(self, piece: PitchedPiece, direction: int) -> Named:
        """Events of the extra degrees of freedom, as (kind, function of time and state, sense)."""
        return []

    def _kinks(self, direction: int) -> list[float]:
        """Angles |theta| ahead at which a law has a kink."""
        eq = self.equation
        angles = [eq.gap] if eq.stiffness != 0.0 else []
        if eq.crushing > 0.0:
            angles += [self.largest, MOST_INSET / eq.crushing]
        now, outward = abs(self.theta), direction == self.side
        return [a for a in angles if (a > now + 1e-12 if outward else 1e-12 < a < now - 1e-12)]

    def _rock(self, piece: PitchedPiece, shaken: bool) -> None:
        eq, side = self.equation, self.side
        direction = self._direction(piece)
        if direction == 0:
            self.mode = "held"
            return

        def derivative(time: float, y: FloatArray) -> tuple[float, ...]:
            return self._rates(time, y, direction, piece)

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

        start = self._state()
        watch = not shaken and math.isnan(self.overturned)
        if watch and topple(self.time, start) >= 0.0:
            self._overturn()
            return
        named: Named = [
            ("impact", impact, -1),
            ("turn", turn, -1),
            ("fall", fall, 1),
        ]
        named += [("topple", topple, 1)] if watch else []
        named += [("kink", kink(a), 0) for a in self._kinks(direction)]
        named += self._more_events(piece, direction)
        hop = self._hop(lambda time: derivative(time, start)[1], piece.end, direction)
        solution, kind = self._solve(derivative, start, named, piece.end, hop)
        self._demand(solution, piece, direction)
        self.uplift += self.time - float(solution.t[0])
        self.theta, self.rate, lost, *extra = solution.y[:, -1].tolist()
        self.extra = tuple(extra)
        self.lost += lost
        self.arc = max(self.arc, abs(self.theta))
        self.largest = max(self.largest, self.arc)
        if kind is not None:
            self._happen(kind, piece)

    def _solve(
        self,
        derivative: Callable[[float, FloatArray], tuple[float, ...]],
        start: FloatArray,
        named: Named,
        end: float,
        first: float = math.inf,
        atol: FloatArray | None = None,
    ) -> tuple[Any, str | None]:
        """Integrate from ``start`` to ``end`` or the first event; moves the clock and writes the history."""
        for _, function, sense in named:
            function.terminal = True  # type: ignore[attr-defined]
            function.direction = sense  # type: ignore[attr-defined]
        solution = solve_ivp(
            derivative,
            (self.time, end),
            start,
            "DOP853",
            events=[function for _, function, _ in named],
            dense_output=True,
            rtol=self.rtol,
            atol=self.atol if atol is None else atol,
            max_step=self.longest,
            first_step=min(self.longest, end - self.time, first),
        )
        self._write(float(solution.t[-1]), solution.sol)
        self.time = float(solution.t[-1])
        if solution.status != 1:
            return solution, None
        return solution, next(n for (n, _, _), t in zip(named, solution.t_events or [], strict=True) if t.size)

    def _hop(self, second: Callable[[float], float], end: float, direction: int) -> float:
        """First step (s) short enough that a small hop off the ground, or between two stops, is not stepped over."""
        if self.theta != 0.0 and (self.rate != 0.0 or not self.equation.rubs):
            return math.inf
        way = direction if self.theta != 0.0 else self.side
        now, later = way * second(self.time), way * second(end)
        if now > 0.0 and later < 0.0:
            return (end - self.time) * now / (now - later)
        if min(now, later) < 0.0 and self.rate != 0.0:
            return abs(self.rate) / -min(now, later)
        return math.inf

    def _happen(self, kind: str, piece: PitchedPiece) -> None:
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

    def _ratio(self, old: float, new: float) -> float:
        """theta'_after / theta'_before of the law of restitution, for half widths ``old`` and ``new``."""
        ratio = restitution(
            self.equation.block,
            np.array([old]),
            np.array([new]),
            rate=np.array([self.rate]),
            previous_peak=np.array([self.arc]),
            largest_peak=np.array([self.largest]),
            impacts=np.array([self.earlier + self.impacts]),
        )
        return float(ratio[0])

    def _impact(self, piece: PitchedPiece) -> None:
        eq, before = self.equation, self.rate
        old, new = eq.half_width(self.side, self.largest), eq.half_width(-self.side, self.largest)
        after = self._ratio(old, new) * before
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

    def _demand(self, solution: Any, piece: PitchedPiece, direction: int) -> None:
        """Largest friction demand over eight points of every step just taken."""
        nodes = solution.t
        fine = np.interp(np.linspace(0, nodes.size - 1, 8 * (nodes.size - 1) + 1), np.arange(nodes.size), nodes)
        for time, y in zip(fine.tolist(), solution.sol(fine).T, strict=True):
            self.friction = max(self.friction, self._needed(time, y, piece, direction))

    def _needed(self, time: float, y: FloatArray, piece: PitchedPiece, direction: int) -> float:
        theta, rate = y[:2].tolist()
        second = self._rates(time, y, direction, piece)[1]
        return self.equation.friction_demand(theta, rate, second, self.side, self.largest, piece.at(time))

    def _shift(self, y: FloatArray) -> FloatArray:
        """Displacement of the mass centre beyond that of rocking on fixed corners, of states (k, n)."""
        return np.zeros(y.shape[1])

    def _write(self, end: float, dense: Callable[[FloatArray], FloatArray] | None) -> None:
        """History at the grid's times up to ``end`` (s); without ``dense`` the state stays."""
        stop = int(np.searchsorted(self.grid, end, side="right"))
        fresh = slice(self.written, stop)
        if stop > self.written:
            y = self._state()[:, None] if dense is None else dense(self.grid[fresh])
            self.history[:2, fresh] = y[:2]
            self.history[2, fresh] = self._shift(y)
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
            "friction_demand": self.friction,
            "status": float(STATUS.index(status)),
            "swing_peak": self.arc,
        }

    def result(self) -> Run:
        """Outputs; theta, theta' and the mass centre's displacement beyond rocking on corners that stay; events."""
        outputs = self.frozen or self._outputs()
        end = math.copysign(math.pi / 2.0, self.theta) if outputs["overturned"] else self.theta
        self.history[:2, self.written :] = [[end], [0.0]]
        self.history[2, self.written :] = self._shift(self._state()[:, None])
        return Run.of_one(outputs, self.history.T, self.events)


def first_positive(function: Callable[[float, int], float], side: int, start: float, end: float) -> float:
    """First time in [start, end) at which ``function`` is positive, inf when it is not (monotone)."""
    if function(start, side) > 0.0:
        return start
    if not function(end, side) > 0.0:
        return math.inf
    root = float(brentq(function, start, end, args=(side,), xtol=1e-14 * max(1.0, end)))
    return root if end - root > 1e-9 * (end - start) else math.inf
