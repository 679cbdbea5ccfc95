"""Laws with history along a strip: what they add to the exact linear strip, at 16 Gauss points.

At every fibre the difference between the law's stress and the linear one, both clipped as the strip is,
is integrated; the linear part stays exact. The reference integrates the hidden states with the motion.

Stored energy: that of the laws, psi(u, h), which their springs' stress s = psi_u gives back on unloading. A
fibre that is clipped cannot pull: its rubber lets go and rests where it carries nothing, so that under dashpot
law B psi - min(s, 0)^2/(2 K) is stored, K the slope of s on unloading. Its change never exceeds the work done.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from models.base import FloatArray
from models.interface.layered import LayeredWall
from models.rubber.layer import Hidden, Layer

COUNT = 16
NODES, WEIGHTS = np.polynomial.legendre.leggauss(COUNT)


class Difference(NamedTuple):
    """What the fibres add to the linear strip: force (N), moment (N m), arrays (n,); rates of the hidden states."""

    force: FloatArray
    moment: FloatArray
    rates: list[FloatArray]


class Fibres:
    """The fibres of one joint of n walls. Positions and angles are (n,), hidden states one (n, 16) for each law."""

    def __init__(self, wall: LayeredWall, joint: str) -> None:
        base = joint == "base"
        self.b = (wall.base_half_width if base else wall.top_half_width)[:, None]
        self.c = (wall.base_damping if base else wall.top_damping)[:, None]
        self.clip = wall.clip
        self.x = self.b * NODES
        sides = None if wall.effects is None or not base else (wall.effects.left, wall.effects.right)
        self.factor = 1.0 if sides is None else np.where(NODES < 0.0, sides[0][:, None], sides[1][:, None])
        layer = wall.layer(joint)
        self.laws = [(law, {name: values[:, None] for name, values in p.items()}) for law, p in layer.laws]
        self.layer = Layer(layer.stiffness[:, None], self.laws)

    def compression(self, z: FloatArray, angle: FloatArray) -> FloatArray:
        """u (n, 16) in m; 0 where open."""
        return np.maximum(self.x * np.sin(angle)[:, None] - z[:, None], 0.0)

    def relaxed(self, z: FloatArray, angle: FloatArray) -> list[FloatArray]:
        """The hidden states after a long rest at z, angle."""
        return self.layer.relaxed(self.compression(z, angle))

    def energy(self, z: FloatArray, angle: FloatArray, hidden: Hidden, wear: FloatArray | float = 1.0) -> FloatArray:
        """Stored (J) beyond the springs of the linear strip, (n,); ``wear``: factor on the layer's springs."""
        u = self.compression(z, angle)
        more = self.layer.energy(u, hidden) - 0.5 * self.layer.stiffness * u**2
        if self.clip:
            more -= np.minimum(self.layer.stress(u, hidden), 0.0) ** 2 / (2.0 * self.layer.slope(u, hidden))
        # fibre by fibre: a product of matrices adds in an order that depends on how many walls there are
        more = self.factor * more
        return np.asarray(wear * self.b[:, 0] * sum(more[:, f] * WEIGHTS[f] for f in range(COUNT)))

    def difference(self, motion: Sequence[Any], hidden: Hidden, wear: FloatArray | float = 1.0) -> Difference:
        """In a state of motion: z, angle, z', angle' of the joint, each (n,); ``wear``: factor on the springs."""
        z, angle, z_rate, angle_rate = (np.atleast_1d(value) for value in motion)
        turning = self.x * (np.cos(angle) * angle_rate)[:, None]
        u = self.compression(z, angle)
        pressed = u > 0.0
        u_rate = np.where(pressed, turning - z_rate[:, None], 0.0)
        factor = self.factor * np.asarray(wear).reshape(-1, 1)
        linear = factor * self.layer.stiffness * u + self.c * u_rate
        total = factor * self.layer.stress(u, hidden) + self.c * u_rate
        if self.clip:
            total, linear = np.maximum(total, 0.0), np.maximum(linear, 0.0)
        stress = np.where(pressed, total - linear, 0.0)
        b = self.b[:, 0]
        rates = self.layer.rates(u, u_rate, hidden)
        return Difference(b * (stress @ WEIGHTS), b * ((stress * self.x) @ WEIGHTS), rates)

    # --- one wall, its hidden states in one vector, for an integrator

    @property
    def size(self) -> int:
        """Numbers in the vector: 16 for each law that has a hidden state."""
        return COUNT * sum(law.hidden for law, _ in self.laws)

    def joined(self, hidden: Hidden) -> FloatArray:
        """The hidden states of one wall as a vector."""
        kept = [h[0] for (law, _), h in zip(self.laws, hidden, strict=True) if law.hidden]
        return np.concatenate(kept) if kept else np.zeros(0)

    def parted(self, vector: FloatArray) -> list[FloatArray]:
        """The hidden states (1, 16) by law from their vector."""
        parts = iter(vector.reshape(-1, 1, COUNT))
        return [next(parts) if law.hidden else np.zeros((1, COUNT)) for law, _ in self.laws]
