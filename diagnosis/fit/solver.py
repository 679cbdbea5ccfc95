"""Levenberg-Marquardt over the shared parameters, the windows' states eliminated.

Each iteration runs all windows for all differences in one batch, then for some dampings and state
steps in another. Given the parameters the windows are independent, so every window keeps the state
step that suits it best: one stuck window does not hold up the others. The level of the errors that
windows share moves with the parameters; it is linear and costs no runs.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import qmc

from diagnosis.data.measured import Measured
from diagnosis.fit.misfit import NU, Linear, Misfit, Reduced, reduce
from diagnosis.fit.prediction import Point
from diagnosis.fit.unknowns import clip, values_of
from models.base import FloatArray

DAMPINGS = (0.0, 0.1, 3.0)
STATE_STEPS = (1.0, 0.3, 0.0)
ITERATIONS = 14
TOLERANCE = 0.02
"""Gain in 2 log likelihood, expected or reached in two iterations, under which the fit ends."""
BADLY, SCATTERED = 1.5, 256
"""Squared misfit per sample of a stuck window (over that of most windows), and the states tried for it."""
SCATTERINGS = 3


@dataclass(frozen=True)
class Fitted:
    """A minimum: coordinates (k,), states (W, S), loss of each window (W,) and in all (with priors).

    ``misfit`` stands at the level of the shared errors there.
    """

    misfit: Misfit
    u: FloatArray
    states: FloatArray
    window_losses: FloatArray
    loss: float

    @property
    def measured(self) -> Measured:
        return self.misfit.measured

    @property
    def point(self) -> Point:
        """With the model's own parameters."""
        return self.misfit.predictor.declared([self.misfit.point(self.u, self.states)])[0]

    @property
    def frozen(self) -> Misfit:
        """The misfit with nothing unknown but the windows' states, at the model's own parameters."""
        predictor = replace(self.misfit.predictor, coordinates=(), rung=None)
        return replace(self.misfit, predictor=predictor, unknowns=(), fixed=self.point.values, smooth=None)

    @property
    def values(self) -> dict[str, float]:
        """Of the unknowns as the fit has them (`Identification.coordinates`)."""
        return values_of(self.misfit.unknowns, self.u)

    def at_bound(self, index: int) -> str:
        low, high = self.misfit.unknowns[index].bounds
        slack = 1e-6 * (high - low)
        return "low" if self.u[index] <= low + slack else "high" if self.u[index] >= high - slack else ""


def fit_thoroughly(misfit: Misfit, u: FloatArray, states: FloatArray) -> Fitted:
    """The minimum; windows that are stuck there start again from scattered states."""
    found = fit(misfit, u, states)
    for seed in range(SCATTERINGS):
        scattered = scatter(found, seed)
        if scattered is None:
            break
        found = fit(misfit, found.u, scattered)
    return found


def scatter(found: Fitted, seed: int) -> FloatArray | None:
    """States (W, S) with better ones for windows that misfit badly; None if there are none."""
    misfit, m = found.misfit, found.measured
    if not found.states.shape[1]:
        return None
    each = np.expm1(found.window_losses / (NU * m.count)) * NU
    bad = each > BADLY * max(1.0, float(np.median(each)))
    if not bad.any():
        return None
    draws = qmc.MultivariateNormalQMC(np.zeros(found.states.shape[1]), seed=seed).random(SCATTERED)
    width = m.state_size * np.where(np.arange(SCATTERED) % 2 == 0, 0.05, 0.25)[:, None]
    trials = found.states[None] + (draws * width)[:, None, :]
    losses = misfit.losses(misfit.residuals([misfit.point(found.u, x) for x in trials], only=bad))
    pick = np.argmin(losses, axis=0)
    better = bad & (losses.min(axis=0) < found.window_losses - 1.0)
    if not better.any():
        return None
    return np.where(better[:, None], trials[pick, np.arange(pick.size)], found.states)


