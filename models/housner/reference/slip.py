"""Reference of a block that slides: the contact's slip u is a degree of freedom beside theta.

With E = a - G psi + h psi'' and the arms X, Z, J of `models.housner.reference.equation`, at each instant four linear
equations for theta'', u'', H and N:

    J theta'' + M X u'' = moments                            M (u'' + X theta'' + Z theta'^2 + E) = H
    M (G + Z theta'' + (rho - X) theta'^2) = N               u'' = 0, or H = -mu N sign(u') while it slips

The corner sticks until |H| > mu N. In full contact the block slides when |E| > mu G.
Impact (assumption): tangential and normal impulse obey Coulomb's law too. The new corner sticks when
that takes a tangential impulse within mu times the normal one, else it slips with mu times that; the law of
restitution enters as an impulsive couple J (e - e_H) theta'. Without slip before the impact it takes
mu > (h/b) (1 - e)/(1 + e), about .75 b/h, to stick: less than rocking takes to start.
Where the equations of slip lose their solution (Painleve) the corner jams: it sticks.
Slip under g/p^2 times the rate of rest ends in an impact that leaves the block slower than that rate.
"""

from __future__ import annotations

import math

import numpy as np

from models.base import Event, FloatArray
from models.ground import PitchedPiece
from models.housner.declaration import REST_VELOCITY
from models.housner.reference.equation import Equation
from models.housner.reference.rocking import Named, Rocking, first_positive

JAM = 0.05
"""Share of its value without friction at which the inertia of slip counts as lost."""


