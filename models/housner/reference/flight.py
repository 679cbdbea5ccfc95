"""Reference of a block that bounces: contact restitution c at the landing corner, and free flight.

Impact at theta = 0: the landed corner leaves with the vertical velocity (b+ + b-) c |theta'| and without
slipping at that instant, theta'_after = [e - c (1 - e)] theta'_before (angular momentum about it).
Flight, seen from the base: x'' = -(a - G psi + h psi''), z'' = -G, theta'' = -psi'', until the lowest corner,
on the side of sign(theta), is down again. Landing out of the air: its normal velocity w < 0 turns into -c w,
again without slip and with the angular momentum about it kept. A rebound slower than b times the angular
velocity that counts as rest is left out: the corner stays down. Landings on the corner that has just left
count neither as impact nor as change of pivot.
"""

from __future__ import annotations

import math

import numpy as np

from models.base import FloatArray
from models.ground import PitchedPiece
from models.housner.declaration import REST_VELOCITY
from models.housner.reference.rocking import Named, Rocking


class Bouncing(Rocking):
    """``extra`` is (u,), the displacement of the corners so far; ``air`` is (x, x', z, z') in flight."""

    extra = (0.0,)
    extra_scale = (1.0,)
    air: tuple[float, ...] = ()

    def _rates(self, time: float, y: FloatArray, direction: int, piece: PitchedPiece) -> tuple[float, ...]:
        return (*super()._rates(time, y[:3], direction, piece), 0.0)

    def _go(self, piece: PitchedPiece, shaken: bool) -> None:
        if self.mode == "flight":
            self._fly(piece)
        else:
            super()._go(piece, shaken)

    def _place(self, theta: float) -> tuple[float, float]:
        """x - u and z of the mass centre (m) of a block that stands on the corner of sign(theta)."""
        eq, side = self.equation, 1 if theta >= 0.0 else -1
        b, h = eq.half_width(side, self.largest), eq.height - eq.rho
        sine, cosine = math.sin(theta), math.cos(theta)
        return side * b * (1.0 - cosine) + eq.rho * theta + h * sine, eq.rho + side * b * sine + h * cosine

    def _shift(self, y: FloatArray) -> FloatArray:
        if self.mode != "flight":
            return np.asarray(y[3])
        return np.array([x - self._place(theta)[0] for theta, x in zip(y[0], y[3], strict=True)])

    def _state(self) -> FloatArray:
        return np.array([self.theta, self.rate, 0.0, *(self.air if self.mode == "flight" else self.extra)])

    def _smallest(self, side: int) -> float:
        """Rebound (m s-1) that is left out."""
        eq = self.equation
        return eq.half_width(side, self.largest) * REST_VELOCITY * eq.frequency_parameter * eq.alpha

    def _energy(self, rate: float, across: float, up: float) -> float:
        return 0.5 * (self.equation.inertia * rate**2 + self.equation.mass * (across**2 + up**2))

    def _impact(self, piece: PitchedPiece) -> None:
        eq, before, c = self.equation, self.rate, float(self.equation.block.contact_restitution[0])
        super()._impact(piece)
        new, old = eq.half_width(self.side, self.largest), eq.half_width(-self.side, self.largest)
        rebound = c * (old + new) * abs(before)
        if self.mode != "up" or rebound <= self._smallest(self.side):
            return
        stays = self._energy(self.rate, eq.height * self.rate, self.side * new * self.rate)
        self.rate -= c * (before - self.rate)
        across, up = eq.height * self.rate, rebound + self.side * new * self.rate
        self.lost += stays - self._energy(self.rate, across, up)
        self.mode, self.air = "flight", (self.extra[0], across, eq.height, up)

    def _fly(self, piece: PitchedPiece) -> None:
        eq = self.equation

        def rates(time: float, y: FloatArray) -> tuple[float, ...]:
            a, gravity, pitching = piece.at(time)
            return float(y[1]), -pitching, 0.0, float(y[4]), -a - eq.height * pitching, float(y[6]), -gravity

        named: Named = [
            ("landing", lambda time, y: float(y[5]) - self._place(float(y[0]))[1], -1),
            ("fall", lambda time, y: abs(float(y[0])) - math.pi / 2.0, 1),
        ]
        start, began = self._state(), self.time
        _, lift, _ = eq.arms(self.theta, 1 if self.theta >= 0.0 else -1, self.largest)
        rising = self.air[3] - lift * self.rate
        first = 0.1 * rising / piece.at(self.time)[1] if rising > 0.0 else math.inf
        angle, size = eq.alpha, eq.height * eq.alpha
        p = eq.frequency_parameter
        atol = self.rtol * np.array([angle, p * angle, 1.0, size, p * size, size, p * size])
        solution, kind = self._solve(rates, start, named, piece.end, first, atol)
        self.uplift += self.time - began
        self.theta, self.rate, _, *air = solution.y[:, -1].tolist()
        self.air = tuple(air)
        self.arc = max(self.arc, abs(self.theta))
        self.largest = max(self.largest, self.arc)
        if kind == "landing":
            self._land()
        elif kind == "fall":
            self._happen(kind, piece)

    def _land(self) -> None:
        eq, (x, across, z, up) = self.equation, self.air
        side = 1 if self.theta >= 0.0 else -1
        sway, lift, _ = eq.arms(self.theta, side, self.largest)
        rebound = -float(eq.block.contact_restitution[0]) * (up - lift * self.rate)
        rebound = 0.0 if rebound <= self._smallest(side) else rebound
        # theta', x', z' after, and both impulses
        m, inertia = eq.mass, eq.inertia
        rows = [
            [0.0, m, 0.0, -1.0, 0.0],
            [0.0, 0.0, m, 0.0, -1.0],
            [inertia, 0.0, 0.0, sway, lift],
            [-sway, 1.0, 0.0, 0.0, 0.0],
            [-lift, 0.0, 1.0, 0.0, 0.0],
        ]
        right = [m * across, m * up, inertia * self.rate, 0.0, rebound]
        rate, across_after, up_after, _, _ = np.linalg.solve(rows, right).tolist()
        self.lost += self._energy(self.rate, across, up) - self._energy(rate, across_after, up_after)
        self.rate = rate
        if side != self.side:
            self.side, self.arc = side, 0.0
            self.impacts += 1
        if rebound > 0.0:
            self.air = (x, across_after, z, up_after)
        else:
            self.mode, self.extra = "up", (x - self._place(self.theta)[0],)