def fit(misfit: Misfit, u: FloatArray, states: FloatArray, iterations: int = ITERATIONS) -> Fitted:
    """The minimum of the loss next to (u, states)."""
    u = clip(misfit.unknowns, np.asarray(u, float))
    window = misfit.losses(misfit.residuals([misfit.point(u, states)]))[0]
    loss = float(window.sum()) + misfit.prior(u)
    damping = 1.0
    small = 0
    shares = STATE_STEPS if states.shape[1] else STATE_STEPS[:1]
    for _ in range(iterations):
        linear = misfit.linearise(u, states)
        reduced = reduce(linear)
        weights = misfit.weights(linear.residual)
        hessian, gradient = normal(misfit, reduced, weights, u)
        changes = [_step(misfit, hessian, gradient, u, damping * d) for d in DAMPINGS]
        if _ahead(misfit, linear, reduced, (hessian, gradient), u, changes[0]) < TOLERANCE:
            break
        steps = [clip(misfit.unknowns, u + change[: u.size]) for change in changes]
        levels = [misfit.level + change[u.size :] for change in changes]
        points, moved = [], []
        for candidate, change in zip(steps, changes, strict=True):
            ahead = linear.residual + linear.by_unknown @ np.concatenate([candidate - u, change[u.size :]])
            shift = -np.einsum("wsm,wm->ws", reduced.solve_states, ahead)
            largest = np.maximum(np.abs(states), misfit.measured.state_size)
            shift = np.clip(shift, -largest, largest)
            moved.append([states + share * shift for share in shares])
            points += [misfit.point(candidate, x) for x in moved[-1]]
        residuals = misfit.residuals(points).reshape(len(steps), len(shares), *linear.residual.shape)
        if misfit.level.size:
            residuals += np.stack([linear.by_unknown[..., u.size :] @ c[u.size :] for c in changes])[:, None]
        losses = misfit.losses(residuals)
        pick = np.argmin(losses, axis=1)
        each = np.take_along_axis(losses, pick[:, None, :], axis=1)[:, 0]
        totals = each.sum(axis=1) + [misfit.at_level(z).prior(c) for c, z in zip(steps, levels, strict=True)]
        best = int(np.argmin(totals))
        gain = loss - float(totals[best])
        if gain <= 0.0:
            damping *= 10.0
            small += 1
            if small >= 2:
                break
            continue
        u, loss, window, misfit = steps[best], float(totals[best]), each[best], misfit.at_level(levels[best])
        states = np.stack(moved[best])[pick[best], np.arange(states.shape[0])]
        damping = max(damping * (0.3 if best == 0 else 1.0 if best == 1 else 3.0), 1e-6)
        small = small + 1 if gain < TOLERANCE else 0
        if small >= 2:
            break
    return Fitted(misfit, u, states, window, loss)


def normal(misfit: Misfit, reduced: Reduced, weights: FloatArray, u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Gauss-Newton Hessian (k, k) and gradient (k,) of half the loss, priors included; shared errors last."""
    windows, samples, k = reduced.by_unknown.shape
    j = reduced.by_unknown.reshape(windows * samples, k)
    weighted = np.repeat(weights, samples)[:, None] * j
    hessian, gradient = weighted.T @ j, reduced.residual.ravel() @ weighted
    precision, slope = misfit.prior_normal(u)
    return hessian + precision, gradient + slope


def _ahead(
    misfit: Misfit, linear: Linear, reduced: Reduced, normals: tuple[FloatArray, FloatArray], u: FloatArray,
    change: FloatArray,
) -> float:  # fmt: skip
    """What a step, and the best states, would gain if all were linear: where that is nothing the fit has ended."""
    hessian, gradient = normals
    inside = np.concatenate([clip(misfit.unknowns, u + change[: u.size]) - u, change[u.size :]])
    along = np.einsum("wms,wm->ws", reduced.basis, linear.residual)
    states = misfit.weights(linear.residual) @ np.sum(along**2, axis=1)
    return float(states - inside @ (2.0 * gradient + hessian @ inside))


def _step(misfit: Misfit, hessian: FloatArray, gradient: FloatArray, u: FloatArray, damping: float) -> FloatArray:
    """The damped step, with coordinates that push against a bound held."""
    step = np.zeros(gradient.size)
    bounds = np.array([x.bounds for x in misfit.unknowns]).reshape(-1, 2)
    own = gradient[: u.size]
    held = np.zeros(gradient.size, bool)
    held[: u.size] = ((u <= bounds[:, 0]) & (own > 0.0)) | ((u >= bounds[:, 1]) & (own < 0.0))
    free = np.flatnonzero(~held)
    if free.size:
        part = hessian[np.ix_(free, free)]
        scale = np.diag(part) + 1e-9 * (np.max(np.diag(part)) + 1e-12)
        step[free] = -np.linalg.solve(part + damping * np.diag(scale) + 1e-12 * np.eye(free.size), gradient[free])
    return step
