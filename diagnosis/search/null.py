"""What chance alone does to the screen: the null distribution of the largest score.

If nothing is missing the whitened residuals are independent and standard normal, so the candidates'
scores are jointly normal with the correlation R of their columns (states and base parameters projected
out). Draws from N(0, R) give the distribution of the largest squared score, one-sided candidates
counting on their own side only; beyond the draws the tail is n_eff times that of chi-squared with one
degree of freedom.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from diagnosis.fit.linearisation import Linearisation
from diagnosis.search.screen import Score
from models.base import FloatArray

DRAWS = 20_000
TAIL = 0.01
LEAST_P = 1e-6
"""Least p-value stated; it stands for "at most this": nobody has tested a null distribution further out."""


@dataclass(frozen=True)
class Null:
    """Sorted draws of the largest score statistic, and the number of independent tests they amount to."""

    draws: FloatArray
    effective: float

    @property
    def band(self) -> float:
        """Exceeded by chance with 5 % probability."""
        return float(np.quantile(self.draws, 0.95))

    def p_value(self, gain: float) -> float:
        """Probability that chance alone brings such a gain."""
        above = float(np.mean(self.draws >= gain))
        if above > TAIL:
            return above
        return float(min(1.0, self.effective * chi2.sf(gain, 1)))


def null_distribution(screen: Linearisation, scores: Sequence[Score]) -> Null:
    """The distribution for these candidates on these recordings."""
    kept = [s for s in scores if screen.product(s.column, s.column) > 1e-9]
    n = len(kept)
    gram = np.array([[screen.product(a.column, b.column) for b in kept] for a in kept]).reshape(n, n)
    size = np.sqrt(np.maximum(np.diag(gram), 1e-300))
    values, vectors = np.linalg.eigh(gram / np.outer(size, size))
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    z = np.random.default_rng(0).normal(size=(DRAWS, n)) @ root.T
    z = np.where(z * np.array([s.side for s in kept], np.float64) < 0.0, 0.0, z)
    draws = np.sort(np.max(z**2, axis=1)) if n else np.zeros(DRAWS)
    level = float(np.quantile(draws, 1.0 - TAIL))
    effective = TAIL / float(chi2.sf(level, 1)) if level > 0.0 else 1.0
    return Null(draws, max(effective, 1.0))
