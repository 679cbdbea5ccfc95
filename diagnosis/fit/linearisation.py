"""The least-squares problem linearised about a fit, states and base parameters projected out."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from diagnosis.fit.misfit import reduce
from diagnosis.fit.solver import Fitted, normal
from models.base import FloatArray


@dataclass(frozen=True)
class Linearisation:
    """The linearised problem about one fit, onto which candidates are projected."""

    fitted: Fitted
    residual: FloatArray
    weights: FloatArray
    basis: FloatArray
    by_unknown: FloatArray
    inverse: FloatArray
    gradient: FloatArray

    @cached_property
    def weighted(self) -> FloatArray:
        """Base derivatives times the windows' weights, flat (W M, k)."""
        windows, samples, k = self.by_unknown.shape
        return (self.weights[:, None, None] * self.by_unknown).reshape(windows * samples, k)

    def reduced(self, residual: FloatArray) -> FloatArray:
        """Whitened residuals (..., W, M) off the states."""
        column = residual[..., None]
        return np.asarray((column - self.basis @ (np.swapaxes(self.basis, 1, 2) @ column))[..., 0])

    def product(self, one: FloatArray, other: FloatArray) -> float:
        """Inner product of two reduced columns with the base parameters projected out."""
        plain = np.vdot(self.weights[:, None] * one, other)
        return float(plain - self._along(one) @ self.inverse @ self._along(other))

    def _along(self, column: FloatArray) -> FloatArray:
        return np.asarray(column.ravel() @ self.weighted)

    def scores_with_residual(self, column: FloatArray) -> float:
        """d'r for a reduced column d, priors included."""
        plain = np.vdot(self.weights[:, None] * column, self.residual)
        return float(plain - self._along(column) @ self.inverse @ self.gradient)

    def by_window(self, column: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Each window's part (W,) in the score and in the information of a reduced column, off the base parameters."""
        off = column - self.by_unknown @ (self.inverse @ self._along(column))
        scores = self.weights * np.einsum("wm,wm->w", off, self.residual)
        return scores, self.weights * np.einsum("wm,wm->w", off, off)


def linearise_about(fitted: Fitted) -> Linearisation:
    """Linearise about a fit."""
    misfit = fitted.misfit
    linear = misfit.linearise(fitted.u, fitted.states)
    reduced = reduce(linear)
    weights = misfit.weights(linear.residual)
    hessian, gradient = normal(misfit, reduced, weights, fitted.u)
    inverse = np.asarray(np.linalg.pinv(hessian, hermitian=True), np.float64)
    return Linearisation(fitted, reduced.residual, weights, reduced.basis, reduced.by_unknown, inverse, gradient)
