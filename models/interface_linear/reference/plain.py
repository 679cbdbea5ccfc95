"""One wall at a time: the equations of a configuration as they stand, for the plain reference.

M q'' = f - C q' - K q + D mu with N q'' = 0 for the joints that are held, solved as it stands.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from models.base import FloatArray
from models.interface.layered import FREE, LayeredWall
from models.interface.modes import layer_matrix
from models.interface.reference.account import Pair, Reading
from models.interface_linear import equation


@dataclass(frozen=True)
class Joint:
    """State of a joint: the side that presses (0: both), and whether it is held at the switch."""

    side: int = 0
    held: bool = False

    @property
    def half(self) -> int:
        """The side as the layer's matrices take it."""
        return 0 if self.held else self.side


Joints = tuple[Joint, Joint]


class Equation:
    """One wall: the equations of a configuration, what is watched in it, and what is read off a state."""

    def __init__(self, wall: LayeredWall) -> None:
        self.lanes, self.wall = wall, wall.one()
        self.free = FREE[wall.joints]
        self.loads = equation.loads(wall)[0]
        self.compression, self.sigma = (size[0] for size in equation.sizes(wall))
        self.laid = [joint for joint, name in enumerate(("base", "top")) if wall.joints in ("both", name)]
        self.width = [float(equation.half_width(wall, joint)[0]) for joint in (0, 1)]
        self.damping = (self.wall.base_damping, self.wall.top_damping)
        self.stiffness = (self.wall.base_stiffness, self.wall.top_stiffness)
        self.layers: dict[tuple[int, int], FloatArray] = {}
        self.known: dict[Joints, tuple[FloatArray, FloatArray, FloatArray]] = {}

    def matrices(self, joints: Joints) -> tuple[FloatArray, FloatArray, FloatArray]:
        if joints not in self.known:
            m, c, k = equation.matrices(self.lanes, (joints[0].half, joints[1].half))
            self.known[joints] = (m[0], c[0], k[0])
        return self.known[joints]

    def gap(self, joint: int, side: int) -> FloatArray:
        return np.asarray(equation.gap(self.lanes, joint, side)[0])

    def motion(self, joints: Joints, q: FloatArray, v: FloatArray, ground: Pair) -> tuple[FloatArray, dict[int, float]]:
        """q'' (4,) under a, G, and mu of the joints that are held."""
        mass, damping, stiffness = self.matrices(joints)
        held = [joint for joint in self.laid if joints[joint].held]
        normal = np.array([self.gap(joint, joints[joint].side) for joint in held]).reshape(-1, 4)
        push = np.array([equation.jump(self.lanes, joint, joints[joint].side)[0] for joint in held]).reshape(-1, 4)
        free, count = self.free, self.free.shape[1]
        left = np.zeros((count + len(held), count + len(held)))
        left[:count, :count] = free.T @ mass @ free
        left[:count, count:] = -free.T @ push.T
        left[count:, :count] = normal @ free
        force = self.loads @ ground - damping @ v - stiffness @ q
        found = np.linalg.solve(left, np.concatenate([free.T @ force, np.zeros(len(held))]))
        return free @ found[:count], dict(zip(held, found[count:].tolist(), strict=True))

    def watched(self, joints: Joints, joint: int, q: FloatArray, v: FloatArray, ground: Pair) -> Pair:
        """The two values of a joint that are negative as long as it stays in its state."""
        state = joints[joint]
        turn = q[1] - q[0] if joint else q[0]
        rate = v[1] - v[0] if joint else v[0]
        if state.side == 0:
            right, left = (float(self.gap(joint, side) @ q) / float(self.compression[joint]) for side in (1, -1))
            return right, left
        if not state.held:
            gap = self.gap(joint, state.side) @ q
            return -gap / self.compression[joint], -state.side * self.width[joint] * turn / self.compression[joint]
        mu = self.motion(joints, q, v, ground)[1][joint]
        sigma = state.side * (self.stiffness[joint] * turn + self.damping[joint] * rate)
        return -mu / self.sigma[joint], (mu - sigma) / self.sigma[joint]

    def power(self, joints: Joints, q: FloatArray, v: FloatArray, mu: dict[int, float]) -> Pair:
        """Power (W) of each layer on the bodies."""
        found = [0.0, 0.0]
        for joint in self.laid:
            layer = self._layer(joint, joints[joint].half)
            found[joint] = -float(v @ layer @ (self.stiffness[joint] * q + self.damping[joint] * v))
            if joint in mu:
                found[joint] += mu[joint] * float(equation.jump(self.lanes, joint, joints[joint].side)[0] @ v)
        return found[0], found[1]

    def stored(self, joints: Joints, q: FloatArray) -> Pair:
        """Elastic energy (J) of each layer."""
        base, top = (0.5 * self.stiffness[j] * float(q @ self._layer(j, joints[j].half) @ q) for j in (0, 1))
        return base, top

    def _layer(self, joint: int, side: int) -> FloatArray:
        """B (4, 4) of one layer for 1 per metre of contact."""
        if (joint, side) not in self.layers:
            one, none = np.ones(1), np.zeros(1)
            values = (one, none) if joint == 0 else (none, one)
            sides = (side, 0) if joint == 0 else (0, side)
            self.layers[joint, side] = layer_matrix(self.lanes, *values, sides)[0]
        return self.layers[joint, side]

    def read(self, joints: Joints, q: FloatArray, v: FloatArray, ground: Pair) -> Reading:
        """What the account of a run takes from a state."""
        wall, (a, gravity) = self.wall, ground
        second = self.motion(joints, q, v, ground)[0]
        lever = wall.height_1 + wall.top_thickness_in_height
        across = wall.mass_2 * (gravity + second[2] + second[3])
        along = wall.mass_2 * (a + lever * second[0] + wall.centre_2 * second[1])
        down = across + wall.mass_1 * (gravity + second[2])
        ratios = [abs(along + wall.mass_1 * (a + wall.centre_1 * second[0])), abs(along - q[0] * across)]
        normal = [down, across]
        shares = [1.0, 1.0]
        for joint in self.laid:
            apart = q[2 + joint] >= self.width[joint] * abs(q[1] - q[0] if joint else q[0])
            shares[joint] = 1.0 if joints[joint].side == 0 else 0.0 if apart else 0.5
            ratios[joint] = ratios[joint] / normal[joint] if normal[joint] > 0.0 else math.inf
        return Reading(
            rotations=(float(q[0]), float(q[1])),
            heights=(1.0 if joints[0].side else -1.0, 1.0 if joints[1].side else -1.0),
            friction=(ratios[0], ratios[1]),
            shares=(shares[0], shares[1]),
            edges=(
                self.width[0] * float(abs(q[0])) - float(q[2]),
                self.width[1] * float(abs(q[1] - q[0])) - float(q[3]),
            ),
            stored=self.stored(joints, q),
            kinetic=float(0.5 * v @ self.matrices(joints)[0] @ v),
        )

    def toppled(self, q: FloatArray, v: FloatArray) -> tuple[bool, bool]:
        """Whether the mass centre over each joint is past its toe and moves outwards."""
        wall = self.wall
        height = wall.height_1 + wall.top_thickness_in_height
        lever = np.array([wall.mass_1 * wall.centre_1 + wall.mass_2 * height, wall.mass_2 * wall.centre_2])
        side = math.copysign(1.0, q[0])
        toe = (wall.mass_1 + wall.mass_2) * wall.base_half_width
        base = 0 in self.laid and side * (lever @ q[:2]) > toe and side * (lever @ v[:2]) > 0.0
        side = math.copysign(1.0, q[1] - q[0])
        top = side * wall.centre_2 * q[1] > wall.top_half_width and side * (v[1] - v[0]) > 0.0
        return bool(base), bool(1 in self.laid and top)
