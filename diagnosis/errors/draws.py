"""Errors drawn at random from their estimate, for a bootstrap."""

from __future__ import annotations

import numpy as np

from diagnosis.data.measured import Measured
from diagnosis.errors.drifts import columns, knots_of
from diagnosis.errors.model import Errors
from models.base import FloatArray


def draw(errors: Errors, measured: Measured, rng: np.random.Generator) -> FloatArray:
    """Errors (W, C, N) of every window: noise of the sensors, noise of the base motion, scatter of events."""
    found = np.einsum("wcnk,wk->wcn", errors.base, rng.normal(size=errors.base.shape[::3]))
    scatter = np.sqrt(sum(t for c, t in zip(errors.components, errors.theta, strict=True) if c.kind == "scatter"))
    found += scatter * np.einsum("wcnk,wk->wcn", errors.kicks, rng.normal(size=errors.kicks.shape[::3]))
    knots = knots_of(measured, errors.components)
    if knots is not None:
        drift = errors.prior.root(errors.theta) @ rng.normal(size=(knots.time.size, 1))
        found += columns(knots, drift, measured, errors.unit)[..., 0]
    samples = np.arange(measured.values.shape[2])
    peak = np.max(np.abs(measured.values) * measured.mask, axis=(0, 2))
    roots: dict[tuple[int, float], FloatArray] = {}
    for w, window in enumerate(measured.windows):
        step = measured.recordings[window.recording].time_step
        for c, unit in enumerate(errors.unit):
            own = [(k, t) for k, t in zip(errors.components, errors.theta, strict=True) if k.channel == c and t > 0.0]
            if (c, step) not in roots:
                lag = np.abs(samples[:, None] - samples[None, :]) * step
                covariance: FloatArray = 1e-9 * np.eye(samples.size)
                for component, theta in own:
                    if not component.moving and not component.shared:
                        covariance = covariance + theta * component.kernel(lag)
                roots[c, step] = np.asarray(np.linalg.cholesky(covariance), np.float64)
            growing = sum(t for k, t in own if k.kind == "growing")
            size = np.abs(measured.values[w, c]) / max(float(peak[c]), 1e-300)
            noise = roots[c, step] @ rng.normal(size=samples.size)
            found[w, c] += unit * (noise + np.sqrt(growing) * size * rng.normal(size=samples.size))
    return np.where(measured.mask, found, 0.0)
