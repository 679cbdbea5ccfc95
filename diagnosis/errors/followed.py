"""Windows that end where small changes no longer leave small ones.

Where a body comes close to rest a slightly larger rate means one event more, and where two bodies move a slightly other
rotation means another order of events: what happens then tells nothing, and a fit ends in one of many small valleys.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from diagnosis.errors.kicks import kicks
from diagnosis.fit.growing import cut_again
from diagnosis.fit.misfit import reduce
from diagnosis.fit.prediction import Point
from diagnosis.fit.setup import with_noise_of_the_base
from diagnosis.fit.solver import Fitted, fit_thoroughly, normal
from diagnosis.fit.unknowns import clip


def followed(fitted: Fitted) -> Fitted:
    """The base fit with windows that end there, and without those too short."""
    m = fitted.measured
    last = kicks(fitted.misfit.predictor, fitted.point).followed
    if m.parts_quickly:
        last = np.minimum(last, in_proportion(fitted))
    if m.lengths is None or all(n >= window.samples for n, window in zip(last, m.windows, strict=True)):
        return fitted
    steps = np.array([m.recordings[window.recording].time_step for window in m.windows])
    keep = np.flatnonzero(last * steps >= m.lengths.shortest)
    if not keep.size:
        return fitted
    windows = [replace(m.windows[w], samples=min(m.windows[w].samples, int(last[w]))) for w in keep]
    plain = cut_again(fitted.misfit.of_windows(keep), windows)
    return with_noise_of_the_base(fit_thoroughly(plain, fitted.u, fitted.states[keep]))


def in_proportion(fitted: Fitted) -> NDArray[np.intp]:
    """Samples (W,) before a change of what is fitted, by its deviation, is out of proportion by the noise somewhere.

    Changes along the principal axes of each window's states and of the parameters, the states going with them.
    """
    m = fitted.measured
    predicted = fitted.misfit.predictor.predict([fitted.misfit.point(fitted.u, fitted.states), *_changes(fitted)])
    bend = 0.5 * (predicted[1::2] + predicted[2::2]) - predicted[0]
    bent = ~(np.abs(bend) <= m.units[:, :, None]) & m.mask
    anywhere = bent.any(axis=(0, 2))
    lengths = np.array([window.samples for window in m.windows], np.intp)
    return np.where(anywhere.any(axis=1), anywhere.argmax(axis=1), lengths)


def _changes(fitted: Fitted) -> list[Point]:
    """Points by a deviation up and down along every axis."""
    misfit, u, states = fitted.misfit, fitted.u, fitted.states
    linear = misfit.linearise(u, states)
    by_state = linear.by_state
    precision = np.swapaxes(by_state, 1, 2) @ by_state + np.diag(1.0 / fitted.measured.state_size**2)
    values, axes = np.linalg.eigh(precision)
    changes = [(np.zeros(u.size), axes[:, :, k] / np.sqrt(values[:, k, None])) for k in range(states.shape[1])]
    hessian, _ = normal(misfit, reduce(linear), misfit.weights(linear.residual), u)
    variances, own = np.linalg.eigh(np.linalg.inv(hessian)[: u.size, : u.size])
    for k in range(u.size):
        moved = np.sqrt(max(float(variances[k]), 0.0)) * own[:, k]
        ahead = np.swapaxes(by_state, 1, 2) @ (linear.by_unknown[..., : u.size] @ moved)[..., None]
        changes.append((moved, -np.linalg.solve(precision, ahead)[..., 0]))
    return [
        misfit.point(clip(misfit.unknowns, u + sign * du), states + sign * ds) for du, ds in changes for sign in (1, -1)
    ]
