"""A lognormal fragility by maximum likelihood, with intervals that know which cells share a motion.

P(event | x) = Phi(ln(x/theta)/beta), theta the median capacity, beta the logarithmic standard deviation (Shinozuka,
Feng, Lee, Naganuma, J. Eng. Mech. 126, 2000; Baker, Earthquake Spectra 31, 2015). It is fitted as a probit of ln x.

Cells under one motion at several scales are not independent. The covariance is therefore the delete-one-motion
jackknife (G - 1)/G sum (t_g - mean t)(t_g - mean t)^T over the G motions, with quantiles of Student's t, G - 1 degrees
of freedom (Tukey; for clusters: Cameron and Miller, J. Human Resources 50, 2015), about the estimate freed of its bias
by the same jackknife, for the likelihood finds dispersions too small. It is never taken below what G exact capacities
would leave open, beta^2/G of ln theta and 1/(2 G) of ln beta (Cramer and Rao).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import log_ndtr, ndtr
from scipy.stats import t as student

from models.base import FloatArray

ROUNDS, TOLERANCE = 60, 1e-10
FEWEST_MOTIONS = 5
"""Below that no interval is given."""


@dataclass(frozen=True)
class Lognormal:
    """``median`` theta and ``dispersion`` beta as (estimate, low, high), nan where they cannot be fitted (see ``why``).

    ``coefficients`` are those of the probit, P = Phi(a + b ln x); ``replicates`` ``(G, 2)`` the same without one
    motion each, nan without an interval.
    """

    median: tuple[float, float, float]
    dispersion: tuple[float, float, float]
    coefficients: FloatArray
    replicates: FloatArray
    quantile: float
    why: str = ""

    def probability(self, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """P (n,) at intensities ``x`` (n,), and the ends of its pointwise interval."""
        rows = np.vstack([np.ones(x.size), np.log(x)])
        index = self.coefficients @ rows
        least = (1.0 + index**2 / 2) / self.replicates.shape[0]
        low, high = _interval(index, self.replicates @ rows, least, self.quantile)
        return ndtr(index), ndtr(low), ndtr(high)


def fit_lognormal(x: FloatArray, y: FloatArray, motion: FloatArray, confidence: float = 0.95) -> Lognormal:
    """The fit to intensities ``x`` (n,) > 0, outcomes ``y`` (n,) of 0 and 1, and each cell's ``motion`` by number."""
    levels, level = np.unique(x, return_inverse=True)
    names, number = np.unique(motion, return_inverse=True)
    cells, events = (np.zeros((names.size, levels.size)) for _ in range(2))
    np.add.at(cells, (number, level), 1.0)
    np.add.at(events, (number, level), y)
    (whole,), (why,) = _probit(np.log(levels), cells.sum(axis=0)[None], events.sum(axis=0)[None])
    quantile = float(student.ppf(0.5 + confidence / 2, max(names.size - 1, 1)))
    nowhere = (np.nan, np.nan, np.nan)
    if why:
        return Lognormal(nowhere, nowhere, whole, np.full((1, 2), np.nan), quantile, why)
    replicates = np.full((1, 2), np.nan)
    if names.size < FEWEST_MOTIONS:
        why = f"fewer than {FEWEST_MOTIONS} motions"
    else:
        without, reasons = _probit(np.log(levels), cells.sum(axis=0) - cells, events.sum(axis=0) - events)
        why = "one motion decides the fit" if any(reasons) else ""
        replicates = replicates if why else without
    at = _logs(whole[None])[0]
    least = np.array([np.exp(2.0 * at[1]), 0.5]) / names.size
    low, high = _interval(at, _logs(replicates), least, quantile)
    median, dispersion = (tuple(np.exp(ends).tolist()) for ends in zip(at, low, high, strict=True))
    return Lognormal(median, dispersion, whole, replicates, quantile, why)


def _logs(coefficients: FloatArray) -> FloatArray:
    """ln theta and ln beta of probit coefficients ``(n, 2)``."""
    a, b = coefficients.T
    return np.column_stack([-a / b, -np.log(b)])


def _interval(
    at: FloatArray, replicates: FloatArray, least: FloatArray, quantile: float
) -> tuple[FloatArray, FloatArray]:
    """Ends ``(m,)``: from estimates ``(m,)``, those without one motion each ``(G, m)``, the least variance ``(m,)``."""
    count, mean = replicates.shape[0], replicates.mean(axis=0)
    variance = (count - 1) / count * np.sum((replicates - mean) ** 2, axis=0)
    centre = count * at - (count - 1) * mean
    half = quantile * np.sqrt(np.maximum(variance, least))
    return np.minimum(centre - half, at), np.maximum(centre + half, at)


def _probit(x: FloatArray, cells: FloatArray, events: FloatArray) -> tuple[FloatArray, list[str]]:
    """Coefficients ``(m, 2)`` of P = Phi(a + b x) by Fisher scoring, and for each row why there are none.

    ``events`` of the ``cells`` ``(m, n)`` at levels ``x`` ``(n,)`` are events; the m rows are fitted side by side.
    """
    reasons = [_unfit(x, n, k) for n, k in zip(cells, events, strict=True)]
    at = np.full((cells.shape[0], 2), np.nan)
    rows = np.array([not reason for reason in reasons])
    n, k = cells[rows], events[rows]
    if not n.size:
        return at, reasons
    centre, width = float(x.mean()), float(x.std())
    design = np.column_stack([np.ones(x.size), (x - centre) / width])
    found, last = np.zeros((n.shape[0], 2)), np.full(n.shape[0], np.inf)
    for _ in range(ROUNDS):
        index = np.clip(found @ design.T, -37.0, 37.0)
        log_density = -0.5 * index**2 - 0.5 * np.log(2.0 * np.pi)
        rise, fall = np.exp(log_density - log_ndtr(index)), np.exp(log_density - log_ndtr(-index))
        score = (k * rise - (n - k) * fall) @ design
        information = np.einsum("mn,ni,nj->mij", n * rise * fall, design, design) + 1e-12 * np.eye(2)
        step = np.linalg.solve(information, score[..., None])[..., 0]
        last = np.abs(step).max(axis=1)
        if last.max() < TOLERANCE:
            break
        found = found + step / np.maximum(1.0, last / 4.0)[:, None]
    slope = found[:, 1] / width
    at[rows] = np.column_stack([found[:, 0] - slope * centre, slope])
    for row, b, change in zip(np.flatnonzero(rows), slope, last, strict=True):
        if change >= TOLERANCE:
            reasons[row] = "the likelihood has no maximum"
        elif not b > 0.0:
            reasons[row] = "it does not happen more often with a stronger motion"
    return at, reasons


def _unfit(x: FloatArray, cells: FloatArray, events: FloatArray) -> str:
    """Why no likelihood has a maximum; empty where one may."""
    happened, stayed = events > 0.0, cells > events
    if not happened.any():
        return "it never happens"
    if not stayed.any():
        return "it always happens"
    if x[stayed].max() <= x[happened].min():
        return "one threshold separates all cells: a dispersion cannot be told from none"
    return ""
