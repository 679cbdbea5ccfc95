"""What a rubber law is: its addition to the linear stress, and a hidden state of its own."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from models.base import FloatArray

Numbers = Mapping[str, FloatArray]
"""A law's parameters by name, and ``stiffness`` k (N m-2), ``thickness`` e (m); arrays that broadcast."""


@dataclass(frozen=True)
class RubberLaw:
    """Functions of arrays that broadcast: u compression (m), h hidden state, p `Numbers`.

    ``extra(u, h, p)``: stress beyond k u + c u' (N m-1). ``rate(u, u', h, p)``: h' (per s).
    ``relaxed(u, p)``: h after an infinitely long rest at u. ``hidden``: whether there is an h.
    ``parameters``: names of the mechanism's parameters, which has the law's name.
    """

    name: str
    parameters: tuple[str, ...]
    extra: Callable[[FloatArray, FloatArray, Numbers], FloatArray]
    rate: Callable[[FloatArray, FloatArray, FloatArray, Numbers], FloatArray]
    relaxed: Callable[[FloatArray, Numbers], FloatArray]
    hidden: bool = True


def static_compression(
    load: FloatArray, laws: Sequence[tuple[RubberLaw, Numbers]], stiffness: FloatArray, most: FloatArray
) -> FloatArray:
    """u (m) at which the relaxed laws carry ``load`` (N m-1), by bisection up to ``most``; nan if they do not."""
    low, high = np.zeros_like(load), np.asarray(most, dtype=np.float64).copy()

    def carried(u: FloatArray) -> FloatArray:
        return np.asarray(stiffness * u + sum(law.extra(u, law.relaxed(u, p), p) for law, p in laws))

    held = carried(high) >= load
    for _ in range(60):
        middle = 0.5 * (low + high)
        short = carried(middle) < load
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    return np.where(held, 0.5 * (low + high), np.nan)
