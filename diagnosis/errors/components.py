"""The variance components of a recording's errors: what each adds to the covariance of a piece.

A piece is a stretch of samples (a window of the motion, or one in which nothing moves). Its covariance is

    C = B + sum_k theta_k V_k,      theta_k >= 0,

B known (noise of the measured base motion). The V_k are stationary noise of a sensor with a kernel k(lag), noise that
grows with the signal (a diagonal), and random kicks at events (low rank). Slow drifts go on from piece to piece and
are no part of a piece's own covariance (`diagnosis.errors.drifts`). Every kind knows its product with a vector,
its trace with a matrix and how to add itself, so that none of them is ever formed for all pieces at once.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from models.base import FloatArray

Kind = Literal[
    "white",
    "low_pass",
    "filtered",
    "exponential",
    "slow_drift",
    "hum",
    "growing",
    "scatter",
    "base_drift",
    "inadequacy",
]

LOW_PASS = (0.006, 0.012)
"""s, deviation of Gaussian kernels: noise that a filter left, with spectra of 27 and 13 Hz standard deviation."""
CORNERS = (4.0, 6.0, 9.0, 13.5, 20.0)
"""Hz, of Butterworth filters of order `ORDER` that noise which is not white may have gone through; a sum of their
densities is near that of any low-pass."""
ORDER = 4
DECAYS = (0.015, 0.05, 0.15, 0.5)
"""s, of exponential kernels: autoregressive and 1/f noise."""
SLOW_DRIFTS = (3.0, np.inf)
"""s, correlation times of drifts: a stationary one, and a random walk."""
WALK = 10.0
"""s after which a random walk has its variance."""
SMOOTH = (0.05, 0.15)
"""s, deviation of the Gaussian kernels of a smooth inadequacy of the model."""


@dataclass(frozen=True)
class Component:
    """One variance. ``channel``: whose noise it is, if one's; ``scale``: s of a kernel, Hz of hum or of a filter."""

    kind: Kind
    channel: int | None = None
    scale: float = 0.0

    @property
    def moving(self) -> bool:
        """Whether it acts only while the specimen moves."""
        return self.kind in ("growing", "scatter", "inadequacy")

    @property
    def shared(self) -> bool:
        """Whether it goes on from piece to piece."""
        return self.kind in ("slow_drift", "base_drift")

    @property
    def kernel(self) -> Callable[[FloatArray], FloatArray]:
        """Correlation as a function of the lag in s, for a stationary kind."""
        scale = self.scale
        if self.kind == "white":
            return lambda lag: (lag == 0.0).astype(np.float64)
        if self.kind == "exponential":
            return lambda lag: np.exp(-lag / scale)
        if self.kind == "hum":
            return lambda lag: np.cos(2.0 * np.pi * scale * lag)
        if self.kind == "filtered":
            return lambda lag: _butterworth(2.0 * np.pi * scale * lag) / _butterworth(np.zeros(1))
        return lambda lag: np.exp(-0.5 * (lag / scale) ** 2)

    def density(self, frequency: FloatArray, step: float) -> FloatArray:
        """One-sided spectral density (1/Hz) of a stationary kind of variance one; ``step`` (s) of samples if white."""
        if self.kind == "white":
            return np.full_like(frequency, 2.0 * step)
        if np.isinf(self.scale):
            return np.asarray(2.0 / WALK / (2.0 * np.pi * frequency) ** 2)
        if self.kind in ("exponential", "slow_drift"):
            return np.asarray(4.0 * self.scale / (1.0 + (2.0 * np.pi * frequency * self.scale) ** 2))
        if self.kind == "filtered":
            whole = self.scale * float(_butterworth(np.zeros(1))[0])
            return np.asarray(1.0 / (whole * (1.0 + (frequency / self.scale) ** (2 * ORDER))))
        if self.kind in ("low_pass", "inadequacy"):
            wide = 2.0 * np.sqrt(2.0 * np.pi) * self.scale
            return np.asarray(wide * np.exp(-2.0 * (np.pi * frequency * self.scale) ** 2))
        return np.zeros_like(frequency)


