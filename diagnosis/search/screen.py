"""The screen: how much each mechanism could explain, before any refit.

With residuals r and derivatives d of the effect's parameter, both projected off the states and the
base parameters (weights and priors included), the score (Lagrange multiplier) statistic is

    S = (d'r)^2 / d'd,      one-sided where the null is a bound: 0 when the best step leaves it.

Where what shapes the effect keeps it from acting (a permanent set that begins beyond a strain that is not reached) the
derivative is taken at other values of the shape.

A null at infinity or with a threshold (sliding, flight, a filter without lag) has no usable derivative at all: there
the model is run on a grid of values and the statistic is the largest gain over the grid, the base parameters and states
answering linearly.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnosis.fit.linearisation import Linearisation
from diagnosis.fit.misfit import STEP
from diagnosis.fit.prediction import Point
from diagnosis.search.candidates import Candidate
from diagnosis.search.spells import in_spell
from models.base import FloatArray
from models.errors import InputError
from models.runs import DONE

Reduced = Callable[[Sequence[FloatArray]], FloatArray]
"""Residuals (n, W, M) off the states at n coordinates of a candidate."""

NO_SLOPE = 1e-12
"""Information of a derivative from which down there is none."""
FAINT = 4.0
"""Change (2 log likelihood) by an effect at the end of its range up to which what shapes it may keep it from acting."""


@dataclass(frozen=True)
class Score:
    """``statistic``: the larger of score and grid gain; ``starts``: coordinates (d,) worth a refit, best first.

    ``column`` (W, M): the direction in which the effect moves the residuals, off the states: the derivative at a null
    if it is a ``slope``, else the change by the best of the grid, which may be worth a refit in a part of the
    recordings though it is not in all; ``trial`` (d,): that null or that best; ``side``: the sign that an amplitude
    along it may have, 0 for either; ``work``: lane-steps of one trial.
    """

    candidate: Candidate
    statistic: float
    starts: tuple[FloatArray, ...]
    column: FloatArray
    slope: bool = True
    side: int = 0
    work: float = 0.0
    trial: FloatArray | None = None

    def starts_from(self, amplitude: float) -> list[FloatArray]:
        """Coordinates (d,) worth a refit in a part of the recordings, from its ``amplitude`` there along the column."""
        found = list(self.starts[:1])
        if self.trial is None:
            return found
        if self.slope:
            start = self.trial.copy()
            start[0] += amplitude
            return [start, *found]
        return found or [self.trial]


def score(
    screen: Linearisation,
    candidates: Sequence[Candidate],
    not_tried: dict[str, str] | None = None,
    small: bool = False,
) -> list[Score]:
    """Statistics of all candidates, strongest first; why the model refuses the others goes into ``not_tried``.

    ``small``: any effect can only be small, and derivatives are enough where there are any at its null.
    """
    base = screen.fitted.misfit.point(screen.fitted.u, screen.fitted.states)
    found = []
    for candidate in candidates:
        try:
            found.append(_score_one(screen, base, candidate, small))
        except InputError as refusal:  # it does not act together with a mechanism that is switched on
            if not_tried is not None:
                not_tried.setdefault(candidate.name, str(refusal))
    return sorted(found, key=lambda s: -s.statistic)


def _score_one(screen: Linearisation, base: Point, candidate: Candidate, small: bool) -> Score:
    misfit = in_spell(screen.fitted.misfit, candidate.name, candidate.spell)

    def reduced(trials: Sequence[FloatArray]) -> FloatArray:
        return screen.reduced(misfit.residuals([at(base, candidate, u) for u in trials]))

    by_slopes = _by_slopes(screen, candidate, reduced) if small and not candidate.steep else None
    return by_slopes or _by_values(screen, candidate, reduced)


def _by_slopes(screen: Linearisation, candidate: Candidate, reduced: Reduced) -> Score | None:
    """The largest score over the shapes of an effect; None without a derivative, or with a faint one and no shapes."""
    low, high = candidate.unknowns[0].bounds
    begin, nulls = DONE.steps, list(candidate.shapes())
    slopes = _slopes(nulls, low, high, reduced)
    work = (DONE.steps - begin) / (2 * len(nulls))
    information = [screen.product(slope, slope) for slope in slopes]
    least = NO_SLOPE if len(nulls) > 1 else max(NO_SLOPE, FAINT / _reach(candidate) ** 2)
    if max(information) <= least:
        return None
    found = [_step(screen, *one, low, high) for one in zip(slopes, information, nulls, strict=True)]
    order = sorted(range(len(found)), key=lambda k: -found[k][0])
    starts = tuple(found[k][1] for k in order[:2] if found[k][0] > 0.0)
    first = order[0]
    return Score(candidate, found[first][0], starts, slopes[first], True, _side(candidate), work, nulls[first])


def _by_values(screen: Linearisation, candidate: Candidate, reduced: Reduced) -> Score:
    """The larger of the score and of the largest gain at values over the range of an effect and of its shapes."""
    null, trials = candidate.null, [] if candidate.steep else list(candidate.grid())
    low, high = candidate.unknowns[0].bounds
    near, begin = _near(null, low, high), DONE.steps
    off = reduced([*near, *trials])
    work = (DONE.steps - begin) / len(off)
    derivative, off = _slope(off[:2], near), off[2:]
    information = screen.product(derivative, derivative)
    if information * _reach(candidate) ** 2 <= FAINT and len(null) > 1:
        nulls = [null, *candidate.nulls()]
        slopes = _slopes(nulls, low, high, reduced)
        most = int(np.argmax([screen.product(slope, slope) for slope in slopes]))
        null, derivative = nulls[most], slopes[most]
        information = screen.product(derivative, derivative)
    slope = information > NO_SLOPE and not candidate.steep
    best, start = _step(screen, derivative, information, null, low, high) if slope else (0.0, null)
    if not slope:
        trials = list(candidate.grid(finely=True))
        off = reduced(trials)
    gains = np.array([_gain(screen, column) for column in off])
    order = np.argsort(-gains)[:2]
    starts = [trials[int(i)] for i in order if gains[i] > 0.0]
    if best > 0.0:
        starts.insert(0 if not gains.size or best * 0.8 > gains[order[0]] else 1, start)
    statistic = max(best, float(gains.max(initial=0.0)))
    if slope or not order.size:
        return Score(candidate, statistic, tuple(starts[:2]), derivative, True, _side(candidate), work, null)
    first = int(order[0])
    return Score(candidate, statistic, tuple(starts[:2]), off[first] - screen.residual, False, 1, work, trials[first])


def _step(
    screen: Linearisation, derivative: FloatArray, information: float, null: FloatArray, low: float, high: float
) -> tuple[float, FloatArray]:
    """Score statistic and the coordinates (d,) of the best step from a null; 0 where that leaves the range."""
    if information <= NO_SLOPE:
        return 0.0, null
    step = -screen.scores_with_residual(derivative) / information
    statistic = step**2 * information
    if not np.isfinite(statistic) or (null[0] >= high if step > 0.0 else null[0] <= low):
        return 0.0, null
    start = null.copy()
    start[0] = np.clip(null[0] + step, low, high)
    return float(statistic), start


def _side(candidate: Candidate) -> int:
    """The sign that an amplitude along the derivative may have, 0 for either."""
    return 0 if not candidate.one_sided else 1 if candidate.null[0] < candidate.unknowns[0].bounds[1] else -1


def _reach(candidate: Candidate) -> float:
    """How far the effect's parameter can go from its null."""
    low, high = candidate.unknowns[0].bounds
    return float(max(high - candidate.null[0], candidate.null[0] - low))


