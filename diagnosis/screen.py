"""The screen: how much each mechanism could explain, before any refit.

With residuals r and derivatives d of the effect's parameter, both projected off the states and the
base parameters (weights and priors included), the score (Lagrange multiplier) statistic is

    S = (d'r)^2 / d'd,      one-sided where the null is a bound: 0 when the best step leaves it.

A null at infinity or with a threshold (sliding, gaps, flight) has no usable derivative: there the
model is run on a grid of values and the statistic is the largest gain over the grid, the base
parameters and states answering linearly.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnosis.candidates import Candidate
from diagnosis.fit import Fitted, normal
from diagnosis.misfit import STEP, reduce
from diagnosis.prediction import Point
from models.base import FloatArray
from models.errors import InputError


@dataclass(frozen=True)
class Score:
    """``statistic``: the larger of score and grid gain; ``starts``: coordinates (d,) worth a refit, best first.

    ``column`` (W, M): the direction in which the effect moves the residuals, off the states.
    """

    candidate: Candidate
    statistic: float
    starts: tuple[FloatArray, ...]
    column: FloatArray


@dataclass(frozen=True)
class Screen:
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


def open_screen(fitted: Fitted) -> Screen:
    """Linearise about a fit."""
    misfit = fitted.misfit
    linear = misfit.linearise(fitted.u, fitted.states)
    reduced = reduce(linear)
    weights = misfit.weights(linear.residual)
    hessian, gradient = normal(misfit, reduced, weights, fitted.u)
    inverse = np.asarray(np.linalg.pinv(hessian, hermitian=True), np.float64)
    return Screen(fitted, reduced.residual, weights, reduced.basis, reduced.by_unknown, inverse, gradient)


def score(screen: Screen, candidates: Sequence[Candidate]) -> list[Score]:
    """Statistics of all candidates, strongest first; those that the model refuses beside others are left out."""
    base = screen.fitted.misfit.point(screen.fitted.u, screen.fitted.states)
    found = []
    for candidate in candidates:
        try:
            found.append(_score_one(screen, base, candidate))
        except InputError:  # it does not act together with a mechanism that is switched on
            continue
    return sorted(found, key=lambda s: -s.statistic)


def _score_one(screen: Screen, base: Point, candidate: Candidate) -> Score:
    misfit = screen.fitted.misfit
    null = candidate.null
    low, high = candidate.unknowns[0].bounds
    near = [null.copy(), null.copy()]
    near[0][0], near[1][0] = min(max(null[0] - STEP, low), null[0]), min(max(null[0] + STEP, low), high)
    off, _ = screen.reduced(misfit.residuals([at(base, candidate, u) for u in near]))
    derivative = (off[1] - off[0]) / (near[1][0] - near[0][0])
    information = screen.product(derivative, derivative)
    trials = list(candidate.grid(by_threshold=information <= 1e-12))
    off, _ = screen.reduced(misfit.residuals([at(base, candidate, u) for u in trials]))
    best, start = 0.0, null
    if information > 1e-12:
        step = -screen.scores_with_residual(derivative) / information
        if null[0] < high if step > 0.0 else null[0] > low:
            best = step**2 * information
            start = null.copy()
            start[0] = np.clip(null[0] + step, low, high)
    gains = np.array([_gain(screen, column) for column in off])
    order = np.argsort(-gains)[:2]
    starts = [trials[int(i)] for i in order if gains[i] > 0.0]
    if best > 0.0:
        starts.insert(0 if not gains.size or best * 0.8 > gains[order[0]] else 1, start)
    statistic = max(best if np.isfinite(best) else 0.0, float(gains.max(initial=0.0)))
    column = derivative if information > 1e-12 or not order.size else off[int(order[0])] - screen.residual
    return Score(candidate, statistic, tuple(starts[:2]), column)


def _gain(screen: Screen, off: FloatArray) -> float:
    """Gain of a trial in 2 log likelihood, states and base parameters answering linearly."""
    change = off - screen.residual
    return -2.0 * screen.scores_with_residual(change) - screen.product(change, change)


def at(base: Point, candidate: Candidate, u: FloatArray) -> Point:
    """A point with the candidate's coordinates."""
    values = {x.name: x.value(float(c)) for x, c in zip(candidate.unknowns, u, strict=True)}
    return Point({**base.values, **candidate.held, **values}, base.states)
