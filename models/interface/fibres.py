"""Laws with history along a strip: what they add to the exact linear strip, at 16 Gauss points.

At every fibre the difference between the law's stress and the linear one, both clipped as the strip is,
is integrated; the linear part stays exact. The reference integrates the hidden states with the motion.

Stored energy: that of the laws, psi(u, h), which their springs' stress s = psi_u gives back on unloading. A
fibre that is clipped cannot pull: its rubber lets go and rests where it carries nothing, so that under dashpot
law B psi - min(s, 0)^2/(2 K) is stored, K the slope of s on unloading. Its change never exceeds the work done.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from models.base import FloatArray
from models.interface.layered import LayeredWall
from models.rubber.base import Laws, Numbers, RubberLaw

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)


class Fibres:
    """The fibres of one joint of one wall (of one lane)."""

    def __init__(self, wall: LayeredWall, joint: str) -> None:
        one, base = wall.one(), joint == "base"
        self.b = one.base_half_width if base else one.top_half_width
        self.k = one.base_stiffness if base else one.top_stiffness
        self.c = one.base_damping if base else one.top_damping
        self.clip = wall.clip
        self.laws: Laws = [(law, {n: np.asarray(v[0]) for n, v in p.items()}) for law, p in wall.laws_at(joint)]
        self.x = self.b * NODES

    @property
    def size(self) -> int:
        """Numbers in the hidden state: 16 for each law that has one."""
        return 16 * sum(law.hidden for law, _ in self.laws)

    def relaxed(self, compression: float, z: float = 0.0, angle: float = 0.0) -> FloatArray:
        """The hidden state after a long rest at ``compression`` (m) everywhere, let go at ``z``, ``angle``.

        Of the place where it is let go only the largest compression is known.
        """
        u = np.full(16, compression)
        begun = np.maximum(self.x * math.sin(angle) - z, u)
        kept = [law.relaxed(begun if law.name == "mullins" else u, p) for law, p in self.laws if law.hidden]
        return np.concatenate(kept) if kept else np.zeros(0)

    def _with_states(self, u: FloatArray, state: FloatArray) -> Iterator[tuple[RubberLaw, Numbers, FloatArray]]:
        """Every law, its numbers and its hidden states along the fibres."""
        position = 0
        for law, p in self.laws:
            yield law, p, state[position : position + 16] if law.hidden else u
            position += 16 * law.hidden

    def energy(self, z: float, angle: float, state: FloatArray) -> float:
        """Stored (J) beyond the springs of the linear strip."""
        u = np.maximum(self.x * math.sin(angle) - z, 0.0)
        more, stress, slope = np.zeros(16), self.k * u, self.k + np.zeros(16)
        for law, p, h in self._with_states(u, state):
            more += law.energy(u, h, p)
            stress += law.extra(u, h, p)
            slope += law.tangent(u, h, p)
        if self.clip:
            more -= np.minimum(stress, 0.0) ** 2 / (2.0 * slope)
        total: float = self.b * (WEIGHTS @ more)
        return total

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
        total, rates = linear.copy(), []
        for law, p, h in self._with_states(u, state):
            total += law.extra(u, h, p)
            if law.hidden:
                rates.append(law.rate(u, u_rate, h, p))
        if self.clip:
            total, linear = np.maximum(total, 0.0), np.maximum(linear, 0.0)
        stress = np.where(pressed, total - linear, 0.0)
        force = self.b * float(WEIGHTS @ stress)
        moment = self.b * float(WEIGHTS @ (stress * self.x))
        return force, moment, np.concatenate(rates) if rates else np.zeros(0)
