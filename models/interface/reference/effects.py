"""The equations of a wall with effects, one wall at a time: Lagrange's on the chain of `models.interface.chain`.

With J_i = dG_i/dq, R_i its rotation's:  M = sum m_i J_i^T J_i + I_i R_i^T R_i,  n = sum m_i J_i^T (J_i' q' + ground),
M q'' + n = Q. Dry friction (of the couple, of sliding) holds its coordinate as long as it can and has its full size
while that moves; the wear of the base counts closings. Both change at events, which `switches` gives.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from models.base import FloatArray
from models.interface import landing, resting, strip
from models.interface.chain import ROTATIONS, SIZE, Chain, chain, free_coordinates, masses
from models.interface.effects import CELLS, CLOSED, LANDED, OPENED
from models.interface.layered import LayeredWall
from models.interface.reference.account import Pair
from models.interface.reference.equation import NONE, Both, Equation, Ground, Switch
from models.interface.stored import frozen_share, static_compressions, stored, torn
from models.interface.strip import Strip
from models.interface.table import LawInTable

COUPLE, SLIP = 0, 4
"""Coordinates that dry friction holds: theta1, x1."""


class EffectsEquation(Equation):
    """One wall (of one lane) in all eight coordinates.

    Behind the laws' hidden numbers come the ends of what is bonded and, where layers give way along the joints, the
    slips at which they have landed.
    """

    size = SIZE

    def __init__(self, wall: LayeredWall) -> None:
        super().__init__(wall)
        self.lanes, self.effects = wall, wall.one().effects
        self.free = free_coordinates(wall)
        self.weights, self.inertias = masses(self.wall)
        self.laws, self.landed = self.hidden, self.hidden + 2
        self.shears = bool(self.effects.parts & {"interface_shear"})
        self.hidden = self.landed + (2 * CELLS if self.shears else 0)
        self.rest = resting.at_rest(wall)
        self.turning = ROTATIONS.T @ (self.inertias[:, None] * ROTATIONS)
        self.static = static_compressions(wall)
        self.law = LawInTable(self.wall) if self.effects.law else None
        self.closings, self.opened = 0.0, False
        dry = ((COUPLE, self.effects.dry_couple > 0.0), (SLIP, math.isfinite(self.effects.friction)))
        self.moving = {k: 0.0 for k, acts in dry if acts and np.any(self.free[k])}
        """Sign of the velocity of what dry friction acts on; 0 while it is held."""

    @property
    def wear(self) -> float:
        return float(1.0 + self.effects.final_loss * math.expm1(-self.closings / self.effects.loss_cycles))

    @staticmethod
    def at_joint(joint: str, q: Sequence[float]) -> Pair:
        return (q[2], q[0]) if joint == "base" else (q[3], q[1] - q[6])

    def begun(self, q: Sequence[float], v: Sequence[float], memory: Mapping[str, float]) -> FloatArray:
        self.closings, self.opened = memory.get("closings", 0.0), memory.get("opened", 0.0) > 0.5
        for k in self.moving:
            self.moving[k] = float(np.sign(v[k]))
        b = self.wall.base_half_width
        left, right = (-b, b) if self.effects.tearing > 0.0 else (b, -b)
        found = self.relaxed(q)
        found[self.laws : self.landed] = memory.get("torn_left", left), memory.get("torn_right", right)
        found[self.landed :] = [memory.get(name, 0.0) for name in LANDED[: self.hidden - self.landed]]
        return found

    # --- forces

    def strips(self, q: Sequence[float], v: Sequence[float], hidden: FloatArray) -> tuple[Strip, Strip, FloatArray]:
        """Base and top across, and the rates of the hidden state."""
        wall, e = self.wall, self.effects
        rates = np.zeros_like(hidden)
        base = top = NONE
        if wall.joints != "top":
            base = self._base(q, v, hidden, rates)
        if wall.joints != "base":
            turn, rate = q[1] - q[6], v[1] - v[6]
            motion = (q[3], math.sin(turn), v[3], math.cos(turn) * rate)
            b, k, c = wall.top_half_width, wall.top_stiffness, wall.top_damping
            top = strip.strip(b, k, c, *motion, wall.clip)
            if "top" in self.fibres:
                top = self._with_laws("top", top, (q[3], turn, v[3], rate), hidden, rates, 1.0)
            if e.frozen_top != 0.0:
                top = _mixed(e.frozen_top, top, self._frozen(1, b, (k, k), c, motion))
        if self.shears:
            base, top = (self._landed(k, strip_, q, v, hidden, rates) for k, strip_ in enumerate((base, top)))
        return base, top, rates

    def _landed(
        self, k: int, strip_: Strip, q: Sequence[float], v: Sequence[float], hidden: FloatArray, rates: FloatArray
    ) -> Strip:
        """A joint with the slips at which it has landed; their rates are filled in."""
        part, joint = slice(self.landed + k * CELLS, self.landed + (k + 1) * CELLS), ("base", "top")[k]
        b = (self.wall.base_half_width, self.wall.top_half_width)[k]
        (z, turn), (z_rate, turn_rate) = self.at_joint(joint, q), self.at_joint(joint, v)
        motion = math.sin(turn), z_rate, math.cos(turn) * turn_rate
        ends = strip.touching((-b, b), z, motion[0])
        rates[part] = landing.rates(b, ends, motion, (q[4 + k], v[4 + k]), hidden[part])
        pressed = landing.pressed(b, motion[0], strip_.share)
        landed = landing.lengths(np.array(b), np.array(pressed[0]), np.array(pressed[1])) @ hidden[part]
        return strip_._replace(landed=float(landed))

    def _base(self, q: Sequence[float], v: Sequence[float], hidden: FloatArray, rates: FloatArray) -> Strip:
        wall, e = self.wall, self.effects
        b, c, s = wall.base_half_width, wall.base_damping, math.sin(q[0])
        motion = (q[2], s, v[2], math.cos(q[0]) * v[0])
        left, right = b, -b
        if e.tearing > 0.0:
            ends = torn(e, np.array(b), np.array(q[2]), np.array(s), list(hidden[self.laws : self.landed, None]))
            left, right = (end.item() for end in ends)
        if e.tearing > 0.0 and s != 0.0:
            front, behind = (q[2] - e.tearing) / s, hidden[self.laws] if s > 0.0 else hidden[self.laws + 1]
            speed = (motion[2] - front * motion[3]) / s
            if s > 0.0 and behind <= front < b:
                rates[self.laws] = max(0.0, speed)
            if s < 0.0 and -b < front <= behind:
                rates[self.laws + 1] = min(0.0, speed)
        force = moment = length = 0.0
        stiffness = [self.wear * wall.base_stiffness * side for side in (e.left, e.right)]
        for low, high, k in ((-b, 0.0, stiffness[0]), (0.0, b, stiffness[1])):
            held = (min(max(left, low), high), min(max(right, low), high))
            loose = [(low, held[0]), (held[1], high)] if held[0] < held[1] else [(low, high)]
            pieces = [strip.pressing(ends, k, c, *motion, wall.clip) for ends in loose]
            pieces += [held] if held[0] < held[1] else []
            for piece in pieces:
                n, m = strip.resultants(piece, k, c, *motion)
                force, moment = force + n, moment + m
            pressed = strip.pressing((low, high), k, c, *motion, wall.clip)
            length += pressed[1] - pressed[0]
        exact = Strip(force, moment, length / (2.0 * b))
        if "base" in self.fibres:
            exact = self._with_laws("base", exact, (q[2], q[0], v[2], v[0]), hidden, rates, self.wear)
        if e.frozen_base == 0.0:
            return exact
        return _mixed(e.frozen_base, exact, self._frozen(0, b, (stiffness[0], stiffness[1]), c, motion))

    def _with_laws(
        self, joint: str, linear: Strip, motion: tuple[float, ...], hidden: FloatArray, rates: FloatArray, wear: float
    ) -> Strip:
        fibres, part = self.fibres[joint], self.parts[joint]
        more = fibres.difference(motion, fibres.parted(hidden[part]), wear)
        rates[part] = fibres.joined(more.rates)
        return linear._replace(force=linear.force + more.force.item(), moment=linear.moment + more.moment.item())

    def _frozen(
        self, joint: int, b: float, sides: tuple[float, float], c: float, motion: tuple[float, float, float, float]
    ) -> tuple[float, float]:
        """Force and moment of a contact frozen at half."""
        lift = np.array([b * abs(motion[1])])
        share = float(frozen_share(np.array([motion[0]]), lift, self.static[joint])[0])
        left = strip.resultants((-b, 0.0), sides[0], c, *motion)
        right = strip.resultants((0.0, b), sides[1], c, *motion)
        keeps = (share, 1.0) if motion[1] >= 0.0 else (1.0, share)
        return keeps[0] * left[0] + keeps[1] * right[0], keeps[0] * left[1] + keeps[1] * right[1]

    def along(self, q: Sequence[float], v: Sequence[float], strips: Both) -> Pair:
        """Forces (N) of the layers along the joints, against the slips."""
        wall, e, found = self.wall, self.effects, []
        for k, ratio, b, stiffness, damping, strip_ in (
            (4, e.shear_base, wall.base_half_width, wall.base_stiffness, wall.base_damping, strips[0]),
            (5, e.shear_top, wall.top_half_width, wall.top_stiffness, wall.top_damping, strips[1]),
        ):
            held = ratio if math.isfinite(ratio) else 0.0
            sheared = 2.0 * b * strip_.share * (stiffness * q[k] + damping * v[k]) - stiffness * strip_.landed
            found.append(held * sheared)
        return found[0], found[1]

    def couple(self, q: Sequence[float], v: Sequence[float]) -> float:
        """Couple (N m) on the wall against its rotation, without dry friction."""
        e = self.effects
        over = max(abs(q[0]) - e.couple_gap, 0.0)
        return float(e.couple_stiffness * math.copysign(over, q[0]) + e.couple_damping * v[0])

    def in_table(self, at: Chain, q: Sequence[float], v: Sequence[float], a: float) -> tuple[float, float, float]:
        """Couples (N m) in the base and the top joint, and force (N) on the block, of a law in a table."""
        if self.law is None:
            return 0.0, 0.0, 0.0
        moving = float((at.jacobians[2].real @ np.asarray(v)).item())
        block = float(at.places[2].real), moving
        return self.law.forces((q[0], v[0]), (q[1] - q[6], v[1] - v[6]), block, a)

    def equations(
        self, q: Sequence[float], v: Sequence[float], ground: Ground, strips: Both
    ) -> tuple[FloatArray, FloatArray]:
        """M (k, k) and Q - n (k,) of the free coordinates, without dry friction."""
        wall, e = self.wall, self.effects
        at = chain(wall, np.asarray(q), np.asarray(v))
        pull, pitching = self.weights * (at.bias + _frame(at.places, ground)), ground[2]
        left = -(np.conj(at.jacobians) * pull[:, None]).real.sum(axis=0) - pitching * self.inertias @ ROTATIONS
        base, top = strips
        couple = top.moment * math.cos(q[1] - q[6])
        shear = self.along(q, v, strips)
        bend = e.bending if math.isfinite(e.bending) else 0.0
        bending = bend * 2.0 / 3.0 * wall.base_stiffness * wall.base_half_width**3 * (q[6] - q[0])
        left += (
            bending - base.moment * math.cos(q[0]) - self.couple(q, v), -couple, base.force, top.force, -shear[0],
            -shear[1], couple - bending, -bend * 2.0 * wall.base_stiffness * wall.base_half_width * q[7],
        )  # fmt: skip
        if self.law is not None:
            base_couple, top_couple, push = self.in_table(at, q, v, ground[0])
            left += push * at.jacobians[2].real
            left += (base_couple, top_couple, 0.0, 0.0, 0.0, 0.0, -top_couple, 0.0)
        mass = self._mass(at.jacobians)
        return self.free.T @ mass @ self.free, self.free.T @ left

    def pulls(self, q: Sequence[float], v: Sequence[float], second: Sequence[float], ground: Ground) -> Sequence[Pair]:
        at = chain(self.wall, np.asarray(q), np.asarray(v))
        forces = self.weights * (at.jacobians @ np.asarray(second) + at.bias + _frame(at.places, ground))
        forces[2] -= self.in_table(at, q, v, ground[0])[2]
        return [(float(f.real), float(f.imag)) for f in forces]

    def leaning(self, q: Sequence[float], v: Sequence[float]) -> tuple[Pair, Pair]:
        at = chain(self.wall, np.asarray(q), np.asarray(v))
        share = self.weights / self.weights.sum()
        both = float(share @ at.places.real) - q[4], float(share @ (at.jacobians @ np.asarray(v)).real) - v[4]
        block = self.wall.centre_2 * math.tan(q[1]) + self.effects.top_offset
        return both, (block, v[1] - v[6])

    def _mass(self, jacobians: FloatArray) -> FloatArray:
        mass = (np.conj(jacobians.T) * self.weights) @ jacobians
        return np.asarray(mass.real + self.turning)

    # --- dry friction

    def _limit(self, k: int, strips: Both) -> float:
        return float(self.effects.dry_couple if k == COUPLE else self.effects.friction * max(strips[0].force, 0.0))

    def _solved(
        self, q: Sequence[float], v: Sequence[float], ground: Ground, strips: Both
    ) -> tuple[FloatArray, dict[int, float]]:
        """p'' and the friction forces."""
        mass, force = self.equations(q, v, ground, strips)
        held = [k for k in self.moving if self.moving[k] == 0.0]
        friction = {k: -s * self._limit(k, strips) for k, s in self.moving.items() if s != 0.0}
        for k, size in friction.items():
            force = force + size * self.free[k]
        if not held:
            return np.asarray(np.linalg.solve(mass, force), dtype=np.float64), friction
        rows = self.free[held]
        free = np.linalg.solve(mass, np.column_stack([force, rows.T]))
        holding = np.linalg.solve(rows @ free[:, 1:], -rows @ free[:, 0])
        friction |= dict(zip(held, holding.tolist(), strict=True))
        return free[:, 0] + free[:, 1:] @ holding, friction

    def accelerated(self, q: Sequence[float], v: Sequence[float], ground: Ground, strips: Both) -> FloatArray:
        return np.asarray(self.free @ self._solved(q, v, ground, strips)[0])

    def let_go(self, q: Sequence[float], v: Sequence[float], hidden: FloatArray, ground: Ground) -> None:
        for k, sign in self.moving.items():
            if sign == 0.0 and self._spare(k, q, v, hidden, ground) < 0.0:
                self.switched(f"go {k}", q, v, hidden, ground)

    def switches(self) -> list[Switch]:
        """The events that end the present discrete state."""
        found = [self._stop(k, sign) if sign != 0.0 else self._go(k) for k, sign in self.moving.items()]
        if self.effects.final_loss != 0.0:
            found.append(Switch("share", self._closing))
        return found

    @staticmethod
    def _stop(k: int, sign: float) -> Switch:
        """What moves comes to a stop."""
        return Switch(f"stop {k}", lambda q, v, hidden, ground: sign * v[k])

    def _go(self, k: int) -> Switch:
        """What is held gets away."""
        return Switch(f"go {k}", lambda q, v, hidden, ground: self._spare(k, q, v, hidden, ground))

    def _spare(self, k: int, q: Sequence[float], v: Sequence[float], hidden: FloatArray, ground: Ground) -> float:
        base, top, _ = self.strips(q, v, hidden)
        friction = self._solved(q, v, ground, (base, top))[1]
        return self._limit(k, (base, top)) - abs(friction[k])

    def _closing(self, q: Sequence[float], v: Sequence[float], hidden: FloatArray, _: Ground) -> float:
        share = self.strips(q, v, hidden)[0].share
        return CLOSED - share if self.opened else share - OPENED

    def switched(
        self, name: str, q: Sequence[float], v: Sequence[float], hidden: FloatArray, ground: Ground
    ) -> None:  # fmt: skip
        if name == "share":
            self.closings += self.opened
            self.opened = not self.opened
            return
        k = int(name.split()[1])
        self.moving[k] = 0.0
        base, top, _ = self.strips(q, v, hidden)
        friction = self._solved(q, v, ground, (base, top))[1][k]
        if name.startswith("go") or abs(friction) > self._limit(k, (base, top)):
            self.moving[k] = -math.copysign(1.0, friction)

    # --- energies

    def kinetic(self, q: Sequence[float], v: Sequence[float]) -> float:
        rate = np.asarray(v)
        return float(0.5 * rate @ self._mass(chain(self.wall, np.asarray(q), rate).jacobians) @ rate)

    def stored(self, q: Sequence[float], hidden: FloatArray) -> Pair:
        laws = {joint: fibres.parted(hidden[self.parts[joint]]) for joint, fibres in self.fibres.items()}
        memory = [np.array([self.closings]), *hidden[self.laws : self.landed, None]]
        landed = hidden[self.landed :].reshape(1, 2, CELLS) if self.shears else np.zeros((1, 2, CELLS))
        found = stored(self.lanes, np.asarray(q)[None], memory, landed, laws)[0]
        return float(found[0]), float(found[1])

    def power(
        self, strips: Both, q: Sequence[float], v: Sequence[float], ground: Ground
    ) -> Pair:  # fmt: skip
        """Power (W) of each joint on the bodies: across, along, couples and friction."""
        base, top = strips
        shear = self.along(q, v, strips)
        friction = self._solved(q, v, ground, strips)[1] if self.moving else {}
        turn, rate = q[1] - q[6], v[1] - v[6]
        dry = sum(size * v[k] for k, size in friction.items())
        return (
            base.force * v[2] - (base.moment * math.cos(q[0]) + self.couple(q, v)) * v[0] - shear[0] * v[4] + dry,
            top.force * v[3] - top.moment * math.cos(turn) * rate - shear[1] * v[5],
        )


def _frame(places: FloatArray, ground: Ground) -> FloatArray:
    """Acceleration (m s-2) of the turning base and gravity at places x + i z: a clockwise turn is a factor -i."""
    a, gravity, pitching = ground
    return np.asarray(a + 1j * gravity - 1j * pitching * places)


def _mixed(share: float, exact: Strip, frozen: tuple[float, float]) -> Strip:
    force, moment = ((1.0 - share) * one + share * other for one, other in zip(exact[:2], frozen, strict=True))
    return exact._replace(force=force, moment=moment)