def _near(null: FloatArray, low: float, high: float) -> tuple[FloatArray, FloatArray]:
    """Coordinates (d,) just below and just above a null, within the range of the effect's parameter."""
    below, above = null.copy(), null.copy()
    below[0], above[0] = min(max(null[0] - STEP, low), null[0]), min(max(null[0] + STEP, low), high)
    return below, above


def _slopes(nulls: Sequence[FloatArray], low: float, high: float, reduced: Reduced) -> list[FloatArray]:
    """The derivative (W, M) at every null, all run together."""
    pairs = [_near(null, low, high) for null in nulls]
    off = reduced([u for pair in pairs for u in pair])
    return [_slope(off[2 * k : 2 * k + 2], pair) for k, pair in enumerate(pairs)]


def _slope(off: FloatArray, near: tuple[FloatArray, FloatArray]) -> FloatArray:
    return np.asarray((off[1] - off[0]) / (near[1][0] - near[0][0]))


def _gain(screen: Linearisation, off: FloatArray) -> float:
    """Gain of a trial in 2 log likelihood, states and base parameters answering linearly."""
    change = off - screen.residual
    return -2.0 * screen.scores_with_residual(change) - screen.product(change, change)


def at(base: Point, candidate: Candidate, u: FloatArray) -> Point:
    """A point with the candidate's coordinates."""
    values = {x.name: x.value(float(c)) for x, c in zip(candidate.unknowns, u, strict=True)}
    return replace(base, values={**base.values, **candidate.held, **values})
