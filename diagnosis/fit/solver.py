"""Levenberg-Marquardt over the shared parameters, the windows' states eliminated.

Each iteration runs all windows for all differences in one batch, then for some dampings and state
steps in another. Given the parameters the windows are independent, so every window keeps the state
step that suits it best: one stuck window does not hold up the others. Near the minimum the whole step
is taken at once, with the differences about where it leads. The level of the errors that
windows share moves with the parameters; it is linear and costs no runs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from diagnosis.data.measured import Measured
from diagnosis.fit.bounded import bounded_step
from diagnosis.fit.misfit import NU, Asking, Linear, Misfit, Reduced, answered, reduce
from diagnosis.fit.prediction import Point, Predictor
from diagnosis.fit.unknowns import clip, values_of
from models.base import FloatArray
from models.errors import InputError

DAMPINGS = (0.0, 0.03, 0.3, 3.0)
"""Dampings tried at once, over the one that the step before leads to."""
LESS, MORE = 0.3, 3.0
"""Damping after a step, over that before: less, but more where the step that was damped most was the best."""
STATE_STEPS = (1.0, 0.3, 0.0)
ITERATIONS = 14
TOLERANCE = 0.02
"""Gain in 2 log likelihood, expected or reached in two iterations, under which the fit ends."""
BADLY, SCATTERED = 1.5, 256
"""Squared misfit per sample of a stuck window (over that of most windows), and the states tried for it."""
NARROW, WIDEST = 0.05, 0.25
"""Widths of the scatter, over that of the states among the windows."""
PROMISING, AT_STUCK = 2, 6
"""How many of the best are fitted, over the number of states, beside the measured one; iterations of these fits."""
SCATTERINGS = 3
CLEARLY = 1.0
"""What other states must gain in a window."""
HOPE = 3.0
"""Times what is ahead if all were linear that a fit is trusted to gain; one that needs more is given up."""
NEAR, GOOD = 0.1, 0.75
"""Where all ahead is such a share of the loss the whole step alone is tried, and taken if it gains as much of it."""


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
    """The minimum; windows that are stuck there start again from scattered states.

    The level of the errors that windows share may have gone astray with them: it starts again as well, or, where the
    fit then ends above, from where it was.
    """
    found = fit(misfit, u, states)
    for seed in range(SCATTERINGS):
        better = scatter(found, seed)
        if better is None:
            break
        restarted = fit(misfit, found.u, better)
        found = restarted if restarted.loss < found.loss else fit(found.misfit, found.u, better)
    return found


def scatter(found: Fitted, seed: int) -> FloatArray | None:
    """States (W, S) with better ones for windows that misfit badly; None if there are none."""
    each = np.expm1(found.window_losses / (NU * found.measured.count)) * NU
    return scattered(found, each > BADLY * max(1.0, float(np.median(each))), seed)


def scattered(found: Fitted, bad: NDArray[np.bool_], seed: int) -> FloatArray | None:
    """States (W, S) with better ones for some of the ``bad`` windows (W,); None if there are none.

    The best of fits from scattered states, around where they are and around those measured: a fit may have left these
    for a motion with other events, under parameters or errors that it no longer has, and lie many deviations away.
    """
    misfit, m = found.misfit, found.measured
    if not found.states.shape[1] or not bad.any():
        return None
    draws = qmc.MultivariateNormalQMC(np.zeros(found.states.shape[1]), seed=seed).random(SCATTERED)
    width = m.state_size * np.where(np.arange(SCATTERED) % 2 == 0, NARROW, WIDEST)[:, None]
    around = np.where((np.arange(SCATTERED) // 2 % 2 == 0)[:, None, None], found.states, m.states)
    trials = around + (draws * width)[:, None, :]

    def losses(states: FloatArray) -> FloatArray:
        return misfit.losses(misfit.residuals([misfit.point(found.u, x) for x in states], only=bad))

    stuck, count = np.flatnonzero(bad), PROMISING * m.states.shape[1]
    starts = np.repeat(m.states[None, stuck], count + 1, axis=0)
    starts[1:] = trials[np.argsort(losses(trials)[:, stuck], axis=0)[:count], stuck]
    return from_states(found, stuck, starts)


def from_states(found: Fitted, windows: NDArray[np.intp], starts: FloatArray) -> FloatArray | None:
    """States (W, S) with better ones in some of the ``windows`` (n,): the ends of fits from ``starts`` (k, n, S).

    The parameters as they are; None where no window is better off.
    """
    misfit, m = found.misfit, found.measured
    tried = found.frozen.of_windows(np.tile(windows, len(starts)))
    fitted = fit(tried, np.zeros(0), starts.reshape(-1, starts.shape[2]), AT_STUCK)
    ends = np.repeat(found.states[None], len(starts), axis=0)
    ends[:, windows] = fitted.states.reshape(starts.shape)
    own = np.isin(np.arange(len(m.windows)), windows)
    ended = misfit.losses(misfit.residuals([misfit.point(found.u, x) for x in ends], only=own))
    pick = np.argmin(ended, axis=0)
    better = own & (ended.min(axis=0) < found.window_losses - CLEARLY)
    if not better.any():
        return None
    return np.where(better[:, None], ends[pick, np.arange(pick.size)], found.states)


@dataclass(frozen=True)
class Place:
    """Where a fit stands, and what is ahead if all were linear there."""

    misfit: Misfit
    u: FloatArray
    states: FloatArray
    linear: Linear
    reduced: Reduced
    window: FloatArray
    loss: float
    fresh: bool = True
    """Whether the derivatives were taken here."""

    @classmethod
    def at(cls, misfit: Misfit, u: FloatArray, states: FloatArray) -> Asking[Place]:
        linear = yield from misfit.linearising(u, states, one_sided=True)
        window = misfit.losses(linear.residual)
        return cls(misfit, u, states, linear, reduce(linear), window, float(window.sum()) + misfit.prior(u))

    def followed(self, misfit: Misfit, u: FloatArray, states: FloatArray) -> Asking[Place]:
        """Another place near this one, its derivatives taken to be the same."""
        predicted = yield [misfit.point(u, states)]
        residual = misfit.whitened(predicted)[0]
        window = misfit.losses(residual)
        linear, reduced = replace(self.linear, residual=residual), self.reduced.at(residual)
        loss = float(window.sum()) + misfit.prior(u)
        return Place(misfit, u, states, linear, reduced, window, loss, fresh=False)

    @cached_property
    def normals(self) -> tuple[FloatArray, FloatArray]:
        return normal(self.misfit, self.reduced, self.misfit.weights(self.linear.residual), self.u)

    @cached_property
    def gain(self) -> float:
        """What the whole step, and the best states, would gain: where that is nothing the fit has ended."""
        hessian, gradient = self.normals
        change = self.change(0.0)
        inside = np.concatenate([self.moved(change) - self.u, change[self.u.size :]])
        along = np.einsum("wms,wm->ws", self.reduced.basis, self.linear.residual)
        states = self.misfit.weights(self.linear.residual) @ np.sum(along**2, axis=1)
        return float(states - inside @ (2.0 * gradient + hessian @ inside))

    @cached_property
    def promised(self) -> float:
        """The loss that `HOPE` times what is ahead leads to, were the residuals linear (the loss of each is not)."""
        change = self.change(0.0)
        u, misfit = self.moved(change), self.misfit.at_level(self.level(change))
        step = np.concatenate([u - self.u, change[self.u.size :]])
        ahead = misfit.losses(self.reduced.residual + self.reduced.by_unknown @ step)
        return self.loss - HOPE * (self.loss - float(ahead.sum()) - misfit.prior(u))

    def change(self, damping: float) -> FloatArray:
        """Of the unknowns, within their bounds, and the level of the shared errors."""
        hessian, gradient = self.normals
        low, high = (np.full(gradient.size, end) for end in (-np.inf, np.inf))
        if self.u.size:
            low[: self.u.size], high[: self.u.size] = np.array([x.bounds for x in self.misfit.unknowns]).T - self.u
        return bounded_step(hessian, gradient, low, high, damping)

    def moved(self, change: FloatArray) -> FloatArray:
        return clip(self.misfit.unknowns, self.u + change[: self.u.size])

    def level(self, change: FloatArray) -> FloatArray:
        return self.misfit.level + change[self.u.size :]

    def shift(self, change: FloatArray) -> FloatArray:
        """Of the states (W, S) that suits a change of the unknowns: min |r + B x|^2 + |x/largest|^2, window by window.

        A combination of states that the window does not tell stays where it is; cut one by one, those that belong
        together would no longer fit each other.
        """
        step = np.concatenate([self.moved(change) - self.u, change[self.u.size :]])
        ahead = self.linear.residual + self.linear.by_unknown @ step
        largest = np.maximum(np.abs(self.states), self.misfit.measured.state_size)
        columns = self.linear.by_state * largest[:, None, :]
        hessian = np.swapaxes(columns, 1, 2) @ columns + np.eye(columns.shape[-1])
        gradient = np.einsum("wms,wm->ws", columns, ahead)
        return np.asarray(-largest * np.linalg.solve(hessian, gradient[..., None])[..., 0])


def fit(
    misfit: Misfit, u: FloatArray, states: FloatArray, iterations: int = ITERATIONS, most: float = np.inf
) -> Fitted:
    """The minimum of the loss next to (u, states); where it promises no loss of ``most``, given up after a step."""
    return answered(_fitting(misfit, u, states, iterations, most), misfit.predictor)


def fit_together(
    misfits: Sequence[Misfit], u: FloatArray, states: FloatArray, iterations: int = ITERATIONS
) -> list[Fitted]:
    """The same of misfits that differ in the stages of their predictors alone: what they ask for runs side by side."""
    asking = [_fitting(one, u, states, iterations) for one in misfits]
    found: dict[int, Fitted] = {}
    asked = {k: next(one) for k, one in enumerate(asking)}
    while asked:
        points = {k: [replace(p, stages=misfits[k].predictor.stages) for p in own] for k, own in asked.items()}
        for k, answer in _answers(misfits[0].predictor, points).items():
            try:
                asked[k] = asking[k].throw(answer) if isinstance(answer, InputError) else asking[k].send(answer)
            except StopIteration as end:
                found[k] = end.value
                del asked[k]
    return [found[k] for k in range(len(misfits))]


def _answers(predictor: Predictor, asked: Mapping[int, Sequence[Point]]) -> dict[int, FloatArray | InputError]:
    """The predictions that each asks for, run side by side; where the model refuses some parameters, one by one."""
    try:
        predicted = predictor.predict([p for own in asked.values() for p in own])
    except InputError as refusal:
        if len(asked) == 1:
            return dict.fromkeys(asked, refusal)
        return {k: answer for k, own in asked.items() for answer in _answers(predictor, {k: own}).values()}
    ends = np.cumsum([len(own) for own in asked.values()])
    return dict(zip(asked, np.split(predicted, ends[:-1]), strict=True))


def _fitting(
    misfit: Misfit, u: FloatArray, states: FloatArray, iterations: int, most: float = np.inf
) -> Asking[Fitted]:
    u = clip(misfit.unknowns, np.asarray(u, float))
    if not iterations:
        predicted = yield [misfit.point(u, states)]
        window = misfit.losses(misfit.whitened(predicted))[0]
        return Fitted(misfit, u, states, window, float(window.sum()) + misfit.prior(u))
    place = yield from Place.at(misfit, u, states)
    damping, small, bold, moved = 1.0, 0, True, False
    for _ in range(iterations):
        best, further = 0, None
        try:
            if not place.fresh:  # derivatives of another place say where to go, not that this is the end
                place = yield from Place.at(place.misfit, place.u, place.states)
            if place.gain < TOLERANCE or (moved and place.promised > most):
                break
            if bold and place.gain < NEAR * place.loss:
                further = yield from _whole(place)
            if further is None:
                best, further = yield from _search(place, damping)
        except InputError:  # the steps led where the model refuses its parameters: shorter ones may not
            damping, bold = 10.0 * damping, False
            continue
        bold = best == 0 and further is not None
        if further is None:
            damping *= 10.0
            small += 1
            if small >= 2:
                break
            continue
        gain, place, moved = place.loss - further.loss, further, True
        damping = max(damping * (MORE if best == len(DAMPINGS) - 1 else LESS), 1e-6)
        small = small + 1 if gain < TOLERANCE else 0
        if small >= 2:
            break
    return Fitted(place.misfit, place.u, place.states, place.window, place.loss)


def _whole(place: Place) -> Asking[Place | None]:
    """Undamped steps with the derivatives of ``place`` as long as each gains what it should; None if none does."""
    here = place
    while here.gain >= TOLERANCE:
        change = here.change(0.0)
        misfit, states = here.misfit.at_level(here.level(change)), here.states + here.shift(change)
        further = yield from here.followed(misfit, here.moved(change), states)
        if here.loss - further.loss <= GOOD * here.gain:
            break
        here = further
    return None if here is place else here


def _search(place: Place, damping: float) -> Asking[tuple[int, Place | None]]:
    """The best of some dampings, with the best step of the states in each window; None where nothing is gained."""
    misfit, states, residual = place.misfit, place.states, place.linear.residual
    shared = place.linear.by_unknown.shape[-1] > 0  # without, no damping changes anything
    changes = [place.change(damping * d) for d in (DAMPINGS if shared else DAMPINGS[:1])]
    shares = STATE_STEPS if states.shape[1] else STATE_STEPS[:1]
    steps, moved = [place.moved(change) for change in changes], []
    for change in changes:
        shift = place.shift(change)
        moved.append([states + share * shift for share in shares])
    points = [misfit.point(u, x) for u, each in zip(steps, moved, strict=True) for x in each]
    try:
        predicted = yield points
    except InputError:
        predicted = yield from _where_it_runs(points)
    residuals = misfit.whitened(predicted).reshape(len(steps), len(shares), *residual.shape)
    if misfit.level.size:
        own = place.u.size
        residuals += np.stack([place.linear.by_unknown[..., own:] @ change[own:] for change in changes])[:, None]
    losses = misfit.losses(residuals)
    pick = np.argmin(losses, axis=1)
    window = np.take_along_axis(losses, pick[:, None, :], axis=1)[:, 0].sum(axis=1)
    levels = [misfit.at_level(place.level(change)) for change in changes]
    totals = window + [at.prior(u) for u, at in zip(steps, levels, strict=True)]
    best = int(np.argmin(totals))
    if totals[best] >= place.loss:
        return best, None
    chosen = np.stack(moved[best])[pick[best], np.arange(states.shape[0])]
    further = yield from Place.at(levels[best], steps[best], chosen)
    return best, further


def _where_it_runs(points: Sequence[Point]) -> Asking[FloatArray]:
    """Predictions (P, W, C, N), nan of points where the model refuses its parameters; InputError if it does at all."""
    found: list[FloatArray | None] = []
    why: InputError | None = None
    for point in points:
        try:
            found.append((yield [point])[0])
        except InputError as refusal:
            found.append(None)
            why = refusal
    runs = [one for one in found if one is not None]
    if not runs and why is not None:
        raise why
    return np.stack([np.full_like(runs[0], np.nan) if one is None else one for one in found])


def normal(misfit: Misfit, reduced: Reduced, weights: FloatArray, u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Gauss-Newton Hessian (k, k) and gradient (k,) of half the loss, priors included; shared errors last."""
    windows, samples, k = reduced.by_unknown.shape
    j = reduced.by_unknown.reshape(windows * samples, k)
    weighted = np.repeat(weights, samples)[:, None] * j
    hessian, gradient = weighted.T @ j, reduced.residual.ravel() @ weighted
    precision, slope = misfit.prior_normal(u)
    return hessian + precision, gradient + slope
