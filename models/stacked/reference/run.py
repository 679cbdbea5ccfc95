"""The slow plain route of two stacked blocks: scipy's DOP853 with dense events, one lane at a time.

The equations of `models.stacked.equation` are integrated afresh on every stretch on which the ground's
motion is linear and the configuration stays. Events are located on the dense output to rounding.
The compiled lanes are held against this route.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
from scipy.integrate import solve_ivp

from models.base import Event, FloatArray
from models.ground import PitchedPiece, pitched_pieces
from models.runs import Request, Run
from models.stacked import account as acc
from models.stacked.configuration import BASE, JOINTS, TOP, State
from models.stacked.declaration import MOST_EVENTS_PER_STEP
from models.stacked.equation import Ground, held
from models.stacked.observe import initial_state, settled_history
from models.stacked.reference.joints import Joints
from models.stacked.reference.ledger import Ledger
from models.stacked.reference.overturning import margins
from models.stacked.stack import Stack

HALF_TURN = math.pi / 2.0
Watch = tuple[str, Callable[[float, FloatArray], float], int, bool]
"""Name, function, direction of crossing and whether it ends the stretch."""


def run(stack: Stack, request: Request, rtol: float = 1e-10) -> Run:
    """One wall (a `Stack` of one lane) as requested.

    Samples: theta_1, r (rad) and their rates (rad s-1). A history goes on to pi/2 after overturning is certain; the
    account counts to overturning all the same. ``rtol`` is that of DOP853; the absolute tolerance is rtol times
    alpha, p alpha, M g h alpha^2.
    """
    if stack.size != 1:
        raise ValueError(f"the reference runs one wall at a time, {stack.size} were given")
    wall = _Run(stack, request.linear, request.times, rtol, request.history)
    start = {name: float(values[0]) for name, values in initial_state(request.initial, 1).items()}
    before: Ground | None = None
    pitching = float(stack.pitch_per_acceleration[0]), float(stack.pitch_low_pass[0])
    for piece in pitched_pieces(stack, request.shaking, float(request.scale[0]), request.until, *pitching):
        now = piece.at(piece.start)
        if before is None:
            wall.begin(start, now)
        elif before != now and any(wall.joints.state.sides):
            wall.joints.settle(now, piece.start)
        wall.advance(piece, shaken=piece.start < request.shaking.duration)
        before = piece.at(piece.end)
        if wall.finished:
            break
    account = wall.closed()[None]
    samples = settled_history(wall.ledger.history.T[None], account)
    return Run(acc.outputs(stack, account), samples, (tuple(wall.ledger.events),))


class _Run:
    """One run over time: stretches of one configuration, and what ends them."""

    def __init__(self, stack: Stack, linear: bool, grid: FloatArray, rtol: float, follow: bool) -> None:
        self.stack, self.linear, self.grid, self.rtol, self.follow = stack.one(), linear, grid, rtol, follow
        self.ledger = Ledger(grid)
        self.joints = Joints(stack, linear, self.ledger)
        p, p2 = float(stack.frequency_parameter[0]), float(stack.frequency_parameter_2[0])
        alpha, alpha_2 = float(stack.slenderness[0]), float(stack.slenderness_2[0])
        self.most = 0.1 / max(p, p2)
        work = float((stack.mass * stack.gravity * stack.centre)[0]) * alpha**2
        self.atol = rtol * np.array([alpha, alpha_2, p * alpha, p2 * alpha_2, work])
        self.time = 0.0
        self.finished = False

    def begin(self, initial: Mapping[str, float], ground: Ground) -> None:
        q1, q2, w1, w2 = (float(initial.get(name, 0.0)) for name in ("q1", "q2", "w1", "w2"))
        q, rate = (q1, q2), (w1, w2)
        self.joints.state = State((_sign(q1 or w1), _sign(q2 or w2)), q, rate)
        self.ledger.peaks([(*q, *rate)])
        self.ledger.mark_configuration(self.joints.state.sides)
        if any(self.joints.state.sides):
            self.joints.settle(ground, 0.0)

    def advance(self, piece: PitchedPiece, shaken: bool) -> None:
        self.time = piece.start
        for _ in range(MOST_EVENTS_PER_STEP * 10):
            if self.time >= piece.end or self.finished:
                return
            if any(self.joints.state.sides):
                self._move(piece, shaken)
            else:
                self._wait(piece, shaken)
        self.ledger.account[acc.FAILED] = 1.0
        self.finished = True

    def _wait(self, piece: PitchedPiece, shaken: bool) -> None:
        """At rest the moments that open the joints are linear in time, but for a pitch beside a vertical motion."""
        first, still = math.inf, self.joints.state
        for joint in JOINTS:
            for side in (1, -1):
                now = self.joints.pull(joint, side, still, piece.at(self.time))
                then = self.joints.pull(joint, side, still, piece.at(piece.end))
                if now > 0.0:
                    first = self.time
                elif then > 0.0:
                    first = min(first, self.time + (piece.end - self.time) * now / (now - then))
        end = min(first, piece.end)
        self.ledger.write(end, None)
        self.ledger.add_time(still.sides, end - self.time)
        self.time = end
        if math.isinf(first):
            self.finished = not shaken
            return
        self.joints.settle(piece.at(end + 1e-9 * (piece.end - piece.start)), end, moving=True)
        self.ledger.events.append(Event(end, "onset", 1 if self.joints.state.sides[BASE] else 2))

    def _move(self, piece: PitchedPiece, shaken: bool) -> None:
        state, joints = self.joints.state, self.joints
        drag = float(self.stack.viscous) * float(self.stack.corner_inertia(state.corners[0]))
        dry = float(self.stack.coulomb) * state.way

        def derivative(time: float, y: FloatArray) -> list[float]:
            q1, q2, v1, v2, _ = y.tolist()
            now = state._replace(q=(q1, q2), rate=(v1, v2))
            system = joints.system(state.corners, now, piece.at(time), state.way)
            return [v1, v2, *held(system, *state.free), (drag * v1 + dry) * v1]

        falls = not shaken and self.ledger.frozen is None
        if falls and max(margins(self.stack, state, piece.at(self.time)[:2])) > 0.0:
            self._overturn(piece)
            return
        watched = self._watched(piece, state, falls)
        for _, function, sense, terminal in watched:
            function.terminal = terminal  # type: ignore[attr-defined]
            function.direction = sense  # type: ignore[attr-defined]
        start = np.array([*state.q, *state.rate, 0.0])
        back = math.inf
        if dry and state.sides[BASE]:
            now, later = (state.way * derivative(time, start)[2] for time in (self.time, piece.end))
            back = _stop(abs(state.rate[BASE]), now, later, piece.end - self.time)
        solution = solve_ivp(
            derivative,
            (self.time, piece.end),
            start,
            "DOP853",
            events=[function for _, function, _, _ in watched],
            dense_output=True,
            rtol=self.rtol,
            atol=self.atol,
            max_step=self.most,
            first_step=min(self.most, piece.end - self.time, _hop(state, derivative(self.time, start)), back),
        )
        end, last = float(solution.t[-1]), solution.y[:, -1].tolist()
        assert solution.sol is not None and solution.t_events is not None and solution.y_events is not None
        turned = [y for (kind, *_), ys in zip(watched, solution.y_events, strict=True) if kind == "turn" for y in ys]
        self.ledger.peaks([*turned, last])
        self.ledger.account[acc.LOST_BASE] += last[4]
        self.ledger.demand(self.stack, state, solution, derivative, piece, self.linear)
        self.ledger.write(end, solution.sol)
        self.ledger.add_time(state.sides, end - self.time)
        self.time = end
        joints.state = state._replace(q=(last[0], last[1]), rate=(last[2], last[3]))
        if solution.status == 1:
            kinds = zip(watched, solution.t_events, strict=True)
            self._happen(next(kind for (kind, _, _, ends), t in kinds if ends and t.size), piece)

    def _watched(self, piece: PitchedPiece, state: State, falls: bool) -> list[Watch]:
        """What may end this stretch, and the turning points."""

        def at(y: FloatArray) -> State:
            q1, q2, v1, v2, _ = y.tolist()
            return state._replace(q=(q1, q2), rate=(v1, v2))

        def opening(joint: int, side: int) -> Callable[[float, FloatArray], float]:
            return lambda time, y: side * float(y[joint])

        def pull(joint: int, corner: int) -> Callable[[float, FloatArray], float]:
            return lambda time, y: self.joints.pull(joint, corner, at(y), piece.at(time))

        found: list[Watch] = [
            ("turn", lambda time, y: float(y[2]), 0, False),
            ("turn", lambda time, y: float(y[2] + y[3]), 0, False),
            ("fall", lambda time, y: max(map(abs, at(y).theta)) - HALF_TURN, 1, True),
        ]
        for joint, name in zip(JOINTS, ("base", "top"), strict=True):
            side = state.free[joint]
            if side:
                found.append((f"impact {name}", opening(joint, side), -1, True))
            else:
                found += [(f"open {name} {c}", pull(joint, c), 1, True) for c in (1, -1)]
        if state.free[BASE] and float(self.stack.coulomb) > 0.0:
            found.append(("stop", lambda time, y: state.way * float(y[2]), -1, True))
        if falls:
            found.append(("fall", lambda time, y: max(margins(self.stack, at(y), piece.at(time)[:2])), 1, True))
        return found

    def _happen(self, kind: str, piece: PitchedPiece) -> None:
        what, *where = kind.split()
        if what == "fall":
            if self.ledger.frozen is None:
                self._overturn(piece)
            else:
                self.finished = True
            return
        if what == "stop":
            self.joints.stop(piece.at(self.time), self.time)
            return
        joint = BASE if where[0] == "base" else TOP
        if what == "impact":
            self.joints.land(joint, piece.at(self.time), self.time)
        else:
            self.joints.open(joint, int(where[1]), self.time)

    def _overturn(self, piece: PitchedPiece) -> None:
        state = self.joints.state
        flat = [abs(theta) >= HALF_TURN - 1e-9 for theta in state.theta]
        beyond = [margin > -1e-9 for margin in margins(self.stack, state, piece.at(self.time)[:2])]
        body = 1 if (flat if any(flat) else beyond)[0] else 2
        self.ledger.overturn(body, self.time, state)
        self.finished = any(flat) or not self.follow

    def closed(self) -> FloatArray:
        """The account at the end of the run."""
        state = self.joints.state
        if self.ledger.frozen is None and self.time < self.grid[-1]:
            self.ledger.add_time(state.sides, float(self.grid[-1]) - self.time)
        return self.ledger.closed(state)


def _sign(number: float) -> int:
    return (number > 0.0) - (number < 0.0)


def _stop(rate: float, now: float, later: float, time: float) -> float:
    """First step (s) short enough that a wall which soon stops and comes back is not stepped over.

    ``rate`` and its derivatives at the start of the stretch and ``time`` later are along the wall's direction.
    """
    if rate == 0.0:
        return time * now / (now - later) if now > 0.0 > later else math.inf
    return -rate / now if now < 0.0 else math.inf


def _hop(state: State, slope: list[float]) -> float:
    """First step (s) short enough that a small hop off a joint is not stepped over."""
    hops = [math.inf]
    for joint, side in enumerate(state.sides):
        rate, second = state.rate[joint], slope[2 + joint]
        if side and state.q[joint] == 0.0 and rate != 0.0 and side * second < 0.0:
            hops.append(abs(rate / second))
    return min(hops)
