"""Models that differ in their states, compared by likelihood, each under its own errors.

The restricted likelihood depends on how many states a model has and on their units, so it compares explanations of one
model only. Here states are estimated, not integrated out:

    -2 log L = sum_w [ log|C_w| + (nu + 1) n log(1 + r'P r/(nu n)) ] + the same of still stretches and drifts + priors,

C the model's own errors. Every state lowers it by about one where it is not needed.
"""

from __future__ import annotations

import numpy as np

from diagnosis.errors.likelihood import NU, evaluate
from diagnosis.errors.model import Errors
from diagnosis.fit.solver import Fitted
from models.base import FloatArray


def by_window(errors: Errors) -> FloatArray:
    """The windows' parts (W,)."""
    return _by_piece(errors)[0][: errors.whitening.measured.count.size]


def deviance(fitted: Fitted, errors: Errors) -> float:
    """-2 log likelihood of a fit under the errors estimated about it."""
    each, price = _by_piece(errors)
    return float(each.sum()) + price + fitted.misfit.prior_of_unknowns(fitted.u)


def _by_piece(errors: Errors) -> tuple[FloatArray, float]:
    state = evaluate(errors.pieces, errors.prior, errors.theta, errors.weights, slopes=False)
    count = np.array([piece.residual.size for piece in errors.pieces], np.float64)
    moving = np.arange(count.size) < errors.whitening.measured.count.size
    squares = np.where(moving, (NU + 1.0) * count * np.log1p(state.chi2 / (NU * count)), state.chi2)
    determinants = [np.linalg.slogdet(piece.covariance(errors.theta))[1] for piece in errors.pieces]
    return np.asarray(squares + np.array(determinants), np.float64), state.price
