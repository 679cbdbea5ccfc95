"""What each channel adds: by how much the intervals of the parameters would be wider without it.

From derivatives at the optimum, each channel over its own noise, states eliminated: with H the Gauss-Newton Hessian
of all channels and H_c that without channel c, priors in both, the deviation of parameter i grows by the factor
sqrt((H_c^-1)_ii / (H^-1)_ii). Without noise of the base and errors of the model, which channels share.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnosis.fit.misfit import Linear
from diagnosis.fit.solver import Fitted
from diagnosis.fit.whitening import sensor_noise_only
from models.base import FloatArray

SMALL = 1e-9
"""Of the largest singular value: a state that the channels left do not tell."""


def added_by_channels(fitted: Fitted) -> dict[str, dict[str, float]]:
    """By channel and parameter: the interval's width without the channel over that with it; empty for one channel.

    inf where nothing else tells the parameter, 1 where no channel does.
    """
    m = fitted.measured
    if len(m.channels) < 2 or m.stretches is not None or not fitted.u.size:
        return {}
    plain = replace(fitted.misfit, whitening=sensor_noise_only(fitted.misfit.predictor))
    linear = plain.linearise(fitted.u, fitted.states)
    precision, _ = plain.prior_normal(fitted.u)
    names = [x.name for x in plain.unknowns]
    whole = _deviation(linear, precision, m.compared.shape, None)
    found = {}
    for c, channel in enumerate(m.channels):
        without = np.ones(whole.size)
        told = np.isfinite(whole)
        without[told] = _deviation(linear, precision, m.compared.shape, c)[told] / whole[told]
        found[channel] = dict(zip(names, without.tolist(), strict=True))
    return found


def _deviation(linear: Linear, precision: FloatArray, shape: tuple[int, ...], without: int | None) -> FloatArray:
    """Deviations (k,) of the unknowns, by all channels or without one."""
    windows, channels, samples = shape
    keep = [c for c in range(channels) if c != without]

    def kept(columns: FloatArray) -> FloatArray:
        return columns.reshape(windows, channels, samples, -1)[:, keep].reshape(windows, len(keep) * samples, -1)

    by_unknown = kept(linear.by_unknown)
    basis, size, _ = np.linalg.svd(kept(linear.by_state), full_matrices=False)
    basis = basis * (size > SMALL * size.max())[:, None, :]
    off = by_unknown - basis @ (np.swapaxes(basis, 1, 2) @ by_unknown)
    k = off.shape[-1]
    values, vectors = np.linalg.eigh(np.einsum("wmi,wmj->ij", off, off, optimize=True) + precision[:k, :k])
    told = values > SMALL**1.5 * values.max()
    variance = (vectors[:, told] ** 2 / values[told]).sum(axis=1)
    lost = np.max(vectors[:, ~told] ** 2, axis=1, initial=0.0) > SMALL
    return np.asarray(np.sqrt(np.where(lost, np.inf, variance)))
