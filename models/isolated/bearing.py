"""The force of bearings in shear: the rubber laws in both ways, the Payne effect, wear by cycles.

    F_1 = w(n) { k u + sum of the laws' additions - k s(A) u } + c u'
    s(A) = softening (1 - exp(-A/(strain e)))        Payne, A = |u| at the last reversal, or |u| if larger
    w(n) = 1 - final_loss (1 - exp(-n/cycles))       wear, n full cycles of u (zero crossings over two)

The laws of `models.rubber` are taken as odd in u: Mullins's sees |u|. A reversal at a smaller |u| than the
last one raises the Payne stiffness at once, as the amplitude of the new cycle is then known to be smaller.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from models.base import FloatArray
from models.isolated.chain import Chain
from models.rubber.base import Numbers, RubberLaw


@dataclass(frozen=True)
class Memory:
    """What the rubber remembers: ``hidden``, one array for each of the chain's rubber laws (zeros where
    a law has no memory), ``amplitude`` A (m) and ``crossings`` of u = 0; arrays that broadcast."""

    hidden: tuple[FloatArray, ...]
    amplitude: FloatArray
    crossings: FloatArray


def relaxed(chain: Chain, u: FloatArray) -> Memory:
    """After an infinitely long rest at ``u``."""
    size, side = np.abs(u), np.sign(u)
    signed = {law.name: law.relaxed(size, p) * (1.0 if law.name == "mullins" else side) for law, p in chain.rubber_laws}
    return Memory(tuple(signed[law.name] for law, _ in chain.rubber_laws), size, np.zeros_like(u))


def _addition(law: RubberLaw, p: Numbers, u: FloatArray, h: FloatArray) -> FloatArray:
    if law.name == "mullins":
        return np.asarray(np.sign(u) * law.extra(np.abs(u), h, p))
    return law.extra(u, h, p)


def rates(chain: Chain, u: FloatArray, u_rate: FloatArray, hidden: Sequence[FloatArray]) -> list[FloatArray]:
    """Rates of the hidden states (per s)."""
    return [
        law.rate(np.abs(u), np.sign(u) * u_rate, h, p) if law.name == "mullins" else law.rate(u, u_rate, h, p)
        for (law, p), h in zip(chain.rubber_laws, hidden, strict=True)
    ]


def payne_loss(chain: Chain, amplitude: FloatArray) -> FloatArray:
    """Share of k that is lost at the amplitude A (m)."""
    p = chain.numbers("payne")
    if p is None:
        return np.zeros_like(amplitude)
    return np.asarray(-p["softening"] * np.expm1(-amplitude / (p["strain"] * p["thickness"])))


def wear(chain: Chain, crossings: FloatArray) -> FloatArray:
    """Factor on the bearings' springs after ``crossings`` of u = 0."""
    p = chain.numbers("degradation")
    if p is None:
        return np.ones_like(crossings)
    return np.asarray(1.0 + p["final_loss"] * np.expm1(-np.floor(crossings / 2.0) / p["cycles"]))


def spring_force(chain: Chain, u: FloatArray, memory: Memory) -> FloatArray:
    """Force (N) of the bearings without their dashpot."""
    whole = chain.stiffness * u * (1.0 - payne_loss(chain, np.maximum(memory.amplitude, np.abs(u))))
    for (law, p), h in zip(chain.rubber_laws, memory.hidden, strict=True):
        whole = whole + _addition(law, p, u, h)
    return np.asarray(wear(chain, memory.crossings) * whole)


def stored(chain: Chain, u: FloatArray, memory: Memory) -> FloatArray:
    """Energy (J) that the springs of the bearings would give back now.

    k u^2/2 less its share lost by Payne's effect, and what each law stores beyond it, even in u; all times the wear.
    """
    loss = payne_loss(chain, np.maximum(memory.amplitude, np.abs(u)))
    energy = 0.5 * chain.stiffness * u**2 * (1.0 - loss)
    for (law, p), h in zip(chain.rubber_laws, memory.hidden, strict=True):
        energy = energy + law.energy(np.abs(u), h, p)
    return np.asarray(wear(chain, memory.crossings) * energy)
