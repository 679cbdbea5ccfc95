"""Errors drawn at random from their estimate, for a bootstrap."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnosis.data.measured import AsItWas, Measured
from diagnosis.errors.drifts import columns, knots_of
from diagnosis.errors.model import Errors
from diagnosis.errors.own import own_error
from diagnosis.errors.scattered import Events
from diagnosis.fit.solver import Fitted
from models.base import FloatArray


def scattered(errors: Errors, fitted: Fitted, rng: np.random.Generator) -> FloatArray:
    """Channels (W, C, N) that a fit predicts where its events scatter at random.

    By pulses of the base motion, and in proportion where no pulse makes such a change. As without scatter in windows in
    which the body falls by it: a recording of one that falls is cut before.
    """
    m, predictor = fitted.measured, fitted.misfit.predictor
    changes = errors.scatter * rng.normal(size=errors.kicks.window.size)
    pulses = Events(fitted.u, fitted.states, errors.kicks, changes).pulses(m)
    known = AsItWas(pulses, np.zeros(m.values.shape))
    drawn = replace(predictor, measured=replace(m, as_it_was=known)).predict([fitted.point])[0]
    drawn = drawn + errors.kicks.changing(np.where(errors.kicks.height == 0.0, changes, 0.0))
    stays = np.isfinite(drawn).all(axis=(1, 2), keepdims=True)
    return np.asarray(np.where(stays, drawn, predictor.predict([fitted.point])[0]))


def draw(errors: Errors, measured: Measured, rng: np.random.Generator) -> FloatArray:
    """Errors (W, C, N) of every window: noise of the sensors and of the base motion.

    And of a model that runs through whole recordings its own, which is no sign of what is missing.
    """
    known = np.concatenate([errors.base, errors.past], axis=-1)
    found = np.einsum("wcnk,wk->wcn", known, rng.normal(size=known.shape[::3]))
    knots = knots_of(measured, errors.components)
    if knots is not None:
        drift = errors.prior.root(errors.theta) @ rng.normal(size=(knots.time.size, 1))
        found += columns(knots, drift, measured, errors.base)[..., 0]
    for component, theta in zip(errors.components, errors.theta, strict=True):
        if component.kind == "inadequacy" and component.channel is None:
            own = own_error(measured, component.scale)
            found += np.sqrt(theta) * np.einsum("wcnk,wk->wcn", own, rng.normal(size=own.shape[::3]))
    samples = np.arange(measured.values.shape[2])
    peak = np.max(np.abs(measured.values) * measured.mask, axis=(0, 2))
    roots: dict[tuple[int, float], FloatArray] = {}
    for w, window in enumerate(measured.windows):
        step = measured.recordings[window.recording].time_step
        for c, unit in enumerate(measured.units[w]):
            acting = [
                (k, t) for k, t in zip(errors.components, errors.theta, strict=True) if k.channel == c and t > 0.0
            ]
            if (c, step) not in roots:
                lag = np.abs(samples[:, None] - samples[None, :]) * step
                covariance: FloatArray = 1e-9 * np.eye(samples.size)
                for component, theta in acting:
                    if not component.moving and not component.shared:
                        covariance = covariance + theta * component.kernel(lag)
                roots[c, step] = np.asarray(np.linalg.cholesky(covariance), np.float64)
            growing = sum(t for k, t in acting if k.kind == "growing")
            size = np.abs(measured.values[w, c]) / max(float(peak[c]), 1e-300)
            noise = roots[c, step] @ rng.normal(size=samples.size)
            found[w, c] += unit * noise + errors.unit[c] * np.sqrt(growing) * size * rng.normal(size=samples.size)
    return np.where(measured.mask, found, 0.0)
