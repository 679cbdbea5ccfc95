"""The force of bearings in shear: the rubber laws in both ways, the Payne effect, wear by cycles.

    F_1 = w(n) s(A) layer(u) + c u',   layer(u) what the laws of `models.rubber` make of the spring k
    s(A) = 1 - softening (1 - exp(-A/(strain e)))    Payne, A = |u| at the last reversal, or |u| if larger
    w(n) = 1 - final_loss (1 - exp(-n/cycles))       wear, n full cycles of u (zero crossings over two)

A reversal at a smaller |u| than the last one raises the Payne stiffness at once, as the amplitude of the new cycle is
then known to be smaller.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from models.base import FloatArray
from models.isolated.chain import Chain


@dataclass(frozen=True)
class Memory:
    """What the rubber remembers: ``hidden``, one array for each of the chain's rubber laws (zeros where
    a law has no memory), ``amplitude`` A (m) and ``crossings`` of u = 0; arrays that broadcast."""

    hidden: Sequence[FloatArray]
    amplitude: FloatArray
    crossings: FloatArray


def relaxed(chain: Chain, u: FloatArray) -> Memory:
    """After an infinitely long rest at ``u``."""
    return Memory(chain.layer.relaxed(u), np.abs(u), np.zeros_like(u))


def payne_factor(chain: Chain, amplitude: FloatArray) -> FloatArray:
    """Factor on the bearings' springs at the amplitude A (m)."""
    p = chain.numbers("payne")
    if p is None:
        return np.ones_like(amplitude)
    return np.asarray(1.0 + p["softening"] * np.expm1(-amplitude / (p["strain"] * p["thickness"])))


def wear(chain: Chain, crossings: FloatArray) -> FloatArray:
    """Factor on the bearings' springs after ``crossings`` of u = 0."""
    p = chain.numbers("degradation")
    if p is None:
        return np.ones_like(crossings)
    return np.asarray(1.0 + p["final_loss"] * np.expm1(-np.floor(crossings / 2.0) / p["cycles"]))


def softening(chain: Chain, u: FloatArray, memory: Memory) -> FloatArray:
    """Both factors."""
    return wear(chain, memory.crossings) * payne_factor(chain, np.maximum(memory.amplitude, np.abs(u)))


def spring_force(chain: Chain, u: FloatArray, memory: Memory) -> FloatArray:
    """Force (N) of the bearings without their dashpot."""
    return softening(chain, u, memory) * chain.layer.stress(u, memory.hidden)


def stored(chain: Chain, u: FloatArray, memory: Memory) -> FloatArray:
    """Energy (J) that the springs of the bearings would give back now."""
    return softening(chain, u, memory) * chain.layer.energy(u, memory.hidden)
