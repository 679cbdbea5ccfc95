"""Reference of a wall that bends: one cantilever mode of amplitude eta (m, at the wall's top) on the rocking block.

Body axes turn with the base about the corner (half width b, side s); a particle at height z lies at
(-s b + eta phi(z), z). With m, f, k the integrals of phi^2, phi and phi z over the mass
(`models.housner.cantilever`), W the clamped circular frequency and xi the structural damping, Lagrange gives

    (J - 2 s b f eta + m eta^2) theta'' + k eta'' + 2 theta' eta' (m eta - s b f)
        - f eta (G cos(theta) + a sin(theta)) = moments of the rigid block
    k theta'' + m eta'' - theta'^2 (m eta - s b f) - f (G sin(theta) - a cos(theta)) + m (2 xi W eta' + W^2 eta) = 0

Full contact: theta = 0 and m (eta'' + 2 xi W eta' + W^2 eta) = -f a; the base lifts onto side s when
-s [k eta'' + M h a - G f eta] > G M b. First-order gravity on the bent wall is part of W.
Impact: the angular momentum about the new corner follows the rigid block's law,
(J' - k^2/m) theta'_after = (e J - k^2/m) theta'_before with an eta' that no impulse of its own changes; where that
would turn the base back (e J < k^2/m), or hardly turn it, the base lands flat and the mode alone carries the
angular momentum: eta' grows by (e J/k) theta'_before. So the energy never grows, and a stiff wall follows the
rigid block. A run that starts in motion starts with the mode at its static deflection under that motion.
Sharp corners on a hard base; sections do not turn. The rocking mode of the pair is stiffer than a free beam's.
"""

from __future__ import annotations

import math

import numpy as np

from models.base import Event, FloatArray
from models.ground import PitchedPiece
from models.housner.cantilever import STRUCTURAL_DAMPING
from models.housner.declaration import REST_VELOCITY
from models.housner.reference.equation import Equation
from models.housner.reference.rocking import Named, Rocking


