"""The slow plain route of two stacked blocks: scipy's DOP853 with dense events, one lane at a time.

The equations of `models.stacked.equation` are integrated afresh on every stretch on which the ground's
motion is linear and the configuration stays. Events are located on the dense output to rounding.
The compiled lanes are held against this route.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from models.base import Event, FloatArray
from models.shaking import Shaking
from models.stacked import account as acc
from models.stacked.choice import choose
from models.stacked.configuration import index
from models.stacked.declaration import MOST_EVENTS_PER_STEP, REST_VELOCITY
from models.stacked.equation import System, held, motion, reactions, vectors
from models.stacked.ground import Piece, pieces
from models.stacked.impact import BASE, TOP, closed, impact, kinetic_energy
from models.stacked.overturning import margins
from models.stacked.stack import Stack

JOINTS = (BASE, TOP)
HALF_TURN = math.pi / 2.0


@dataclass(frozen=True)
class ReferenceResult:
    """A line of `models.stacked.account`; theta_1, r, theta_1', r' at the samples ``(4, n)``; events."""

    account: FloatArray
    history: FloatArray
    events: tuple[Event, ...]


def run(
    stack: Stack,
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
    """One wall (a `Stack` of one lane) under ``scale`` times the shaking.

    ``tail``: free motion after the record, at most, in s; ``duration`` replaces record plus tail.
    ``initial``: theta_1, r (rad), theta_1', r' (rad s-1) by the names q1, q2, w1, w2; default at rest.
    ``follow``: go on to pi/2 after overturning is certain; the account counts to overturning all the
    same. ``rtol`` is that of DOP853; the absolute tolerance is rtol times alpha, p alpha, M g h alpha^2.
    """
    if stack.size != 1:
        raise ValueError(f"the reference runs one wall at a time, {stack.size} were given")
    until = shaking.duration + tail if duration is None else duration
    grid = shaking.time_step * np.arange(math.floor(until / shaking.time_step + 1e-9) + 1, dtype=np.float64)
    wall = _Run(stack, linear, grid, rtol, follow)
    before: tuple[float, float] | None = None
    for piece in pieces(stack.one(), shaking, scale, until):
        if before is None:
            wall.begin(dict(initial or {}), piece)
        elif before != piece.first and any(wall.sides):
            wall.time = piece.start
            wall.settle(piece)
            wall.visit()
        wall.advance(piece, shaken=piece.start < shaking.duration)
        before = piece.at(piece.end)
        if wall.finished:
            break
    return wall.result()


class _Run:
    """State of one run: the configuration, theta_1 and r with their rates, and the account."""

    def __init__(self, stack: Stack, linear: bool, grid: FloatArray, rtol: float, follow: bool) -> None:
        self.stack, self.linear, self.grid, self.rtol, self.follow = stack.one(), linear, grid, rtol, follow
        p, p2 = float(stack.frequency_parameter[0]), float(stack.frequency_parameter_2[0])
        alpha, alpha_2 = float(stack.slenderness[0]), float(stack.slenderness_2[0])
        self.calm = (REST_VELOCITY * p * alpha, REST_VELOCITY * p2 * alpha_2)
        self.most = 0.1 / max(p, p2)
        work = float((stack.mass * stack.gravity * stack.centre)[0]) * alpha**2
        self.atol = rtol * np.array([alpha, alpha_2, p * alpha, p2 * alpha_2, work])
        self.history = np.zeros((4, grid.size))
        self.written = 0
        self.events: list[Event] = []
        self.time = 0.0
        self.q, self.rate = [0.0, 0.0], [0.0, 0.0]
        self.sides, self.before = [0, 0], [0, 0]
        self.account = acc.blank(1)[0]
        self.finished = False
        self.frozen: FloatArray | None = None

    # --- equations in the present configuration

    def system(self, sides: tuple[int, int], y: Any, ground: tuple[float, float]) -> System:
        return motion(self.stack, *sides, (y[0], y[1]), (y[2], y[3]), ground, self.linear)

    def state(self) -> list[float]:
        return [*self.q, *self.rate]

    def pull(self, joint: int, side: int, y: Any, ground: tuple[float, float]) -> float:
        """Moment (N m) by which a closed joint would open about the corner ``side``; <= 0: it stays."""
        s1, s2 = self.sides
        corners = (side, s2 or 1) if joint == BASE else (s1 or 1, side)
        m = self.system(corners, y, ground)
        x1, x2 = held(m, s1, s2)
        return side * float(m.r1 - m.m12 * x2 if joint == BASE else m.r2 - m.m12 * x1)

    # --- configurations

    def begin(self, initial: Mapping[str, float], piece: Piece) -> None:
        self.q = [initial.get("q1", 0.0), initial.get("q2", 0.0)]
        self.rate = [initial.get("w1", 0.0), initial.get("w2", 0.0)]
        for joint in JOINTS:
            first = self.q[joint] or self.rate[joint]
            self.sides[joint] = (first > 0.0) - (first < 0.0)
        self.note_peaks([self.state()])
        self.before = list(self.sides)
        self.settle(piece)
        self.visit()

    def settle(self, piece: Piece, *, moving: bool = False, ahead: float = 0.0) -> None:
        """What the closed joints do under the forces of now (``ahead`` s later, at a threshold)."""
        if all(self.sides):
            return
        ground, y = piece.at(self.time + ahead), self.state()
        self.sides = list(choose(lambda c1, c2: self.system((c1, c2), y, ground), *self.sides, moving=moving))

    def visit(self) -> None:
        """The configuration begins: mark it, and the first uplift of each joint."""
        self.account[acc.VISITED] = int(self.account[acc.VISITED]) | 1 << index(*self.sides)
        for joint, column in zip(JOINTS, (acc.ONSET_BASE, acc.ONSET_TOP), strict=True):
            if self.sides[joint] and not self.before[joint] and math.isnan(self.account[column]):
                self.account[column] = self.time
        self.before = list(self.sides)

    def advance(self, piece: Piece, shaken: bool) -> None:
        self.time = piece.start
        for _ in range(MOST_EVENTS_PER_STEP * 10):
            if self.time >= piece.end or self.finished:
                return
            if any(self.sides):
                self._move(piece, shaken)
            else:
                self._wait(piece, shaken)
        self.account[acc.FAILED] = 1.0
        self.finished = True

    def _wait(self, piece: Piece, shaken: bool) -> None:
        """At rest the pulls are linear in time."""
        first = math.inf
        for joint in JOINTS:
            for side in (1, -1):
                now = self.pull(joint, side, self.state(), piece.at(self.time))
                then = self.pull(joint, side, self.state(), piece.at(piece.end))
                if now > 0.0:
                    first = self.time
                elif then > 0.0:
                    first = min(first, self.time + (piece.end - self.time) * now / (now - then))
        self._write(min(first, piece.end), None)
        self._spend(min(first, piece.end))
        if math.isinf(first):
            self.finished = not shaken
            return
        self.settle(piece, moving=True, ahead=1e-9 * (piece.end - piece.start))
        self.visit()
        self.events.append(Event(self.time, "onset", 1 if self.sides[BASE] else 2))

    def _move(self, piece: Piece, shaken: bool) -> None:
        s1, s2 = self.sides
        corners = (s1 or 1, s2 or 1)

        def derivative(time: float, y: FloatArray) -> list[float]:
            z = y.tolist()
            x1, x2 = held(self.system(corners, z, piece.at(time)), s1, s2)
            drag = self.stack.viscous * float(self.stack.corner_inertia(corners[0])) * z[2] ** 2
            return [z[2], z[3], x1, x2, drag]

        watch = None if shaken or self.frozen is not None else piece
        named = self._watched(piece, watch)
        start = np.array([*self.state(), 0.0])
        if watch and max(margins(self.stack, s1, s2, tuple(self.q), tuple(self.rate), piece.at(self.time))) > 0.0:
            self._overturn(piece)
            return
        for _, function, sense, terminal in named:
            function.terminal = terminal  # type: ignore[attr-defined]
            function.direction = sense  # type: ignore[attr-defined]
        solution = solve_ivp(
            derivative,
            (self.time, piece.end),
            start,
            "DOP853",
            events=[function for _, function, _, _ in named],
            dense_output=True,
            rtol=self.rtol,
            atol=self.atol,
            max_step=self.most,
            first_step=min(self.most, piece.end - self.time, self._hop(derivative(self.time, start))),
        )
        end = float(solution.t[-1])
        turned = [y for (kind, *_), ys in zip(named, solution.y_events, strict=True) if kind == "turn" for y in ys]
        self.q, self.rate = solution.y[:2, -1].tolist(), solution.y[2:4, -1].tolist()
        self.note_peaks([*turned, self.state()])
        self.account[acc.LOST_BASE] += float(solution.y[4, -1])
        self._demand(solution, piece, derivative)
        self._write(end, solution.sol)
        self._spend(end)
        if solution.status == 1:
            kind = next(
                k for (k, _, _, stops), t in zip(named, solution.t_events, strict=True) if stops and t.size
            )
            self._happen(kind, piece)

    def _watched(
        self, piece: Piece, watch: Piece | None
    ) -> list[tuple[str, Callable[[float, FloatArray], float], int, bool]]:
        """Name, function, direction of crossing and whether it ends the stretch, of every event."""
        found: list[tuple[str, Callable[[float, FloatArray], float], int, bool]] = []
        for joint, name in zip(JOINTS, ("base", "top"), strict=True):
            side = self.sides[joint]
            if side:
                found.append((f"impact {name}", lambda t, y, j=joint, s=side: s * float(y[j]), -1, True))
                continue
            for corner in (1, -1):
                found.append((
                    f"lift {name} {corner}",
                    lambda t, y, j=joint, c=corner: self.pull(j, c, y.tolist(), piece.at(t)), 1, True,
                ))  # fmt: skip
        found.append(("turn", lambda t, y: float(y[2]), 0, False))
        found.append(("turn", lambda t, y: float(y[2] + y[3]), 0, False))
        found.append(("fall", lambda t, y: max(abs(float(y[0])), abs(float(y[0] + y[1]))) - HALF_TURN, 1, True))
        if watch:
            found.append((
                "topple",
                lambda t, y: max(margins(
                    self.stack, *self.sides, (float(y[0]), float(y[1])), (float(y[2]), float(y[3])), watch.at(t)
                )), 1, True,
            ))  # fmt: skip
        return found

    def _hop(self, slope: list[float]) -> float:
        """First step (s) short enough that a small hop off a joint is not stepped over."""
        hops = [math.inf]
        for joint, side in enumerate(self.sides):
            if side and self.q[joint] == 0.0 and side * slope[2 + joint] < 0.0 and self.rate[joint] != 0.0:
                hops.append(abs(self.rate[joint] / slope[2 + joint]))
        return min(hops)

    def _happen(self, kind: str, piece: Piece) -> None:
        what, *where = kind.split()
        if what in ("fall", "topple"):
            if self.frozen is None:
                self._overturn(piece)
            self.finished = self.finished or what == "fall"
            return
        joint = BASE if where[0] == "base" else TOP
        if what == "impact":
            self._impact(joint, piece)
        else:
            self.sides[joint] = int(where[1])
            self.events.append(Event(self.time, "change_of_pattern", joint + 1))
        self.visit()

    def _impact(self, joint: int, piece: Piece) -> None:
        self.q[joint] = 0.0
        s1, s2 = self.sides
        at: tuple[Any, ...] = (self.stack, joint, s1, s2, tuple(self.q), tuple(self.rate), self.linear)
        before = kinetic_energy(self.stack, s1, s2, *at[4:])
        landing = impact(*at)
        self.account[(acc.IMPACTS_BASE, acc.IMPACTS_TOP)[joint]] += 1
        self.events.append(Event(self.time, "impact", joint + 1))
        self._take(landing)
        calm = [abs(landing[2 + j]) < self.calm[j] for j in JOINTS]
        if self.q == [0.0, 0.0] and all(calm) and self._stays(list(JOINTS), (0, 0, 0.0, 0.0), piece):
            pass
        elif not (landing[joint] and calm[joint] and self._stays([joint], closed(*at), piece)):
            self._take(landing)
        self.settle(piece)
        after = kinetic_energy(self.stack, *self.sides, tuple(self.q), tuple(self.rate), self.linear)
        self.account[(acc.LOST_BASE, acc.LOST_TOP)[joint]] += before - after
        if not any(self.sides):
            self.events.append(Event(self.time, "rest"))

    def _stays(self, joints: list[int], landing: tuple[int, int, float, float], piece: Piece) -> bool:
        """Whether ``joints`` remain closed under the forces of now when they close for good."""
        self._take(landing)
        self.settle(piece)
        return not any(self.sides[j] for j in joints)

    def _take(self, landing: tuple[int, int, float, float]) -> None:
        self.sides, self.rate = list(landing[:2]), list(landing[2:])

    def _overturn(self, piece: Piece) -> None:
        theta = [self.q[0], self.q[0] + self.q[1]]
        over = [abs(t) >= HALF_TURN - 1e-9 for t in theta]
        if not any(over):
            over = [m > -1e-9 for m in margins(self.stack, *self.sides, tuple(self.q), tuple(self.rate), piece.at(self.time))]
        body = 1 if over[0] else 2
        self.account[acc.OVERTURNED_2] = self.time
        if body == 1:
            self.account[acc.OVERTURNED_1] = self.time
        self.events.append(Event(self.time, "overturned", body))
        self.frozen = self._closed_account()
        self.finished = not self.follow

    # --- the account

    def note_peaks(self, states: list[Any]) -> None:
        for y in states:
            self.account[acc.PEAK_1] = max(self.account[acc.PEAK_1], abs(float(y[0])))
            self.account[acc.PEAK_2] = max(self.account[acc.PEAK_2], abs(float(y[0] + y[1])))

    def _spend(self, end: float) -> None:
        self.account[acc.TIME_IN + index(*self.sides)] += end - self.time
        self.time = end

    def _demand(self, solution: Any, piece: Piece, derivative: Callable[..., list[float]]) -> None:
        """Largest friction demand over eight points of every step just taken."""
        nodes = solution.t
        places = np.linspace(0, nodes.size - 1, 8 * (nodes.size - 1) + 1)
        fine = np.interp(places, np.arange(nodes.size), nodes)
        y = solution.sol(fine)
        second = np.array([derivative(t, y[:, k])[2:4] for k, t in enumerate(fine.tolist())]).T
        a, gravity = np.array([piece.at(t) for t in fine.tolist()]).T
        s1, s2 = self.sides
        v = vectors(self.stack, s1 or 1, s2 or 1, (y[0], y[1]), self.linear)
        base_h, base_n, top_h, top_n = reactions(self.stack, v, (y[2], y[3]), (second[0], second[1]), (a, gravity))
        for column, h, n in ((acc.FRICTION_BASE, base_h, base_n), (acc.FRICTION_TOP, top_h, top_n)):
            demand = np.where(n > 0.0, np.abs(h) / np.where(n > 0.0, n, 1.0), acc.BOUNDLESS)
            self.account[column] = max(self.account[column], float(np.max(demand)))

    def _write(self, end: float, dense: Callable[[FloatArray], FloatArray] | None) -> None:
        """History at the grid's times up to ``end`` (s); without ``dense`` the state stays."""
        stop = int(np.searchsorted(self.grid, end, side="right"))
        if stop > self.written:
            fresh = slice(self.written, stop)
            self.history[:, fresh] = dense(self.grid[fresh])[:4] if dense else np.array([self.state()]).T
            self.written = stop

    def _closed_account(self) -> FloatArray:
        line = self.account.copy()
        line[acc.END_1], line[acc.END_2] = self.q[0], self.q[0] + self.q[1]
        return line

    def result(self) -> ReferenceResult:
        if self.frozen is None and self.time < self.grid[-1]:
            self._spend(float(self.grid[-1]))
        account = self._closed_account() if self.frozen is None else self.frozen
        self.history[:, self.written :] = np.array([[*self.q, 0.0, 0.0]]).T
        return ReferenceResult(account, self.history, tuple(self.events))
