"""Hum: lines in the spectrum of the errors, found by their score.

For a line of frequency f in one channel, V_ij = cos 2 pi f (t_i - t_j) is of rank two in each piece, so that q = sum w
a'V a has the mean t = sum tr(P V) and, without a line, a variance of about sum tr(P V)^2.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnosis.errors.components import Component
from diagnosis.errors.likelihood import Piece, Solved, solve
from models.base import FloatArray

LOWEST, STEP, FINE = 6.0, 0.2, 0.02
"""Hz; below, a line cannot be told from motion; the highest one is at half the sampling rate."""
CLEAR = 8.0
"""Standard deviations over what is expected at which a line counts."""
APART = 1.5
"""Hz between the lines of a channel."""
AROUND = 5.0
"""Hz to either side that a line has to exceed: the other components may be too low over a band."""
MOST = 2


def lines(pieces: Sequence[Piece], channels: int, theta: FloatArray, weights: FloatArray) -> tuple[Component, ...]:
    """Lines beyond what the other components explain, at most MOST a channel, strongest first."""
    found: list[Component] = []
    frequency = np.arange(LOWEST, _fastest(pieces) + FINE, STEP)
    if not frequency.size:
        return ()
    solved = [solve(piece, theta) for piece in pieces]
    for c in range(channels):
        score, root = _score(pieces, solved, c, frequency, weights)
        left = np.where(_over_its_band(score, root, frequency) < CLEAR, 0.0, score)
        for _ in range(MOST):
            best = int(np.argmax(left))
            if left[best] == 0.0:
                break
            near = np.minimum(frequency[best] + np.arange(-STEP, STEP, FINE), frequency[-1])
            sharp = near[int(np.argmax(_score(pieces, solved, c, near, weights)[0]))]
            found.append(Component("hum", c, float(sharp)))
            left[np.abs(frequency - frequency[best]) < APART] = 0.0
    return tuple(found)


def _over_its_band(score: FloatArray, root: FloatArray, frequency: FloatArray) -> FloatArray:
    """Standard deviations (f,) over what most frequencies around have, near ones left out.

    Errors whose density is r times what is expected score (r - 1) ``root`` in the mean, with a deviation of r.
    """
    distance = np.abs(frequency[:, None] - frequency)
    around = (distance >= APART) & (distance <= AROUND)
    band = np.array([max(0.0, float(np.median(score[one]))) if one.any() else 0.0 for one in around])
    return np.asarray((score - band) / (1.0 + band / root))


def _fastest(pieces: Sequence[Piece]) -> float:
    """Half the lowest sampling rate of the pieces (Hz), from which on another line makes the same samples."""
    return 0.5 / max(float(np.diff(np.unique(piece.time)).min(initial=1.0)) for piece in pieces if piece.time.size > 1)


def _score(
    pieces: Sequence[Piece], solved: Sequence[Solved], channel: int, frequency: FloatArray, weights: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Standard deviations (f,) by which a line's part exceeds what is expected without one, and that over these."""
    excess, variance, mean = np.zeros_like(frequency), np.zeros_like(frequency), np.zeros_like(frequency)
    for piece, one, weight in zip(pieces, solved, weights, strict=True):
        wave = np.exp(2j * np.pi * frequency[None, :] * piece.time[:, None]) * (piece.channel == channel)[:, None]
        expected = np.einsum("if,if->f", wave.conj(), one.projector @ wave).real
        excess += weight * np.abs(one.on_residual @ wave) ** 2 - expected
        variance += expected**2
        mean += expected
    deviation = np.sqrt(np.maximum(variance, 1e-300))
    return excess / deviation, np.maximum(mean / deviation, 1e-300)
