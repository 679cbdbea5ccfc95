"""What each channel adds: by how much the intervals of the parameters would be wider without it.

From derivatives at the optimum in units of the errors as estimated, states eliminated: with H the Gauss-Newton Hessian
of all channels and H_c that of the others without channel c, priors in both, the deviation of parameter i grows by the
factor sqrt((H_c^-1)_ii / (H^-1)_ii). Errors that channels share, such as the noise of the base and a model's own, are
a part of both: a second channel also tells these from the motion.
"""

from __future__ import annotations

import numpy as np

from diagnosis.fit.solver import Fitted
from models.base import FloatArray

SMALL = 1e-9
"""Of the largest singular value: a state that the channels left do not tell."""


def added_by_channels(fitted: Fitted) -> dict[str, dict[str, float]]:
    """By channel and parameter: the interval's width without the channel over that with it; empty for one channel.

    inf where nothing else tells the parameter, 1 where no channel does.
    """
    m, misfit = fitted.measured, fitted.misfit
    if len(m.channels) < 2 or not fitted.u.size:
        return {}
    linear = misfit.linearise(fitted.u, fitted.states)
    weights = np.sqrt(misfit.weights(linear.residual))[:, None, None]
    precision, _ = misfit.prior_normal(fitted.u)
    names = [x.name for x in misfit.unknowns]
    columns = np.concatenate([linear.by_unknown, linear.by_state], axis=-1)
    split = linear.by_unknown.shape[-1]
    whole = _deviation(weights * columns, split, precision)[: len(names)]
    averages = misfit.whitening.averages(np.moveaxis(columns, -1, 0))
    found = {}
    for c, channel in enumerate(m.channels):
        rest = np.moveaxis(misfit.whitening.without(c).of_averages(averages), 0, -1)
        without = np.ones(whole.size)
        told = np.isfinite(whole)
        without[told] = _deviation(weights * rest, split, precision)[: whole.size][told] / whole[told]
        found[channel] = dict(zip(names, without.tolist(), strict=True))
    return found


def _deviation(columns: FloatArray, split: int, precision: FloatArray) -> FloatArray:
    """Deviations (k,) of the first ``split`` columns' numbers, the states' columns (W, M, S) coming after them."""
    by_unknown, by_state = columns[..., :split], columns[..., split:]
    if by_state.shape[-1]:
        basis, size, _ = np.linalg.svd(by_state, full_matrices=False)
        basis = basis * (size > SMALL * size.max())[:, None, :]
        by_unknown = by_unknown - basis @ (np.swapaxes(basis, 1, 2) @ by_unknown)
    values, vectors = np.linalg.eigh(np.einsum("wmi,wmj->ij", by_unknown, by_unknown, optimize=True) + precision)
    told = values > SMALL**1.5 * values.max()
    variance = (vectors[:, told] ** 2 / values[told]).sum(axis=1)
    lost = np.max(vectors[:, ~told] ** 2, axis=1, initial=0.0) > SMALL
    return np.asarray(np.sqrt(np.where(lost, np.inf, variance)))
