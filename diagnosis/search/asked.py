"""In which run of windows the recordings ask for a mechanism, the base parameters refitted for each run.

With the mechanism acting in all windows, and in none, the residuals and their derivatives are taken once. A model in
which it acts in a run A of the windows has the first within A and the second elsewhere, so one Gauss-Newton step gives
its loss,

    L_A = sum of L_w - g_A' H_A^-1 g_A,      g_A, H_A: gradient and Hessian of half the loss, summed over all windows.

With the base parameters held, those that made up for the effect in the wrong windows would hold it there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from diagnosis.fit.misfit import reduce
from diagnosis.fit.solver import Fitted, fit
from diagnosis.search.instants import NO_UNKNOWNS, WHOLE
from diagnosis.search.refit import QUICK, Explanation, ways, without
from diagnosis.search.runs import over_runs, runs, runs_of
from diagnosis.search.spells import NEVER, InEach, Spell, When, holds, in_spell, interval_of, of_windows
from models.base import FloatArray

LARGEST = 2.0
"""Standard deviation of a step of a coordinate: further off the linear problem means nothing."""
ROUNDS = 4
NOWHERE = np.array([[0, -1]], np.int64)
"""A run of no window."""
AnyWhen = TypeVar("AnyWhen", Spell, InEach)


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


@dataclass(frozen=True)
class _Runs:
    """The two sets of residuals of one way of an explanation, and the priors."""

    acting: _Windows
    never: _Windows
    prior: float
    slope: FloatArray
    precision: FloatArray

    @classmethod
    def of(cls, single: Explanation) -> _Runs:
        candidate, f = single.candidates[-1], single.fitted
        always = replace(f, misfit=in_spell(f.misfit, candidate.name, None))
        acting, never = _Windows.of(always), _Windows.of(without(single, candidate, 0).fitted)
        size, own = f.u.size + f.misfit.level.size, {x.name for x in candidate.unknowns}
        shared = [i for i, x in enumerate(f.misfit.unknowns) if x.name not in own]
        never = never.among(np.array([*shared, *range(f.u.size, size)], np.int64), size)
        precision, slope = f.misfit.prior_normal(f.u)
        precision = precision + np.diag(np.where(np.arange(size) < f.u.size, LARGEST**-2, 0.0))
        return cls(acting, never, f.misfit.prior(f.u), slope, precision)

    def losses(self, ends: NDArray[np.int64], also: NDArray[np.bool_]) -> FloatArray:
        """Loss (R,) with the mechanism in each of the runs ``ends`` (R, 2) and in the windows ``also`` (W,) outside."""

        def over(acting: FloatArray, never: FloatArray, held: FloatArray | float = 0.0) -> FloatArray:
            added = acting - never
            plain = never.sum(axis=0) + added[also].sum(axis=0) + held
            return np.asarray(plain + np.moveaxis(over_runs(np.moveaxis(added, 0, -1), ends), -1, 0))

        loss = over(self.acting.loss, self.never.loss)
        gradient = over(self.acting.gradient, self.never.gradient, self.slope)
        hessian = over(self.acting.hessian, self.never.hessian, self.precision)
        step = np.linalg.solve(hessian, gradient[..., None])[..., 0]
        return np.asarray(loss + self.prior - np.sum(gradient * step, axis=1))


def asked_for(single: Explanation) -> When:
    """When the recordings ask for the last mechanism: one spell, or in each, as it is; simple ends are preferred."""
    spell = single.candidates[-1].spell
    return _in_each(single, spell) if isinstance(spell, InEach) else asked_in_a_spell(single)


def asked_in_a_spell(single: Explanation) -> Spell:
    """The spell of the run with the lowest loss; a run that begins or ends with a recording is simpler."""
    m = single.measured
    ends = runs(len(m.windows))
    return _simplest(losses(single, ends), [of_windows(m, *end) for end in ends.tolist()])


def losses(single: Explanation, ends: NDArray[np.int64]) -> FloatArray:
    """Loss (R,) of the explanation with its last mechanism in each of the runs ``ends`` (R, 2) of windows alone."""
    nowhere = np.zeros(len(single.measured.windows), bool)
    return np.asarray(np.min([_Runs.of(way).losses(ends, nowhere) for way in ways(single)], axis=0))


def _in_each(single: Explanation, spell: InEach) -> InEach:
    """The run of each recording with the lowest loss, those of the other recordings held, in turn."""
    m = single.measured
    problems = [_Runs.of(way) for way in ways(single)]
    now = list(spell.intervals)
    for _ in range(ROUNDS):
        before = list(now)
        for r in np.unique(m.recording_of).tolist():
            also = np.array([m.recording_of[k] != r and holds(m, InEach(tuple(now)), k) for k in range(len(m.windows))])
            ends = runs_of(m.recording_of, r)
            loss = np.min([problem.losses(ends, also) for problem in problems], axis=0)
            never = min(float(problem.losses(NOWHERE, also)[0]) for problem in problems)
            options = [InEach((interval_of(m, *end),)) for end in ends.tolist()]
            now[r] = _simplest(np.append(loss, never), [*options, InEach((NEVER,))]).intervals[0]
        if now == before:
            break
    return InEach(tuple(now))


def _simplest(loss: FloatArray, options: Sequence[AnyWhen]) -> AnyWhen:
    """The option with the lowest loss, instants within a recording paid for."""
    return options[int(np.argmin([value + WHOLE * one.instants for value, one in zip(loss, options, strict=True)]))]
