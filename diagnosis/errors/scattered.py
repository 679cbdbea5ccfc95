"""The motion with the events as they were, about which their scatter is linear.

The rate after event j is 1 + z_j times the law's, z_j ~ N(0, s^2). A window's response to its z_j is linear only for a
while: linear about the motion without scatter, an estimate of the law is biased in proportion to s^2, and its interval
is too narrow. So the model runs with z_j as they are predicted from the recordings, and

    f(u, x, z) ~ f(u, x, z^) + Z (z - z^),      Z = df/dz at z^,

is what the errors are estimated from and parameters u and states x are fitted to (Lindstrom and Bates, Biometrics 46,
1990, 673-687). u, x and z are moved together by Gauss-Newton steps of

    h = loss(f(u, x, z) - y) + sum (z_j/s)^2,

shortened until h falls. A change of the rate is made by a pulse of base acceleration of one sample, a sample or two
after the event: no model has to know of it. Where several rates change at an event no pulse does that, and its scatter
stays linear about the motion without.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnosis.data.measured import AsItWas, Measured
from diagnosis.errors.components import LowRank
from diagnosis.errors.kicks import Kicks
from diagnosis.errors.likelihood import Piece, Prior, evaluate, solve
from diagnosis.fit.misfit import Misfit
from diagnosis.fit.unknowns import clip
from models.base import FloatArray

SHARE = 0.05
"""Of the pulses, by which they are changed up and down to see what they do to the first order."""
STEPS = (1.0, 0.5, 0.25, 0.1)
"""Shares of a Gauss-Newton step that are tried."""
REWEIGHTED = 3
"""Times that the level of shared errors is found with the weights that it leaves."""
AROUND = np.array([-1, 0, 1])
"""Samples around an event in which its pulse lies, if it was placed about a motion close by."""


@dataclass(frozen=True)
class Events:
    """Parameters u (k,) and states x (W, S), with the relative changes of rate z (E,) of the events ``kicks``."""

    u: FloatArray
    states: FloatArray
    kicks: Kicks
    changes: FloatArray

    def towards(self, aim: Events, share: float) -> Events:
        """``share`` of the way to ``aim``, whose events are the same."""

        def between(a: FloatArray, b: FloatArray) -> FloatArray:
            return a + share * (b - a)

        return Events(
            between(self.u, aim.u), between(self.states, aim.states), self.kicks, between(self.changes, aim.changes)
        )

    def pulses(self, measured: Measured) -> tuple[FloatArray, ...]:
        """Base acceleration (n_samples,) in m s-2 by recording that makes the changes."""
        found = tuple(np.zeros(s.horizontal.size) for s in measured.shakings)
        recording = measured.recording_of[self.kicks.window]
        for r, pulse in enumerate(found):
            own = recording == r
            np.add.at(pulse, self.kicks.sample[own], (self.changes * self.kicks.height)[own])
        return found


def known_changes(measured: Measured, kicks: Kicks) -> FloatArray:
    """Relative changes (E,) that the events ``kicks`` have where they are as they were; 0 where nothing is known."""
    found = np.zeros(kicks.window.size)
    if measured.as_it_was is None:
        return found
    recording = measured.recording_of[kicks.window]
    for r, pulse in enumerate(measured.as_it_was.pulses):
        own = np.flatnonzero((recording == r) & (kicks.height != 0.0))
        near = pulse[np.clip(kicks.sample[own][:, None] + AROUND, 0, pulse.size - 1)].sum(axis=1)
        found[own] = near / kicks.height[own]
    return found


def gauss_newton(
    pieces: Sequence[Piece], prior: Prior, theta: FloatArray, weights: FloatArray, scatter: int, now: Events
) -> Events:
    """The Gauss-Newton step from ``now``, about which the pieces are linear; component ``scatter`` is the events'."""
    shift = evaluate(pieces, prior, theta, weights, slopes=False).estimate
    k = prior.slope.size
    states, changes = now.states.copy(), np.zeros(now.kicks.window.size)
    for w in range(states.shape[0]):
        piece, one = pieces[w], solve(pieces[w], theta)
        at = np.concatenate([np.arange(k), k + piece.knots])
        left = one.on_residual - one.on_common @ shift[at]
        part = piece.parts[scatter]
        if isinstance(part, LowRank):
            own = np.flatnonzero(now.kicks.window == w)
            changes[own] = -theta[scatter] * (part.columns.T @ left)[now.kicks.place[own]]
        rest = piece.residual - piece.common @ shift[at] - piece.covariance(theta) @ left  # what the states take
        states[w] -= np.linalg.lstsq(piece.by_state, rest, rcond=None)[0]
    return Events(now.u - shift[:k], states, now.kicks, changes)


def shortened(misfit: Misfit, scatter: float, now: Events, aim: Events) -> Events | None:
    """The share of a step with the lowest h; None if h falls nowhere. ``misfit`` is that without scatter."""
    m = misfit.measured

    def height(events: Events) -> float:
        known = AsItWas(events.pulses(m), np.zeros(m.values.shape))
        about = replace(misfit, predictor=replace(misfit.predictor, measured=replace(m, as_it_was=known)))
        return least_loss(about, events) + float(np.sum((events.changes / scatter) ** 2))

    trials = [now.towards(aim, share) for share in STEPS]
    trials = [replace(one, u=clip(misfit.unknowns, one.u)) for one in trials]
    heights = [height(one) for one in trials]
    best = int(np.argmin(heights))
    return trials[best] if heights[best] < height(now) else None


def least_loss(misfit: Misfit, events: Events) -> float:
    """The loss at the level of the errors that windows share at which it is least: it is linear in that."""
    shared = misfit.whitening.shared
    if shared is None:
        return misfit.loss(events.u, events.states)
    still = misfit.at_level(np.zeros(shared.shape[-1]))
    residual = still.residuals([still.point(events.u, events.states)])[0]
    level = np.zeros(shared.shape[-1])
    for _ in range(REWEIGHTED):
        weights = still.weights(residual + shared @ level)
        precision = np.einsum("w,wmi,wmj->ij", weights, shared, shared, optimize=True) + np.eye(level.size)
        level = -np.linalg.solve(precision, np.einsum("w,wmi,wm->i", weights, shared, residual, optimize=True))
    return float(misfit.losses(residual + shared @ level).sum()) + misfit.at_level(level).prior(events.u)


def linear_about(misfit: Misfit, events: Events) -> Misfit:
    """The misfit linear about these events."""
    m, pulses = misfit.measured, events.pulses(misfit.measured)

    def run(share: float) -> FloatArray:
        known = AsItWas(tuple(share * pulse for pulse in pulses), np.zeros(m.values.shape))
        predictor = replace(misfit.predictor, measured=replace(m, as_it_was=known))
        return np.asarray(predictor.predict([misfit.point(events.u, events.states)])[0])

    slope = (run(1.0 + SHARE) - run(1.0 - SHARE)) / (2.0 * SHARE)
    offset = np.where(m.mask & np.isfinite(slope), slope, 0.0)
    measured = replace(m, as_it_was=AsItWas(pulses, offset))
    return replace(misfit, predictor=replace(misfit.predictor, measured=measured))
