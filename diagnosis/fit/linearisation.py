"""The least-squares problem linearised about a fit, states and base parameters projected out."""

from __future__ import annotations

from dataclasses import dataclass

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

    def reduced(self, residual: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Weighted residuals (..., W, M) off the states, and their products with the base derivatives."""
        inside = np.einsum("wms,...wm->...ws", self.basis, residual, optimize=True)
        off = residual - np.einsum("wms,...ws->...wm", self.basis, inside, optimize=True)
        return off, np.einsum("w,wmi,...wm->...i", self.weights, self.by_unknown, off, optimize=True)

    def product(self, one: FloatArray, other: FloatArray) -> float:
        """Inner product of two reduced columns with the base parameters projected out."""
        plain = np.einsum("w,wm,wm->", self.weights, one, other, optimize=True)
        return float(plain - self._along(one) @ self.inverse @ self._along(other))

    def _along(self, column: FloatArray) -> FloatArray:
        return np.asarray(np.einsum("w,wmi,wm->i", self.weights, self.by_unknown, column, optimize=True))

    def scores_with_residual(self, column: FloatArray) -> float:
        """d'r for a reduced column d, priors included."""
        plain = np.einsum("w,wm,wm->", self.weights, column, self.residual, optimize=True)
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