class Bending(Rocking):
    """``extra`` is (eta, eta')."""

    extra = (0.0, 0.0)

    def __init__(self, equation: Equation, grid: FloatArray, rtol: float, follow: bool) -> None:
        block = equation.block
        self.natural = 2.0 * math.pi * float(block.first_frequency[0])
        self.m, self.f = float(block.modal_mass[0]), float(block.modal_force[0])
        self.k = float(block.modal_moment[0])
        static = float(block.gravity[0]) * equation.alpha / self.natural**2
        self.extra_scale = (static, static * self.natural)
        super().__init__(equation, grid, rtol, follow)
        stiff = 1.0 - self.k**2 / (self.m * float(block.pivot_inertia[0]))
        self.longest = min(self.longest, 0.5 * math.sqrt(stiff) / self.natural)
        self.relaxed = False

    def _push(self, theta: float, eta: float, speed: float, ground: tuple[float, float, float]) -> float:
        """Modal force (N) of gravity, the ground, the spring and the damper."""
        a, gravity, pitching = ground
        spring = self.m * self.natural * (2.0 * STRUCTURAL_DAMPING * speed + self.natural * eta)
        return self.f * (gravity * math.sin(theta) - a * math.cos(theta)) - self.k * pitching - spring

    def _pull(self) -> float:
        """s b f in kg m."""
        return self.side * self.equation.half_width(self.side, self.largest) * self.f

    def _seconds(self, y: FloatArray, direction: int, ground: tuple[float, float, float]) -> tuple[float, float, float]:
        """theta'', eta'' and the power lost (W) while the block rocks."""
        theta, rate, _, eta, speed = y.tolist()
        eq, a, gravity = self.equation, ground[0], ground[1]
        fixed, power = eq.acceleration(theta, rate, self.side, direction, self.largest, ground)
        _, _, inertia = eq.arms(theta, self.side, self.largest)
        bulge = self.m * eta - self._pull()
        matrix = [[inertia - 2.0 * self._pull() * eta + self.m * eta**2, self.k], [self.k, self.m]]
        weight = self.f * eta * (gravity * math.cos(theta) + a * math.sin(theta))
        right = [
            inertia * fixed + weight - 2.0 * rate * speed * bulge,
            self._push(theta, eta, speed, ground) + rate**2 * bulge,
        ]
        second, bent = np.linalg.solve(matrix, right).tolist()
        return second, bent, power + self._damping(speed)

    def _damping(self, speed: float) -> float:
        return 2.0 * STRUCTURAL_DAMPING * self.natural * self.m * speed**2

    def _rates(self, time: float, y: FloatArray, direction: int, piece: PitchedPiece) -> tuple[float, ...]:
        second, bent, power = self._seconds(y, direction, piece.at(time))
        return float(y[1]), second, power, float(y[4]), bent

    def _needed(self, time: float, y: FloatArray, piece: PitchedPiece, direction: int) -> float:
        theta, rate, _, eta, speed = y.tolist()
        eq = self.equation
        a, gravity, pitching = piece.at(time)
        second, bent, _ = self._seconds(y, direction, (a, gravity, pitching))
        sway, lift, _ = eq.arms(theta, self.side, self.largest)
        share, sine, cosine = self.f / eq.mass, math.sin(theta), math.cos(theta)
        across, along = bent - eta * rate**2, 2.0 * speed * rate + eta * second
        right = a + eq.height * pitching + sway * second + lift * rate**2 + share * (across * cosine - along * sine)
        up = gravity + lift * second + (eq.rho - sway) * rate**2 - share * (across * sine + along * cosine)
        return abs(right) / up if up > 0.0 else math.inf

    def _shift(self, y: FloatArray) -> FloatArray:
        return np.asarray(self.f / self.equation.mass * y[3] * np.cos(y[0]))

    def _rock(self, piece: PitchedPiece, shaken: bool) -> None:
        if not self.relaxed and self.time == 0.0:
            fixed, _ = self.equation.acceleration(
                self.theta, self.rate, self.side, self._sense(), self.largest, piece.at(0.0)
            )
            push = self._push(self.theta, 0.0, 0.0, piece.at(0.0)) - self.k * fixed - self.rate**2 * self._pull()
            self.extra = (push / (self.m * self.natural**2), 0.0)
        self.relaxed = True
        super()._rock(piece, shaken)

    def _sense(self) -> int:
        return self.side if self.rate == 0.0 else int(math.copysign(1.0, self.rate))

    def _wait(self, piece: PitchedPiece, shaken: bool) -> None:
        self.relaxed = True
        eq = self.equation

        def rates(time: float, y: FloatArray) -> tuple[float, ...]:
            eta, speed = y[3:].tolist()
            return 0.0, 0.0, self._damping(speed), speed, self._push(0.0, eta, speed, piece.at(time)) / self.m

        def lifting(time: float, y: FloatArray, side: int) -> float:
            ground = piece.at(time)
            bent = self.k * rates(time, y)[4] - ground[1] * self.f * float(y[3])
            return eq.excess(side, self.largest, ground) - side * bent

        named: Named = [
            ("right", lambda time, y: lifting(time, y, 1), 1),
            ("left", lambda time, y: lifting(time, y, -1), 1),
        ]
        start = self._state()
        for side in (1, -1):
            if lifting(self.time, start, side) > 0.0:
                self._lift(side)
                return
        solution, kind = self._solve(rates, start, named, piece.end)
        self.lost += float(solution.y[2, -1])
        self.extra = (float(solution.y[3, -1]), float(solution.y[4, -1]))
        if kind is not None:
            self._lift(1 if kind == "right" else -1)

    def _impact(self, piece: PitchedPiece) -> None:
        eq, (eta, speed), before, s = self.equation, self.extra, self.rate, self.side
        old, new = eq.half_width(s, self.largest), eq.half_width(-s, self.largest)

        def inertia(side: int, b: float) -> float:
            return eq.base_inertia + eq.mass * b**2 - 2.0 * side * b * self.f * eta + self.m * eta**2

        def energy(side: int, b: float, rate: float, bending: float) -> float:
            return 0.5 * inertia(side, b) * rate**2 + self.k * rate * bending + 0.5 * self.m * bending**2

        # angular momentum about the new corner per theta' of the rigid law, the bent shape included
        kept = self._ratio(old, new) * (eq.base_inertia + eq.mass * new**2)
        kept += self.f * eta * s * (new - old) + self.m * eta**2
        share = self.k**2 / self.m
        was = energy(s, old, before, speed)
        after = (kept - share) / (inertia(-s, new) - share) * before
        bending = speed + self.k / self.m * (before - after)
        self.impacts += 1
        self.events.append(Event(self.time, "impact"))
        self.theta, self.side, self.arc = 0.0, -s, 0.0
        if kept <= share or abs(after) < REST_VELOCITY * eq.frequency_parameter * eq.alpha:
            after, self.mode = 0.0, "rest"
            bending = speed + min(kept, share) / self.k * before
            self.events.append(Event(self.time, "rest"))
        self.rate, self.extra = after, (eta, bending)
        self.lost += was - energy(-s, new, after, bending)
