"""The screen for effects that begin or end: every mechanism in every run of successive windows, without a new run.

A mechanism that acts in a run A of the windows alone moves their residuals only, so its score statistic follows from
the sums over A of what the ordinary screen has for each window w,

    S_A = (s_A - a_A' H^-1 g)^2 / (i_A - a_A' H^-1 a_A),      s_w = d_w'r_w,  i_w = d_w'd_w,  a_w = J_w'd_w,

d the mechanism's column and J the base parameters' derivatives, both off the states; H, g: Hessian and gradient of the
base. The windows of all recordings stand in one row, in the order of the tests.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from diagnosis.fit.linearisation import Linearisation
from diagnosis.search.screen import Score
from models.base import FloatArray

SHORTEST = 2
"""Windows of a run: one alone must not decide."""
FEWEST = 1e-3
"""Information of a run over that of all windows under which it is not tried."""
DRAWS, AT_ONCE = 1000, 100
LEVEL = 0.05


@dataclass(frozen=True)
class InRuns:
    """One mechanism's statistic in every run (R,), 0 where it would act to the wrong side, and its amplitude there."""

    score: Score
    statistic: FloatArray
    amplitude: FloatArray

    def starts(self, run: int) -> list[FloatArray]:
        """Coordinates (d,) worth a refit in one run."""
        return self.score.starts_from(float(self.amplitude[run]))


def runs(windows: int) -> NDArray[np.int64]:
    """First and last window (R, 2) of every run but the whole row."""
    found = [(a, b) for a in range(windows) for b in range(a + SHORTEST - 1, windows) if b - a + 1 < windows]
    return np.array(found, np.int64).reshape(-1, 2)


def runs_of(recording_of: NDArray[np.int64], recording: int) -> NDArray[np.int64]:
    """First and last window (R, 2) of every run within one recording; the whole of it is the last one."""
    own = np.flatnonzero(recording_of == recording)
    return np.asarray(own[0] + np.concatenate([runs(own.size), [[0, own.size - 1]]]), np.int64)


def largest_run(values: FloatArray) -> tuple[int, int]:
    """First and last place of the run of at least `SHORTEST` places with the largest sum."""
    total = np.concatenate([[0.0], np.cumsum(values)])
    place, shortest = np.arange(total.size), min(SHORTEST, values.size)
    sums = np.where(place[:, None] + shortest <= place, total[None, :] - total[:, None], -np.inf)
    low, high = np.unravel_index(int(np.argmax(sums)), sums.shape)
    return int(low), int(high) - 1


def in_runs(screen: Linearisation, scores: Sequence[Score], ends: NDArray[np.int64]) -> list[InRuns]:
    """The statistics of all mechanisms in the runs ``ends`` (R, 2)."""
    found = []
    for one in scores:
        sums = _Sums.of(screen, one.column, ends)
        along = np.einsum("w,wm,wm->w", screen.weights, one.column, screen.residual)
        amount = over_runs(along, ends) - sums.path @ screen.inverse @ screen.gradient
        amplitude = -amount / np.where(sums.usable, sums.free, np.inf)
        found.append(InRuns(one, sums.statistic(amount[None], one.side)[0], amplitude))
    return found


def chance(
    screen: Linearisation, scores: Sequence[Score], ends: NDArray[np.int64], errors: Linearisation | None = None
) -> float:
    """What the largest statistic of all mechanisms in all runs exceeds by chance with 5 % probability."""
    return float(np.quantile(largest_by_chance(screen, scores, ends, errors), 1.0 - LEVEL))


def largest_by_chance(
    screen: Linearisation, scores: Sequence[Score], ends: NDArray[np.int64], errors: Linearisation | None = None
) -> FloatArray:
    """Draws of the largest statistic of all mechanisms in all runs: of noise drawn and screened alike.

    ``errors``: the same fit under the errors as they are, if the screen is against others.
    """
    rng = np.random.default_rng(0)
    # what priors hold may lie off their means too: without it the base parameters would take up more than they do
    values, vectors = np.linalg.eigh(screen.fitted.misfit.prior_normal(screen.fitted.u)[0])
    of_priors = np.sqrt(np.maximum(values, 0.0)) * vectors
    sums = [_Sums.of(screen, one.column, ends) for one in scores]
    largest = np.zeros(DRAWS)
    for start in range(0, DRAWS, AT_ONCE):
        noise = screen.weights[:, None] * _drawn(screen, errors or screen, rng)
        gradient = np.einsum("wmi,swm->si", screen.by_unknown, noise, optimize=True)
        gradient += rng.normal(size=(AT_ONCE, values.size)) @ of_priors.T
        part = slice(start, start + AT_ONCE)
        for one, of_runs in zip(scores, sums, strict=True):
            along = np.einsum("wm,swm->sw", one.column, noise, optimize=True)
            amount = over_runs(along, ends) - gradient @ screen.inverse @ of_runs.path.T
            largest[part] = np.maximum(largest[part], of_runs.statistic(amount, one.side).max(axis=1, initial=0.0))
    return largest


def _drawn(screen: Linearisation, errors: Linearisation, rng: np.random.Generator) -> FloatArray:
    """Residuals (`AT_ONCE`, W, M) of a screen, of noise as ``errors`` expects it: windows weighed less err more."""
    drawn = rng.normal(size=(AT_ONCE, *errors.residual.shape)) / np.sqrt(errors.weights)[:, None]
    if errors is screen:  # the errors that windows share are among its unknowns
        return drawn
    of, shared = errors.fitted.misfit.whitening, errors.fitted.misfit.whitening.shared
    if shared is not None:
        drawn += np.einsum("wmk,sk->swm", shared, rng.normal(size=(AT_ONCE, shared.shape[2])), optimize=True)
    return screen.fitted.misfit.whitening.of_averages(of.averages(drawn))


@dataclass(frozen=True)
class _Sums:
    """Of one column over the runs: information off the base parameters (R,), and the path along them (R, k)."""

    free: FloatArray
    path: FloatArray
    usable: NDArray[np.bool_]

    @classmethod
    def of(cls, screen: Linearisation, column: FloatArray, ends: NDArray[np.int64]) -> _Sums:
        weighted = screen.weights[:, None] * column
        information = np.einsum("wm,wm->w", weighted, column)
        along = np.einsum("wmi,wm->wi", screen.by_unknown, weighted, optimize=True)
        path = over_runs(along.T, ends).T
        free = over_runs(information, ends) - np.einsum("ri,ij,rj->r", path, screen.inverse, path)
        return cls(free, path, free > FEWEST * max(float(information.sum()), 1e-9))

    def statistic(self, amount: FloatArray, side: int) -> FloatArray:
        """Statistics (s, R) of scores (s, R); ``side``: the sign that the effect's amplitude may have, 0 for either."""
        right = self.usable & ((side * amount <= 0.0) if side else True)
        return np.where(right, amount**2 / np.where(self.usable, self.free, 1.0), 0.0)


def over_runs(values: FloatArray, ends: NDArray[np.int64]) -> FloatArray:
    """Sums of values (..., W) over the runs (..., R)."""
    total = np.concatenate([np.zeros((*values.shape[:-1], 1)), np.cumsum(values, axis=-1)], axis=-1)
    return np.asarray(total[..., ends[:, 1] + 1] - total[..., ends[:, 0]])
