"""Laws with history along a strip: what they add to the exact linear strip, at 16 Gauss points.

At every fibre the difference between the law's stress and the linear one, both clipped as the strip is,
is integrated; the linear part stays exact. The reference integrates the hidden states with the motion.
"""

from __future__ import annotations

import math

import numpy as np

from models.base import FloatArray
from models.interface.layered import LayeredWall

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)


class Fibres:
    """The fibres of one joint of one wall (of one lane)."""

    def __init__(self, wall: LayeredWall, joint: str) -> None:
        one, base = wall.one(), joint == "base"
        self.b = one.base_half_width if base else one.top_half_width
        self.k = one.base_stiffness if base else one.top_stiffness
        self.c = one.base_damping if base else one.top_damping
        self.clip = wall.clip
        self.laws = [(law, {n: np.asarray(v[0]) for n, v in p.items()}) for law, p in wall.laws_at(joint)]
        self.x = self.b * NODES

    @property
    def size(self) -> int:
        """Numbers in the hidden state: 16 for each law that has one."""
        return 16 * sum(law.hidden for law, _ in self.laws)

    def relaxed(self, compression: float) -> FloatArray:
        """The hidden state after a long rest at ``compression`` (m) everywhere."""
        u = np.full(16, compression)
        kept = [law.relaxed(u, p) for law, p in self.laws if law.hidden]
        return np.concatenate(kept) if kept else np.zeros(0)

    def difference(
        self, z: float, angle: float, z_rate: float, angle_rate: float, state: FloatArray
    ) -> tuple[float, float, FloatArray]:
        """Force (N) and moment (N m) beyond the linear strip, and the rate of the hidden state."""
        s, s_rate = math.sin(angle), math.cos(angle) * angle_rate
        w = z - self.x * s
        pressed = w < 0.0
        u = np.where(pressed, -w, 0.0)
        u_rate = np.where(pressed, self.x * s_rate - z_rate, 0.0)
        linear = self.k * u + self.c * u_rate
        total, rates, position = linear.copy(), [], 0
        for law, p in self.laws:
            h = state[position : position + 16] if law.hidden else u
            total += law.extra(u, h, p)
            if law.hidden:
                rates.append(law.rate(u, u_rate, h, p))
                position += 16
        if self.clip:
            total, linear = np.maximum(total, 0.0), np.maximum(linear, 0.0)
        stress = np.where(pressed, total - linear, 0.0)
        force = self.b * float(WEIGHTS @ stress)
        moment = self.b * float(WEIGHTS @ (stress * self.x))
        return force, moment, np.concatenate(rates) if rates else np.zeros(0)