class Sliding(Rocking):
    """``extra`` is (u, u'); ``way`` the sign of u' while the contact slips, 0 while it sticks."""

    extra = (0.0, 0.0)

    def __init__(self, equation: Equation, grid: FloatArray, rtol: float, follow: bool) -> None:
        size = equation.height * equation.alpha
        self.extra_scale = (size, size * equation.frequency_parameter)
        super().__init__(equation, grid, rtol, follow)
        self.mu, self.way, self.jammed = float(equation.block.friction[0]), 0, False

    def _contact(
        self, theta: float, rate: float, way: int, direction: int, ground: tuple[float, float, float]
    ) -> tuple[float, float, float, float]:
        """theta'', u'', H and N."""
        eq = self.equation
        a, gravity, pitching = ground
        sway, lift, inertia = eq.arms(theta, self.side, self.largest)
        fixed, _ = eq.acceleration(theta, rate, self.side, direction, self.largest, ground)
        m, push = eq.mass, a + eq.height * pitching
        law = [0.0, 1.0, 0.0, 0.0] if way == 0 else [0.0, 0.0, 1.0, self.mu * way]
        right = [inertia * fixed, -m * (push + lift * rate**2), -m * (gravity + (eq.rho - sway) * rate**2), 0.0]
        rows = [[inertia, m * sway, 0.0, 0.0], [m * sway, m, -1.0, 0.0], [m * lift, 0.0, 0.0, -1.0]]
        second, slip, across, up = np.linalg.solve([*rows, law], right).tolist()
        if way == 0:
            return second, 0.0, across, up
        if up < 0.0:
            second, slip, across, up = np.linalg.solve([*rows, [0.0, 0.0, 1.0, 0.0]], right).tolist()
        return second, slip, across, up

    def _rates(self, time: float, y: FloatArray, direction: int, piece: PitchedPiece) -> tuple[float, ...]:
        theta, rate, _, _, v = y.tolist()
        ground = piece.at(time)
        second, slip, across, _ = self._contact(theta, rate, self.way, direction, ground)
        _, power = self.equation.acceleration(theta, rate, self.side, direction, self.largest, ground)
        return rate, second, power - (across * v if self.way else 0.0), v, slip

    def _excess(self, time: float, y: FloatArray, direction: int, piece: PitchedPiece) -> float:
        _, _, across, up = self._contact(float(y[0]), float(y[1]), 0, direction, piece.at(time))
        return abs(across) - self.mu * max(up, 0.0)

    def _more_events(self, piece: PitchedPiece, direction: int) -> Named:
        if self.way:
            return [("stop", lambda time, y: self.way * float(y[4]), -1)]
        if self.jammed:
            return []
        return [("slip", lambda time, y: self._excess(time, y, direction, piece), 1)]

    def _rock(self, piece: PitchedPiece, shaken: bool) -> None:
        if self.way == 0 and self._excess(self.time, self._state(), self._sense(), piece) > 0.0:
            self._start(piece)
        elif self.way and self._jams(self.way):
            self._stick()
        super()._rock(piece, shaken)
        self.jammed = False

    def _sense(self) -> int:
        return self.side if self.rate == 0.0 else int(math.copysign(1.0, self.rate))

    def _start(self, piece: PitchedPiece) -> None:
        _, _, across, _ = self._contact(self.theta, self.rate, 0, self._sense(), piece.at(self.time))
        way = -1 if across > 0.0 else 1
        self.jammed = self._jams(way)
        self.way = 0 if self.jammed else way

    def _jams(self, way: int) -> bool:
        eq = self.equation
        sway, lift, inertia = eq.arms(self.theta, self.side, self.largest)
        free = inertia / eq.mass - sway**2
        return free - self.mu * way * sway * lift < JAM * free

    def _stick(self) -> None:
        """The slip stops at once, by an impulse at the corner."""
        eq, (u, v) = self.equation, self.extra
        sway, _, inertia = eq.arms(self.theta, self.side, self.largest)
        before = 0.5 * (inertia * self.rate**2 + eq.mass * v * (2.0 * sway * self.rate + v))
        self.rate += eq.mass * sway * v / inertia
        self.lost += before - 0.5 * inertia * self.rate**2
        self.way, self.jammed, self.extra = 0, True, (u, 0.0)

    def _happen(self, kind: str, piece: PitchedPiece) -> None:
        if kind == "slip":
            self._start(piece)
        elif kind == "stop":
            self.way, self.extra = 0, (self.extra[0], 0.0)
        else:
            super()._happen(kind, piece)

    def _needed(self, time: float, y: FloatArray, piece: PitchedPiece, direction: int) -> float:
        _, _, across, up = self._contact(float(y[0]), float(y[1]), self.way, direction, piece.at(time))
        return abs(across) / up if up > 0.0 else math.inf

    def _shift(self, y: FloatArray) -> FloatArray:
        return np.asarray(y[3])

    def _wait(self, piece: PitchedPiece, shaken: bool) -> None:
        eq = self.equation

        def loads(time: float) -> tuple[float, float]:
            a, gravity, pitching = piece.at(time)
            return a + eq.height * pitching, self.mu * gravity

        def sliding(time: float, way: int) -> float:
            push, hold = loads(time)
            return -way * push - hold

        if self.way == 0:
            slip, way = min((first_positive(sliding, s, self.time, piece.end), s) for s in (1, -1))
            lift = min(
                first_positive(lambda t, s: eq.excess(s, self.largest, piece.at(t)), s, self.time, piece.end)
                for s in (1, -1)
            )
            if lift < slip or math.isinf(slip):
                super()._wait(piece, shaken)
                return
            self._write(slip, None)
            self.time, self.way = slip, way
        side = self._tips(piece)
        if side:
            self._lift(side)
            return

        def rates(time: float, y: FloatArray) -> tuple[float, ...]:
            push, hold = loads(time)
            return 0.0, 0.0, eq.mass * hold * abs(float(y[4])), float(y[4]), -push - self.way * hold

        named: Named = [("stop", lambda time, y: self.way * float(y[4]), -1)]
        solution, kind = self._solve(rates, self._state(), named, piece.end)
        self.lost += float(solution.y[2, -1])
        self.extra = (float(solution.y[3, -1]), float(solution.y[4, -1]))
        if kind == "stop":
            self._happen(kind, piece)

    def _tips(self, piece: PitchedPiece) -> int:
        """The side onto which the block in full contact is lifted at once, 0 when it is not."""
        a, gravity, pitching = piece.at(self.time)
        push = a + self.equation.height * pitching
        hold = self.mu * gravity
        held = -self.way * hold if self.way else max(-hold, min(hold, push))
        ground = a + held - push, gravity, pitching
        return next((s for s in (1, -1) if self.equation.excess(s, self.largest, ground) > 0.0), 0)

    def _impact(self, piece: PitchedPiece) -> None:
        eq, (u, v), before, s = self.equation, self.extra, self.rate, self.side
        h, m, inertia, mu = eq.height, eq.mass, eq.inertia, self.mu
        old, new = eq.half_width(s, self.largest), eq.half_width(-s, self.largest)
        e = self._ratio(old, new)
        corner = eq.base_inertia + m * new**2
        couple = (corner * e - (eq.base_inertia - m * old * new)) * before

        def energy(rate: float, slip: float, b: float) -> float:
            return 0.5 * (eq.base_inertia + m * b**2) * rate**2 + m * slip * (h * rate + 0.5 * slip)

        def solved(law: list[float]) -> tuple[float, float, float, float]:
            """theta' and u' after, tangential and normal impulse."""
            rows = [
                [m * h, m, -1.0, 0.0],
                [-m * s * new, 0.0, 0.0, -1.0],
                [inertia, 0.0, h, -s * new],
                law,
            ]
            right = [m * (v + h * before), m * s * old * before, inertia * before + couple, 0.0]
            rate, slip, across, up = np.linalg.solve(rows, right).tolist()
            return rate, slip, across, up

        was = energy(before, v, old)
        after, _, across, up = solved([0.0, 1.0, 0.0, 0.0])
        slip = 0.0
        if abs(across) > mu * up:
            pull = math.copysign(mu, across)
            size = inertia + m * new * (new - s * pull * h)
            rate, fast, _, _ = solved([0.0, 0.0, 1.0, -pull])
            if size > JAM * inertia and pull * fast <= 0.0 and energy(rate, fast, new) <= was:
                after, slip = rate, fast
        if s * after > 0.0:
            after, slip = 0.0, v + h * before
            slip -= math.copysign(min(abs(slip), mu * old * abs(before)), slip)
        slow = REST_VELOCITY * eq.frequency_parameter * eq.alpha
        if abs(after) < slow and abs(slip) * eq.frequency_parameter**2 < slow * float(eq.block.gravity[0]):
            # ever smaller impacts leave ever less slip, whose full friction would lift the block again without end
            slip = 0.0
        self.impacts += 1
        self.theta, self.side, self.arc = 0.0, -s, 0.0
        self.extra, self.way = (u, slip), int(np.sign(slip))
        self.events.append(Event(self.time, "impact"))
        if abs(after) < slow and not self._tips(piece):
            after, self.mode = 0.0, "rest"
            self.events.append(Event(self.time, "rest"))
        self.rate = after
        self.lost += was - energy(after, slip, new)
