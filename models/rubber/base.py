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
    ``tangent(u, h, p)``: slope of ``extra`` over u on unloading (N m-2), what has flowed held.
    ``energy(u, h, p)``: stored beyond k u^2/2 (J m-2); no change of it exceeds the work of ``extra``.
    ``turned(u, rest, p)``: h after moving slowly from a long rest at ``rest`` to u.
    ``parameters``: names of the mechanism's parameters, which has the law's name.
    """

    name: str
    parameters: tuple[str, ...]
    extra: Callable[[FloatArray, FloatArray, Numbers], FloatArray]
    rate: Callable[[FloatArray, FloatArray, FloatArray, Numbers], FloatArray]
    relaxed: Callable[[FloatArray, Numbers], FloatArray]
    tangent: Callable[[FloatArray, FloatArray, Numbers], FloatArray]
    energy: Callable[[FloatArray, FloatArray, Numbers], FloatArray]
    turned: Callable[[FloatArray, FloatArray, Numbers], FloatArray]
    hidden: bool = True


Laws = Sequence[tuple[RubberLaw, Numbers]]


def static_compression(load: FloatArray, laws: Laws, stiffness: FloatArray, most: FloatArray) -> FloatArray:
    """u (m) at which the relaxed laws carry ``load`` (N m-1), by bisection up to ``most``; nan if they do not."""

    def carried(u: FloatArray) -> FloatArray:
        return np.asarray(stiffness * u + sum(law.extra(u, law.relaxed(u, p), p) for law, p in laws))

    return _reaching(load, carried, most)


def edge_at_uplift(load: FloatArray, laws: Laws, stiffness: FloatArray, rest: FloatArray) -> FloatArray:
    """Compression (m) of the far edge of a strip turned slowly, from ``rest``, until its freer end is at zero.

    It runs linearly from 0 to the edge then, and its stress, clipped at zero, carries ``load`` (N m-1) on
    the mean. Every fibre is taken straight from ``rest``; a permanent set has not begun to flow.
    """
    nodes, weights = np.polynomial.legendre.leggauss(16)

    def mean(edge: FloatArray) -> FloatArray:
        u = 0.5 * (1.0 + nodes[:, None]) * edge
        more = sum(law.extra(u, law.turned(u, rest + 0.0 * u, p), p) for law, p in laws)
        return np.asarray(0.5 * weights @ np.maximum(stiffness * u + more, 0.0))

    return _reaching(load, mean, 8.0 * rest)


def _reaching(load: FloatArray, carried: Callable[[FloatArray], FloatArray], most: FloatArray) -> FloatArray:
    """u up to ``most`` at which a growing ``carried(u)`` reaches ``load``; nan where it does not."""
    low, high = np.zeros_like(load), np.asarray(most, dtype=np.float64).copy()
    held = carried(high) >= load
    for _ in range(60):
        middle = 0.5 * (low + high)
        short = carried(middle) < load
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    return np.where(held, 0.5 * (low + high), np.nan)
