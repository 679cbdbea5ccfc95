"""The full nonlinear equations of a wall between two layers, one wall at a time (Lagrange).

q = (theta1, theta2, z1, z2), r = theta2 - theta1, l = 2 h1 + e_t + z2, Rot(t)(x, z) = (x cos t + z sin t,
-x sin t + z cos t). The mass centres, in the ground frame:

    X1 = sign(theta1) b1 (1 - cos theta1),  Xr = sign(r) bt (1 - cos r)     toe-held (0: midpoint-held)
    G1 = (X1, z1) + Rot(theta1)(0, h1),     G2 = (X1, z1) + Rot(theta1)(Xr, l) + Rot(theta2)(0, h2)

With J_i = dG_i/dq:  M = sum m_i J_i^T J_i + diag(I1, I2, 0, 0),  n = sum m_i J_i^T (J_i' q' + (a, G)),
M q'' + n = Q,  Q = (-Mb cos theta1 + Mt cos r, -Mt cos r, Nb, Nt).
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from models.base import FloatArray
from models.interface.fibres import Fibres
from models.interface.layered import FREE, LayeredWall
from models.interface.modes import static_state
from models.interface.strip import Strip, stored, strip

NONE = Strip(0.0, 0.0, 1.0)
"""A bonded joint: it transmits whatever it must, its contact is full."""


Pair = tuple[float, float]
Four = tuple[float, float, float, float]
Both = tuple[Strip, Strip]
Ground = tuple[float, float, float]
"""a - G psi, G (m s-2) and psi'' (rad s-2) of the base; only walls with effects know a base that pitches by psi."""


class Switch(NamedTuple):
    """An event: ``value(q, q', hidden, ground)`` falls through zero."""

    name: str
    value: Callable[[Sequence[float], Sequence[float], FloatArray, Ground], float]


class Kinematics(NamedTuple):
    """G1, G2 (m), the rows (x, z) of J_i, and J_i' q', at one state."""

    centre_1: Pair
    centre_2: Pair
    jacobian_1: tuple[Four, Four]
    jacobian_2: tuple[Four, Four]
    bias_1: Pair
    bias_2: Pair


class Equation:
    """One wall (of one lane): kinematics, strips, accelerations, energies."""

    size = 4
    """Coordinates of q."""

    def __init__(self, wall: LayeredWall) -> None:
        self.wall = wall.one()
        self.free = FREE[wall.joints]
        self.fibres = {joint: Fibres(wall, joint) for joint in wall.rubber_joints if wall.laws_at(joint)}
        self.parts: dict[str, slice] = {}
        self.hidden = 0
        """Numbers in the laws' hidden state, and each joint's part of them."""
        for joint, fibres in self.fibres.items():
            self.parts[joint] = slice(self.hidden, self.hidden + fibres.size)
            self.hidden += fibres.size
        self.rest = static_state(wall)

    def kinematics(self, q: Sequence[float], v: Sequence[float]) -> Kinematics:
        t1, t2, z1, z2 = q
        w1, w2, _, z2_rate = v
        wall = self.wall
        h1, h2 = wall.centre_1, wall.centre_2
        s1, c1, s2, c2 = math.sin(t1), math.cos(t1), math.sin(t2), math.cos(t2)
        turn, turn_rate = t2 - t1, w2 - w1
        height = wall.height_1 + wall.top_thickness_in_height + z2
        b1 = math.copysign(wall.base_half_width, t1) if wall.toe_held else 0.0
        bt = math.copysign(wall.top_half_width, turn) if wall.toe_held else 0.0
        x1, x1_d, x1_dd = b1 * (1.0 - c1), b1 * s1, b1 * c1
        sr, cr = math.sin(turn), math.cos(turn)
        xr, xr_d, xr_dd = bt * (1.0 - cr), bt * sr, bt * cr
        jacobian_1 = ((x1_d + h1 * c1, 0.0, 0.0, 0.0), (-h1 * s1, 0.0, 1.0, 0.0))
        jacobian_2 = (
            (x1_d + (height - xr_d) * c1 - xr * s1, xr_d * c1 + h2 * c2, 0.0, s1),
            (-(height - xr_d) * s1 - xr * c1, -xr_d * s1 - h2 * s2, 1.0, c1),
        )
        bias_1 = ((x1_dd - h1 * s1) * w1 * w1, -h1 * c1 * w1 * w1)
        along = xr_dd * turn_rate**2 + 2.0 * w1 * z2_rate - w1 * w1 * xr
        across = -2.0 * w1 * xr_d * turn_rate - w1 * w1 * height
        bias_2 = (
            x1_dd * w1 * w1 + along * c1 + across * s1 - h2 * s2 * w2 * w2,
            -along * s1 + across * c1 - h2 * c2 * w2 * w2,
        )
        centre_1 = (x1 + h1 * s1, z1 + h1 * c1)
        centre_2 = (x1 + xr * c1 + height * s1 + h2 * s2, z1 - xr * s1 + height * c1 + h2 * c2)
        return Kinematics(centre_1, centre_2, jacobian_1, jacobian_2, bias_1, bias_2)

    def strips(self, q: Sequence[float], v: Sequence[float], hidden: FloatArray) -> tuple[Strip, Strip, FloatArray]:
        """Base and top, and the rate of the laws' ``hidden`` state; a bonded joint carries no strip."""
        t1, t2, z1, z2 = q
        w1, w2, z1_rate, z2_rate = v
        wall, turn = self.wall, t2 - t1
        base = top = NONE
        if wall.joints != "top":
            base = strip(
                wall.base_half_width, wall.base_stiffness, wall.base_damping, z1, math.sin(t1), z1_rate,
                math.cos(t1) * w1, wall.clip,
            )  # fmt: skip
        if wall.joints != "base":
            top = strip(
                wall.top_half_width, wall.top_stiffness, wall.top_damping, z2, math.sin(turn), z2_rate,
                math.cos(turn) * (w2 - w1), wall.clip,
            )  # fmt: skip
        rates = np.zeros_like(hidden)
        for joint, part in self.parts.items():
            which, motion = (0, (z1, t1, z1_rate, w1)) if joint == "base" else (1, (z2, turn, z2_rate, w2 - w1))
            fibres = self.fibres[joint]
            more = fibres.difference(motion, fibres.parted(hidden[part]))
            rates[part] = fibres.joined(more.rates)
            linear = top if which else base
            linear = linear._replace(force=linear.force + more.force.item(), moment=linear.moment + more.moment.item())
            base, top = (base, linear) if which else (linear, top)
        return base, top, rates

    def stored(self, q: Sequence[float], hidden: FloatArray) -> Pair:
        """Energy (J) in the springs of each layer's law; 0 where bonded."""
        wall, found = self.wall, [0.0, 0.0]
        for k, (joint, z, angle) in enumerate((("base", q[2], q[0]), ("top", q[3], q[1] - q[0]))):
            if wall.joints not in ("both", joint):
                continue
            b = wall.base_half_width if joint == "base" else wall.top_half_width
            stiffness = wall.base_stiffness if joint == "base" else wall.top_stiffness
            found[k] = stored(b, stiffness, np.asarray(z), np.sin(angle)).item()
            if joint in self.fibres:
                fibres = self.fibres[joint]
                more = fibres.energy(np.array([z]), np.array([angle]), fibres.parted(hidden[self.parts[joint]]))
                found[k] += more.item()
        return found[0], found[1]

    def relaxed(self, q: Sequence[float] = (0.0,) * 4) -> FloatArray:
        """The laws' hidden state after a long rest under gravity, let go at ``q`` (what it becomes there at once)."""
        found = np.zeros(self.hidden)
        for joint, fibres in self.fibres.items():
            z, angle = (np.array([value]) for value in self.at_joint(joint, q))
            still = fibres.relaxed(*(np.array([value]) for value in self.at_joint(joint, self.rest[0].tolist())))
            found[self.parts[joint]] = fibres.joined(fibres.layer.reached(fibres.compression(z, angle), still))
        return found

    @staticmethod
    def at_joint(joint: str, q: Sequence[float]) -> Pair:
        """z and the angle of a joint at q, or their rates at q'."""
        return (q[2], q[0]) if joint == "base" else (q[3], q[1] - q[0])

    def begun(self, q: Sequence[float], v: Sequence[float], memory: Mapping[str, float]) -> FloatArray:
        """The hidden state of a run that begins at q, q'; ``memory``: what else it starts from."""
        return self.relaxed(q)

    def let_go(self, q: Sequence[float], v: Sequence[float], hidden: FloatArray, ground: Ground) -> None:
        """Before a piece of the ground's motion, which may begin with a jump: what nothing holds any more moves."""

    def switches(self) -> Sequence[Switch]:
        """Events at which the equations change; none of a plain wall."""
        return ()

    def switched(
        self, name: str, q: Sequence[float], v: Sequence[float], hidden: FloatArray, ground: Ground
    ) -> None:  # fmt: skip
        """After the event ``name``."""

    def mass(self, at: Kinematics) -> FloatArray:
        """M (4, 4)."""
        m1, m2 = self.wall.mass_1, self.wall.mass_2
        (x1, z1), (x2, z2) = at.jacobian_1, at.jacobian_2
        rows = [
            [m1 * (x1[i] * x1[j] + z1[i] * z1[j]) + m2 * (x2[i] * x2[j] + z2[i] * z2[j]) for j in range(4)]
            for i in range(4)
        ]
        rows[0][0] += self.wall.inertia_1
        rows[1][1] += self.wall.inertia_2
        return np.array(rows)

    def balance(
        self,
        q: Sequence[float],
        v: Sequence[float],
        a: float,
        gravity: float,
        strips: Both | None = None,
    ) -> tuple[FloatArray, FloatArray]:
        """M (4, 4) and Q - n (4,); ``strips``: as found already, else with relaxed laws."""
        at = self.kinematics(q, v)
        base, top = strips or self.strips(q, v, self.relaxed())[:2]
        m1, m2 = self.wall.mass_1, self.wall.mass_2
        (x1, z1), (x2, z2) = at.jacobian_1, at.jacobian_2
        along_1, up_1 = m1 * (at.bias_1[0] + a), m1 * (at.bias_1[1] + gravity)
        along_2, up_2 = m2 * (at.bias_2[0] + a), m2 * (at.bias_2[1] + gravity)
        couple = top.moment * math.cos(q[1] - q[0])
        forces = (-base.moment * math.cos(q[0]) + couple, -couple, base.force, top.force)
        left = [forces[i] - along_1 * x1[i] - up_1 * z1[i] - along_2 * x2[i] - up_2 * z2[i] for i in range(4)]
        return self.mass(at), np.array(left)

    def accelerated(self, q: Sequence[float], v: Sequence[float], ground: Ground, strips: Both) -> FloatArray:
        """q'', the bonded coordinates following the free ones."""
        return self.acceleration(q, v, *ground[:2], strips)

    def acceleration(
        self,
        q: Sequence[float],
        v: Sequence[float],
        a: float,
        gravity: float,
        strips: Both | None = None,
    ) -> FloatArray:
        """q'' (4,), the bonded coordinates following the free ones."""
        mass, force = self.balance(q, v, a, gravity, strips)
        if self.wall.joints == "both":
            return np.asarray(np.linalg.solve(mass, force), dtype=np.float64)
        free = self.free
        return np.asarray(free @ np.linalg.solve(free.T @ mass @ free, free.T @ force))

    def kinetic(self, q: Sequence[float], v: Sequence[float]) -> float:
        """J."""
        rate = np.asarray(v)
        return float(0.5 * rate @ self.mass(self.kinematics(q, v)) @ rate)

    def pulls(self, q: Sequence[float], v: Sequence[float], second: Sequence[float], ground: Ground) -> Sequence[Pair]:
        """Forces (N) along x and z that hold the wall and the block on their way under q''."""
        at, (a, gravity, _) = self.kinematics(q, v), ground
        found = []
        for mass, rows, bias in (
            (self.wall.mass_1, at.jacobian_1, at.bias_1),
            (self.wall.mass_2, at.jacobian_2, at.bias_2),
        ):
            x, z = (sum(map(operator.mul, row, second)) + b for row, b in zip(rows, bias, strict=True))
            found.append((mass * (x + a), mass * (z + gravity)))
        return found

    def leaning(self, q: Sequence[float], v: Sequence[float]) -> tuple[Pair, Pair]:
        """Of all that stands on the base, and of the block on its joint: mass centre from the middle (m), and its rate.

        The wall's along x, the block's along its own underside.
        """
        wall, at = self.wall, self.kinematics(q, v)
        rates = [sum(map(operator.mul, rows[0], v)) for rows in (at.jacobian_1, at.jacobian_2)]
        mass = wall.mass_1 + wall.mass_2
        both = (
            (wall.mass_1 * at.centre_1[0] + wall.mass_2 * at.centre_2[0]) / mass,
            (wall.mass_1 * rates[0] + wall.mass_2 * rates[1]) / mass,
        )
        return both, (wall.centre_2 * math.tan(q[1]), v[1] - v[0])

    def power(self, strips: Both, q: Sequence[float], v: Sequence[float], ground: Ground) -> Pair:
        """Power of each strip on the bodies, in W."""
        base, top = strips
        turn, rate = q[1] - q[0], v[1] - v[0]
        return (
            base.force * v[2] - base.moment * math.cos(q[0]) * v[0],
            top.force * v[3] - top.moment * math.cos(turn) * rate,
        )
