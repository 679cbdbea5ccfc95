"""The equation of motion of one block, written out plainly for one lane.

The body turns by theta (clockwise) about the contact on side s = sign(theta). With the corner
rounded to radius rho, b' = (1 - inset) b_s - rho, h' = h - rho and the arc rolling on the ground, the
mass centre lies at X = s b' + rho theta - s b' cos + h' sin, Z = rho + s b' sin + h' cos, hence

    X_t = rho + s b' sin(theta) + h' cos(theta)        Z_t = s b' cos(theta) - h' sin(theta)
    X_tt = Z_t                                         Z_tt = rho - X_t
    J theta'' + M rho Z_t theta'^2 + M G Z_t q + M a X_t + (I + M h^2) psi'' = couples
    J = I + M (X_t^2 + Z_t^2)

since X_t X_tt + Z_t Z_tt = rho Z_t. A sharp corner (rho = 0) gives Housner's equation with
p^2 = M g R / I_O. q = 1 - exp(-|theta|/joint_angle) in a flexible joint, else 1. The inset of a
crushed corner is min(.35, crushing_rate * largest |theta| so far), on both sides; the present contact
point is taken as the centre of rotation.
couples = -stiffness (|theta| - gap)+ s - I_O viscous theta' - I_O quadratic theta' |theta'|
          - coulomb sign(theta') + I_O times the law in a table, I_O = I + M (h^2 + (b' + rho)^2) about the corner.

Linear formulation: X_t = R, Z_t = s R alpha - (R - rho) theta, J = I + M R^2, no theta'^2 term, with
R and alpha of the present contact: theta'' = -(M R/I_O) [G (alpha s - theta) + a].
"""

from __future__ import annotations

import math

from models.housner.block import Block
from models.housner.reference.table import LawInTable

MOST_INSET = 0.35


class Equation:
    """The terms above as functions of the state, for a `Block` of one lane.

    ``largest`` is the largest |theta| so far (rad) and ``ground`` the triple (a - G psi, G, psi'').
    """

    def __init__(self, block: Block, linear: bool) -> None:
        if block.size != 1:
            raise ValueError(f"the reference runs one block at a time, {block.size} were given")
        self.block, self.linear = block, linear
        self.mass, self.height = float(block.mass[0]), float(block.height[0])
        self.inertia, self.rho = float(block.inertia[0]), float(block.corner_radius[0])
        self.right, self.left = float(block.right[0]), float(block.left[0])
        self.crushing, self.joint = float(block.crushing_rate[0]), float(block.joint_angle[0])
        self.stiffness, self.gap = float(block.stiffness[0]), float(block.gap[0])
        self.viscous, self.quadratic = float(block.viscous[0]), float(block.quadratic[0])
        self.coulomb = float(block.coulomb[0])
        self.table = LawInTable(block.table[0]) if bool(block.tabulated[0]) else None
        self.base_inertia = self.inertia + self.mass * self.height**2
        self.alpha = float(block.slenderness[0])
        self.frequency_parameter = float(block.frequency_parameter[0])

    @property
    def rubs(self) -> bool:
        """Whether friction may hold the block where it turns."""
        return self.coulomb > 0.0 or self.table is not None

    def half_width(self, side: int, largest: float) -> float:
        """b' in m of the contact on ``side``."""
        inset = min(MOST_INSET, self.crushing * largest)
        return (1.0 - inset) * (self.right if side > 0 else self.left) - self.rho

    def arms(self, theta: float, side: int, largest: float) -> tuple[float, float, float]:
        """X_t, Z_t (m) and J (kg m2); ``largest`` without the present |theta|."""
        b = self.half_width(side, max(largest, abs(theta)))
        if self.linear:
            radius, alpha = math.hypot(b, self.height), math.atan2(b, self.height)
            lift = side * radius * alpha - (radius - self.rho) * theta
            return radius, lift, self.inertia + self.mass * radius**2
        h, sine, cosine = self.height - self.rho, math.sin(theta), math.cos(theta)
        sway, lift = self.rho + side * b * sine + h * cosine, side * b * cosine - h * sine
        return sway, lift, self.inertia + self.mass * (sway**2 + lift**2)

    def moment(
        self, theta: float, rate: float, side: int, largest: float, ground: tuple[float, float, float]
    ) -> tuple[float, float]:
        """Moment (N m) of all that depends on the position and the ground, and J."""
        a, gravity, pitching = ground
        sway, lift, inertia = self.arms(theta, side, largest)
        share = 1.0 - math.exp(-abs(theta) / self.joint) if self.joint > 0.0 else 1.0
        moment = -self.mass * (gravity * lift * share + a * sway) - self.base_inertia * pitching
        if not self.linear:
            moment -= self.mass * self.rho * lift * rate**2
        moment -= side * self.stiffness * max(0.0, abs(theta) - self.gap)
        return moment, inertia

    def acceleration(
        self,
        theta: float,
        rate: float,
        side: int,
        direction: int,
        largest: float,
        ground: tuple[float, float, float],
    ) -> tuple[float, float]:
        """theta'' (rad s-2) and the power lost in couples (W); ``direction`` is the sign of theta'."""
        moment, inertia = self.moment(theta, rate, side, largest, ground)
        corner = self.half_width(side, max(largest, abs(theta))) + self.rho
        drag = (self.base_inertia + self.mass * corner**2) * (self.viscous + self.quadratic * abs(rate))
        couple = drag * rate + direction * self.coulomb
        if self.table is not None:
            law = self.table.acceleration(theta, rate, ground[0], side, direction)
            couple -= (self.base_inertia + self.mass * corner**2) * law
        return (moment - couple) / inertia, couple * rate

    def excess(self, side: int, largest: float, ground: tuple[float, float, float]) -> float:
        """Moment (N m) by which the block at rest starts to turn towards ``side``; <= 0: it stays."""
        return self.push(0.0, side, side, largest, ground)

    def push(
        self, theta: float, direction: int, side: int, largest: float, ground: tuple[float, float, float]
    ) -> float:
        """Moment (N m) by which the block without velocity starts to turn in ``direction``; <= 0: it stays."""
        moment, _ = self.moment(theta, 0.0, side, largest, ground)
        if self.table is not None:
            corner = self.half_width(side, max(largest, abs(theta))) + self.rho
            law = self.table.acceleration(theta, 0.0, ground[0], side, direction)
            moment += (self.base_inertia + self.mass * corner**2) * law
        return direction * moment - self.coulomb

    def friction_demand(
        self,
        theta: float,
        rate: float,
        second: float,
        side: int,
        largest: float,
        ground: tuple[float, float, float],
    ) -> float:
        """|H|/N at the contact, infinite where N <= 0: H = M (a + h psi'' + X''), N = M (G + Z'')."""
        a, gravity, pitching = ground
        sway, lift, _ = self.arms(theta, side, largest)
        horizontal = a + self.height * pitching + sway * second + lift * rate**2
        vertical = gravity + lift * second + (self.rho - sway) * rate**2
        return abs(horizontal) / vertical if vertical > 0.0 else math.inf
