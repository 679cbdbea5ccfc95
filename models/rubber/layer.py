"""The laws of one layer together: stress, slope, energy and hidden states of rubber at a compression.

    s = m(h) [k u_e + sum of s_j(u_e, h_j)],   psi = m(h) [k u_e^2/2 + sum of psi_j(u_e, h_j)],   u_e = u - u_p(h)

u_e is what laws that shift leave of u, m the product of what softens. What softens multiplies all that the others
carry: taken off k instead, it could exceed what a law such as Bouc-Wen's has left of it. As m falls only and psi
is not negative, no combination gives more energy than it has taken, but for a set that grows while the others pull
(`models.rubber.permanent_set`). A dashpot stands outside.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from models.base import FloatArray
from models.rubber.base import Numbers, Role, RubberLaw

ROUNDS, CLOSE = 60, 2.0 * np.finfo(float).eps
"""Of the search for a compression: rounds at most, and the share of it at which it ends."""
Hidden = Sequence[FloatArray]
"""The hidden states of a layer's laws, one array for each of them, whether it has one or not."""


@dataclass(frozen=True)
class Layer:
    """``stiffness`` k, per metre of contact (N m-2) or of a whole bearing (N m-1), and laws with their numbers.

    Compressions u and hidden states are arrays that broadcast against the numbers.
    """

    stiffness: FloatArray
    laws: Sequence[tuple[RubberLaw, Numbers]]

    def _of(self, role: Role, u: FloatArray, hidden: Hidden) -> list[FloatArray]:
        """The effects of the laws of one role."""
        return [
            law.effect(u, h, p) for (law, p), h in zip(self.laws, hidden, strict=True) if law.role == role
        ]  # fmt: skip

    def elastic(self, u: FloatArray, hidden: Hidden) -> FloatArray:
        """u_e (m)."""
        return np.asarray(u - sum(self._of("shifts", u, hidden)))

    def softening(self, u: FloatArray, hidden: Hidden) -> FloatArray:
        """m."""
        kept = np.ones_like(u)
        for lost in self._of("softens", self.elastic(u, hidden), hidden):
            kept = kept * (1.0 - lost)
        return kept

    def stress(self, u: FloatArray, hidden: Hidden) -> FloatArray:
        """s, without a dashpot."""
        e = self.elastic(u, hidden)
        return self.softening(u, hidden) * (self.stiffness * e + sum(self._of("adds", e, hidden)))

    def slope(self, u: FloatArray, hidden: Hidden) -> FloatArray:
        """ds/du on unloading, what has flowed held."""
        e = self.elastic(u, hidden)
        return self.softening(u, hidden) * (
            self.stiffness + sum(law.slope(e, h, p) for (law, p), h in zip(self.laws, hidden, strict=True))
        )

    def energy(self, u: FloatArray, hidden: Hidden) -> FloatArray:
        """psi: stored, per metre of contact and of width, or of a whole bearing."""
        e = self.elastic(u, hidden)
        more = sum(law.energy(e, h, p) for (law, p), h in zip(self.laws, hidden, strict=True))
        return self.softening(u, hidden) * (0.5 * self.stiffness * e**2 + more)

    def rates(self, u: FloatArray, u_rate: FloatArray, hidden: Hidden) -> list[FloatArray]:
        """h' (per s), zeros of a law without h."""
        shifted = {
            k: law.rate(u, u_rate, h, p)
            for k, ((law, p), h) in enumerate(zip(self.laws, hidden, strict=True))
            if law.role == "shifts"
        }
        e, e_rate = self.elastic(u, hidden), np.asarray(u_rate - sum(shifted.values()))
        return [
            shifted[k] if k in shifted else law.rate(e, e_rate, h, p)
            for k, ((law, p), h) in enumerate(zip(self.laws, hidden, strict=True))
        ]

    def reached(self, u: FloatArray, hidden: Hidden) -> list[FloatArray]:
        """What the hidden states become at once at u."""
        e = self.elastic(u, hidden)
        return [law.reached(e, h, p) for (law, p), h in zip(self.laws, hidden, strict=True)]

    def relaxed(self, u: FloatArray) -> list[FloatArray]:
        """The hidden states after an infinitely long rest at u; no law that shifts has flowed there."""
        return [law.relaxed(u, p) for law, p in self.laws]

    def static_compression(self, load: FloatArray, most: FloatArray) -> FloatArray:
        """u (m) at which the relaxed layer carries ``load``, up to ``most``; nan if it does not."""
        return _reaching(load, lambda u: self.stress(u, self.relaxed(u)), most)

    def edge_at_uplift(self, load: FloatArray, rest: FloatArray) -> FloatArray:
        """Compression (m) of the far edge of a strip turned slowly, from ``rest``, until its freer end is at zero.

        It runs linearly from 0 to the edge then, and its stress, clipped at zero, carries ``load`` (N m-1) on
        the mean. Every fibre is taken straight from ``rest``; a permanent set has not begun to flow.
        """
        nodes, weights = np.polynomial.legendre.leggauss(16)

        def mean(edge: FloatArray) -> FloatArray:
            u = 0.5 * (1.0 + nodes[:, None]) * edge
            hidden = [law.turned(u, rest + 0.0 * u, p) for law, p in self.laws]
            return np.asarray(0.5 * weights @ np.maximum(self.stress(u, hidden), 0.0))

        return _reaching(load, mean, 8.0 * rest)


def _reaching(load: FloatArray, carried: Callable[[FloatArray], FloatArray], most: FloatArray) -> FloatArray:
    """u up to ``most`` at which a growing ``carried(u)`` reaches ``load``; nan where it does not.

    By T. R. Chandrupatla's rule (Advances in Engineering Software 28, 1997): inverse quadratic interpolation where it
    holds, halves elsewhere. c, fc: the end of the bracket [a, b] that was left last.
    """
    a, b = np.asarray(most, dtype=np.float64).copy(), np.zeros_like(load)
    fa, fb = carried(a) - load, -np.asarray(load, dtype=np.float64)
    held, share = fa >= 0.0, np.full_like(b, 0.5)
    for _ in range(ROUNDS):
        x = a + share * (b - a)
        fx = carried(x) - load
        beyond = (fx >= 0.0) == (fa >= 0.0)
        c, fc = np.where(beyond, a, b), np.where(beyond, fa, fb)
        b, fb = np.where(beyond, b, a), np.where(beyond, fb, fa)
        a, fa = x, fx
        width, least = np.abs(b - a), 2.0 * CLOSE * np.abs(a)
        if not np.any(held & (width > least) & (fa != 0.0)):
            break
        with np.errstate(divide="ignore", invalid="ignore"):
            inside, up = (a - b) / (c - b), (fa - fb) / (fc - fb)
            smooth = (up**2 < inside) & ((1.0 - up) ** 2 < 1.0 - inside)
            share = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
            edge = least / (2.0 * width)
        share = np.clip(np.where(smooth, share, 0.5), edge, 1.0 - edge)
    return np.where(held, np.where(np.abs(fa) <= np.abs(fb), a, b), np.nan)