def _butterworth(lag: FloatArray) -> FloatArray:
    """int_0^inf cos(w lag)/(1 + w^(2 n)) dw by its residues, n = `ORDER`."""
    angle = np.pi * (2.0 * np.arange(ORDER) + 1.0) / (2.0 * ORDER)
    real, imaginary = np.multiply.outer(lag, np.sin(angle)), np.multiply.outer(lag, np.cos(angle))
    return np.asarray(np.sum(np.exp(-real) * np.sin(angle + imaginary), axis=-1) * (0.5 * np.pi / ORDER))


class Part(Protocol):
    """What one component does in one piece of n samples."""

    def add_to(self, covariance: FloatArray, theta: float) -> None:
        """Add theta V to a covariance (n, n)."""

    def times(self, vector: FloatArray) -> FloatArray:
        """V v of a vector (n,) or of columns (n, k)."""

    def trace(self, matrix: FloatArray) -> float:
        """tr(M V) of a symmetric matrix (n, n)."""


@dataclass(frozen=True)
class Stationary:
    """A kernel among the samples ``inside`` of a piece: V = ``matrix`` (m, m) there, with others in `Kernels`."""

    inside: slice
    matrix: FloatArray


@dataclass(frozen=True)
class Kernels:
    """Stationary parts among the same samples side by side: of the components ``of`` (K,), ``matrices`` (K, m, m)."""

    inside: slice
    of: NDArray[np.intp]
    matrices: FloatArray

    @classmethod
    def among(cls, parts: Sequence[Part | Stationary | None]) -> tuple[Kernels, ...]:
        """All stationary ones of the ``parts`` of a piece."""
        found: dict[tuple[int, int], dict[int, FloatArray]] = {}
        for i, part in enumerate(parts):
            if isinstance(part, Stationary):
                found.setdefault((part.inside.start, part.inside.stop), {})[i] = part.matrix
        return tuple(
            cls(slice(*ends), np.array(list(own)), np.stack(list(own.values()))) for ends, own in found.items()
        )

    def add_to(self, covariance: FloatArray, theta: FloatArray) -> None:
        """Add sum theta_k V_k to a covariance (n, n), theta of all components of the piece."""
        summed = theta[self.of] @ self.matrices.reshape(self.of.size, -1)
        covariance[self.inside, self.inside] += summed.reshape(self.matrices.shape[1:])

    def times(self, vector: FloatArray) -> FloatArray:
        """V_k v (m, K) of a vector (n,), in the samples inside."""
        return np.asarray((self.matrices @ vector[self.inside]).T)

    def trace(self, matrix: FloatArray) -> FloatArray:
        """tr(M V_k) (K,) of a symmetric matrix (n, n)."""
        flat = self.matrices.reshape(self.of.size, -1)
        return np.asarray(flat @ matrix[self.inside, self.inside].ravel())


@dataclass(frozen=True)
class Diagonal:
    """Independent errors with the variances ``values`` (n,)."""

    values: FloatArray

    def add_to(self, covariance: FloatArray, theta: float) -> None:
        covariance.flat[:: covariance.shape[0] + 1] += theta * self.values

    def times(self, vector: FloatArray) -> FloatArray:
        return np.asarray((vector.T * self.values).T)

    def trace(self, matrix: FloatArray) -> float:
        return float(np.diagonal(matrix) @ self.values)


@dataclass(frozen=True)
class LowRank:
    """Independent random numbers of variance one times ``columns`` (n, q)."""

    columns: FloatArray

    def add_to(self, covariance: FloatArray, theta: float) -> None:
        covariance += theta * (self.columns @ self.columns.T)

    def times(self, vector: FloatArray) -> FloatArray:
        return np.asarray(self.columns @ (self.columns.T @ vector))

    def trace(self, matrix: FloatArray) -> float:
        return float(np.vdot(self.columns, matrix @ self.columns))
