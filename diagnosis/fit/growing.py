"""A fit whose windows grow: short ones first, in which neighbouring trajectories stay together.

Where motion is chaotic they part after a few events. In windows of full length the states of many end at motions with
other events, and the parameters with them; and the nearest minimum is narrow by chance, far narrower than what is known
of the parameters.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from diagnosis.data.windows import Window
from diagnosis.fit.misfit import Misfit, reduce
from diagnosis.fit.prediction import Point
from diagnosis.fit.solver import Fitted, fit_thoroughly, normal
from diagnosis.fit.starts import Origin, searched
from diagnosis.fit.unknowns import clip
from diagnosis.fit.whitening import sensor_noise_only

SHARES = (0.25, 0.5, 0.75)
"""Of the windows' lengths, one after the other."""
FEWEST = 20
"""Samples of a window that is shortened."""
SHORTEST, FIRST = 0.2, 0.4
"""Shares of its length that a window must reach, and that it begins with."""
LEAST = 1.03
"""What all windows together grow by at least in a round."""
ROUNDS = 8
HOPELESS = 2.0
"""Times a loss that a fit should reach, from which on it is given up: windows freed later at most halve it."""
DEVIATIONS = 2.0
"""By which what is fitted is changed; what is out of proportion may weigh as much as the change itself."""


def fit_from(plain: Misfit, origins: Sequence[Origin], seed: int = 0, most: float = np.inf) -> Fitted:
    """The minimum against the sensors' white noise, searched from ``origins`` over what is not known there.

    With windows that grow to their lengths where neighbouring trajectories part within one. Where it is far from a loss
    of ``most``, as shorter windows tell at less cost, it ends there, above that loss.
    """
    shares = SHARES if plain.measured.parts_quickly else ()
    stages = [*(_cut(plain, [share * w.samples for w in plain.measured.windows]) for share in shares), plain]
    found = searched(stages[0], origins, seed)
    for stage in stages:
        if found.loss > HOPELESS * most:
            break
        found = fit_thoroughly(stage, found.u, found.states)
    return found


def fit_followed(
    plain: Misfit, origins: Sequence[Origin], seed: int = 0, known: NDArray[np.intp] | None = None
) -> Fitted:
    """The same, with windows that grow only as long as what is fitted acts in proportion in them.

    Without those in which it does not even over `SHORTEST` of their length. ``known``: samples (W,) that they have been
    followed over, and are.
    """
    if not plain.measured.parts_quickly:
        return fit_from(plain, origins, seed)
    whole = np.array([window.samples for window in plain.measured.windows])
    known = np.zeros(whole.size, np.intp) if known is None else known
    stage = _cut(plain, np.maximum(FIRST * whole, known))
    found = searched(stage, origins, seed)
    for turn in range(ROUNDS):
        found = fit_thoroughly(stage, found.u, found.states)
        further = _cut(plain, np.maximum(in_proportion(found, plain), known))
        if turn and further.measured.mask.sum() < LEAST * stage.measured.mask.sum():
            break
        stage = further
    ends = np.maximum(in_proportion(found, found.misfit), known)
    keep = np.flatnonzero(ends >= np.minimum(np.maximum(SHORTEST * whole, FEWEST), whole))
    keep = keep if keep.size else np.arange(whole.size)
    ended = _cut(plain.of_windows(keep), ends[keep])
    return fit_thoroughly(ended, found.u, found.states[keep])


def in_proportion(fitted: Fitted, longer: Misfit) -> NDArray[np.intp]:
    """Samples (W,) of ``longer`` windows over which changes by `DEVIATIONS` are in proportion.

    Changes along the principal axes of each window's states and of the parameters, the states going with them.
    """
    m = longer.measured
    predicted = longer.predictor.predict([fitted.misfit.point(fitted.u, fitted.states), *changed_points(fitted)])
    bend = (0.5 * (predicted[1::2] + predicted[2::2]) - predicted[0]) / m.units[:, :, None]
    squares = np.where(m.mask & np.isfinite(bend), bend**2, np.where(m.mask, np.inf, 0.0))
    bent = np.any(np.cumsum(np.sum(squares, axis=2), axis=2) > DEVIATIONS**2, axis=0)
    lengths = np.array([window.samples for window in m.windows], np.intp)
    return np.where(bent.any(axis=1), bent.argmax(axis=1), lengths)


def cut_again(misfit: Misfit, windows: Sequence[Window]) -> Misfit:
    """The misfit with other lengths of its windows, against white noise of the sensors."""
    predictor = replace(misfit.predictor, measured=misfit.measured.cut_again(tuple(windows)))
    return replace(misfit, predictor=predictor, whitening=sensor_noise_only(predictor))


def _cut(plain: Misfit, lengths: Sequence[float] | NDArray[np.generic]) -> Misfit:
    """With windows of about these ``lengths`` in samples, none longer than it was."""
    windows = plain.measured.windows
    least = [max(FEWEST, int(SHORTEST * w.samples)) for w in windows]
    samples = [min(w.samples, max(int(n), m)) for w, n, m in zip(windows, lengths, least, strict=True)]
    return cut_again(plain, [replace(w, samples=n) for w, n in zip(windows, samples, strict=True)])


def changed_points(fitted: Fitted) -> list[Point]:
    """Points by `DEVIATIONS` up and down along every axis, those of the states first, then those of the parameters."""
    misfit, u, states = fitted.misfit, fitted.u, fitted.states
    linear = misfit.linearise(u, states)
    by_state = linear.by_state
    precision = np.swapaxes(by_state, 1, 2) @ by_state + np.diag(1.0 / fitted.measured.state_size**2)
    values, axes = np.linalg.eigh(precision)
    changes = [(np.zeros(u.size), axes[:, :, k] / np.sqrt(values[:, k, None])) for k in range(states.shape[1])]
    hessian, _ = normal(misfit, reduce(linear), misfit.weights(linear.residual), u)
    variances, own = np.linalg.eigh(np.linalg.pinv(hessian, hermitian=True)[: u.size, : u.size])
    for k in range(u.size):
        moved = np.sqrt(max(float(variances[k]), 0.0)) * own[:, k]
        ahead = np.swapaxes(by_state, 1, 2) @ (linear.by_unknown[..., : u.size] @ moved)[..., None]
        changes.append((moved, -np.linalg.solve(precision, ahead)[..., 0]))
    return [
        misfit.point(clip(misfit.unknowns, u + by * du), states + by * ds)
        for du, ds in changes
        for by in (DEVIATIONS, -DEVIATIONS)
    ]
