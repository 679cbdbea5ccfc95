"""In which run of windows the recordings ask for a mechanism, the base parameters refitted for each run.

With the mechanism acting in all windows, and in none, the residuals and their derivatives are taken once. A model in
which it acts in a run A of the windows has the first within A and the second elsewhere, so one Gauss-Newton step gives
its loss,

    L_A = sum of L_w - g_A' H_A^-1 g_A,      g_A, H_A: gradient and Hessian of half the loss, summed over all windows.

With the base parameters held, those that made up for the effect in the wrong windows would hold it there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from diagnosis.fit.misfit import reduce
from diagnosis.fit.solver import Fitted, fit
from diagnosis.search.instants import NO_UNKNOWNS, WHOLE
from diagnosis.search.refit import QUICK, Explanation, ways, without
from diagnosis.search.runs import over_runs, runs
from diagnosis.search.spells import Spell, in_spell, of_windows
from models.base import FloatArray

LARGEST = 2.0
"""Standard deviation of a step of a coordinate: further off the linear problem means nothing."""


@dataclass(frozen=True)
class _Windows:
    """Each window's loss (W,), gradient (W, k) and Hessian (W, k, k) of half of it, states eliminated."""

    loss: FloatArray
    gradient: FloatArray
    hessian: FloatArray

    @classmethod
    def of(cls, fitted: Fitted) -> _Windows:
        misfit = fitted.misfit
        states = fit(fitted.frozen, NO_UNKNOWNS, fitted.states, QUICK).states
        linear = misfit.linearise(fitted.u, states)
        reduced = reduce(linear)
        j = reduced.by_unknown
        weighted = misfit.weights(linear.residual)[:, None, None] * j
        gradient = np.einsum("wmi,wm->wi", weighted, reduced.residual, optimize=True)
        return cls(misfit.losses(linear.residual), gradient, np.swapaxes(weighted, 1, 2) @ j)

    def among(self, places: NDArray[np.int64], size: int) -> _Windows:
        """The same with the coordinates at ``places`` of ``size`` ones, the others without effect."""
        gradient = np.zeros((self.loss.size, size))
        hessian = np.zeros((self.loss.size, size, size))
        gradient[:, places] = self.gradient
        hessian[:, places[:, None], places[None, :]] = self.hessian
        return _Windows(self.loss, gradient, hessian)


def asked_for(single: Explanation) -> Spell:
    """The spell of the run with the lowest loss; a run that begins or ends with a recording is simpler."""
    m = single.measured
    ends = runs(len(m.windows))
    loss = losses(single, ends)
    near = np.flatnonzero(loss < loss.min() + 2.0 * WHOLE)
    spells = [of_windows(m, *ends[k].tolist()) for k in near]
    return spells[int(np.argmin([value + WHOLE * one.instants for value, one in zip(loss[near], spells, strict=True)]))]


def losses(single: Explanation, ends: NDArray[np.int64]) -> FloatArray:
    """Loss (R,) of the explanation with its last mechanism in each of the runs ``ends`` (R, 2) of windows alone."""
    return np.asarray(np.min([_losses(way, ends) for way in ways(single)], axis=0))


def _losses(single: Explanation, ends: NDArray[np.int64]) -> FloatArray:
    candidate, f = single.candidates[-1], single.fitted
    always = replace(f, misfit=in_spell(f.misfit, candidate.name, None))
    acting, never = _Windows.of(always), _Windows.of(without(single, candidate, 0).fitted)
    size, own = f.u.size + f.misfit.level.size, {x.name for x in candidate.unknowns}
    shared = [i for i, x in enumerate(f.misfit.unknowns) if x.name not in own]
    never = never.among(np.array([*shared, *range(f.u.size, size)], np.int64), size)
    precision, slope = f.misfit.prior_normal(f.u)
    precision = precision + np.diag(np.where(np.arange(size) < f.u.size, LARGEST**-2, 0.0))
    loss = never.loss.sum() + over_runs(acting.loss - never.loss, ends)
    gradient = never.gradient.sum(axis=0) + slope + over_runs((acting.gradient - never.gradient).T, ends).T
    hessian = never.hessian.sum(axis=0) + precision + over_runs((acting.hessian - never.hessian).T, ends).T
    step = np.linalg.solve(hessian, gradient[..., None])[..., 0]
    return np.asarray(loss + f.misfit.prior(f.u) - np.sum(gradient * step, axis=1))
