"""What a column of the residuals adds to the likelihood when the variances are estimated anew beside it.

Errors estimated without a law hold part of what it does, so that its score under them is bounded. With the coefficient
beta of the column,

    gain = min_theta D(theta, beta = 0) - min_theta D(theta),

D = -2 log restricted likelihood, the same columns projected in both, the same weights of pieces. Without the law
the gain is chi-squared with one degree of freedom. The smooth error of the model is left out: it would pass for a law.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.errors.components import LowRank
from diagnosis.errors.likelihood import Piece, Prior, State, evaluate, maximise
from diagnosis.errors.model import Errors
from models.base import FloatArray

HOPEFUL = 0.2
"""Share of what a gain must reach under which no window is left out to see whether it does."""


@dataclass(frozen=True)
class Evidence:
    """Gain in 2 log likelihood of a column and its coefficient; ``by_window`` (W,): the windows' own parts."""

    gain: float
    coefficient: float
    by_window: FloatArray

    @property
    def without_largest(self) -> float:
        """The gain without the window that adds most."""
        return self.gain - max(float(self.by_window.max(initial=0.0)), 0.0)


@dataclass(frozen=True)
class Without:
    """The likelihood with the columns ``beside`` (W, C, N, B) in it and without any that is to be tested."""

    measured: Measured
    pieces: tuple[Piece, ...]
    prior: Prior
    theta: FloatArray
    weights: FloatArray
    state: State

    @classmethod
    def estimated(cls, errors: Errors, measured: Measured, beside: FloatArray, smooth_error: bool = False) -> Without:
        """The variances estimated anew, the smooth error of the model left out unless it is asked for."""
        smooth = np.array([c.kind == "inadequacy" and not smooth_error for c in errors.components])
        alone = [piece.holding(smooth, 0.0) for piece in errors.pieces]
        pieces = _with(alone, measured, beside)
        prior = _wider(errors.prior.without(smooth), beside.shape[-1])
        theta, state = maximise(pieces, prior, errors.theta[~smooth], errors.weights)
        return cls(measured, tuple(pieces), prior, theta, errors.weights, state)

    def evidence(self, column: FloatArray) -> Evidence:
        """Of a column (W, C, N) of predictions."""
        whole, prior = _with(self.pieces, self.measured, column[..., None]), _wider(self.prior, 1)
        start = evaluate(whole, prior, self.theta, self.weights, slopes=False)
        last = prior.slope.size - 1
        variance = max(float(start.covariance[last, last]), 1e-300)
        _, found = maximise(whole, prior, self.theta, self.weights)
        determinants = self.state.determinants - found.determinants
        each = determinants + self.weights * (self.state.chi2 - found.chi2)
        gain = start.deviance - found.deviance + float(start.estimate[last]) ** 2 / variance
        return Evidence(gain, -float(found.estimate[last]), each[: len(self.measured.windows)])

    def from_window_to_window(self, column: FloatArray, least: float) -> float:
        """Gain by a random share of a ``column`` (W, C, N) in each window, without the one that adds most or is worst.

        One window that is badly off makes the errors of all look large; with a share of its own all would gain.
        The column itself is ``beside``: what is the same in all windows is no part of it. With all windows it must gain
        `HOPEFUL` of ``least``; else that is what is given.
        """
        shares = _columns(self.measured, column[..., None])
        size = np.sqrt(np.mean([np.sum(own**2) for own in shares]))
        windows = [*(LowRank(own / size) for own in shares), *[None] * (len(self.pieces) - len(shares))]
        pieces = [replace(p, parts=(*p.parts, own)) for p, own in zip(self.pieces, windows, strict=True)]
        drifts, largest = self.prior.drifts, self.prior.largest
        prior = replace(
            self.prior, drifts=(*drifts, None) if drifts else (), largest=(*largest, np.inf) if largest else ()
        )
        theta = np.append(self.theta, 0.0)
        if evaluate(pieces, prior, theta, self.weights).slope[-1] >= 0.0:
            return 0.0
        theta, found = maximise(pieces, prior, theta, self.weights)
        gain = self.state.deviance - found.deviance
        if gain < HOPEFUL * least:
            return gain
        each = self.state.determinants - found.determinants + self.weights * (self.state.chi2 - found.chi2)
        count = len(shares)
        worst = self.state.chi2[:count] / [piece.residual.size for piece in pieces[:count]]
        gains = []
        for left_out in {int(np.argmax(each[:count])), int(np.argmax(worst))}:
            rest = [k for k in range(len(pieces)) if k != left_out]
            _, without = maximise([self.pieces[k] for k in rest], self.prior, self.theta, self.weights[rest])
            _, shared = maximise([pieces[k] for k in rest], prior, theta, self.weights[rest])
            gains.append(without.deviance - shared.deviance)
        return min(gains)


def _columns(measured: Measured, columns: FloatArray) -> list[FloatArray]:
    """Columns (W, C, N, B) of predictions in the samples of each window's piece (n, B)."""
    each = np.moveaxis(measured.averaged(np.moveaxis(columns, -1, 0)), 0, -1) / measured.units[:, :, None, None]
    return [own[keep] for own, keep in zip(each, measured.compared, strict=True)]


def _with(pieces: Sequence[Piece], measured: Measured, columns: FloatArray) -> list[Piece]:
    """The pieces with more columns (W, C, N, B) beside the base parameters; none of them acts in a still stretch."""
    own = _columns(measured, columns)
    found = []
    for k, piece in enumerate(pieces):
        more = own[k] if k < len(own) else np.zeros((piece.residual.size, columns.shape[-1]))
        found.append(replace(piece, by_unknown=np.concatenate([piece.by_unknown, more], axis=1)))
    return found


def _wider(prior: Prior, more: int) -> Prior:
    """The same with further coefficients of which nothing is known."""
    precision = np.pad(prior.precision, (0, more))
    return replace(prior, precision=precision, slope=np.pad(prior.slope, (0, more)))
